/* Shapes of frames, each kept once: a rigid body has the same components wherever it goes. */
#ifndef PAGE_SHAPES_H
#define PAGE_SHAPES_H

#include "keyed_hash.h"
#include "page_json.h"
#include "query.h"

struct page_shapes {
    struct page_json json; /* {"shape": ..., "dim": ..., "c": [...]}, one after the other */
    size_t count;
    struct page_shape *shape; /* owned: a table by all their bytes; NULL: empty */
    struct keyed_hash hash;
};

/* On output: no shapes. */
void page_shapes_open(struct page_shapes *out);
void page_shapes_close(struct page_shapes *shapes);

/* In: a frame of a body of dimension dim. Returns the index of its shape, dimension and components.
 */
size_t page_shapes_index(struct page_shapes *shapes, int dim, const struct geometry_frame *frame);

#endif
