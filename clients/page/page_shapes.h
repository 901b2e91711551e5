/* Shapes of frames, each kept once: a rigid body has the same components wherever it goes. */
#ifndef PAGE_SHAPES_H
#define PAGE_SHAPES_H

#include "page_json.h"
#include "query.h"

/* All 0 is an empty table. */
struct page_shapes {
    struct page_json json; /* {"shape": ..., "dim": ..., "c": [...]}, one after the other */
    size_t count, room;
    struct page_shape *shape; /* owned */
    size_t slot_count;        /* a power of two, or 0 */
    size_t *slot;             /* owned; by hash: index + 1 of a shape, 0: free */
};

void page_shapes_clear(struct page_shapes *shapes);

/* On input: a frame with the components of its shape. Returns the index of its shape, dimension
 * and components. */
size_t page_shapes_index(struct page_shapes *shapes, const struct query_frame *frame);

#endif
