/* Bodies in body coordinates, each kept once: a rigid body has the same frames wherever it goes. */
#ifndef PAGE_SHAPES_H
#define PAGE_SHAPES_H

#include "page_json.h"
#include "query.h"

struct page_shapes {
    struct page_json json; /* {"dim": ..., "frames": [[shape, numbers...], ...]}, ... */
    size_t count;
    struct page_shape *shape; /* owned: a table by their encoding; NULL: empty */
};

/* On output: no shapes. */
void page_shapes_open(struct page_shapes *out);
void page_shapes_close(struct page_shapes *shapes);

/* In: a geometry, all of whose frames can be read. Returns its index. */
size_t page_shapes_index(struct page_shapes *shapes, const struct geometry *geometry);

#endif
