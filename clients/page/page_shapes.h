/* Bodies in body coordinates, each stored once: a rigid body has the same frames in every query. */
#ifndef PAGE_SHAPES_H
#define PAGE_SHAPES_H

#include "page_json.h"
#include "query.h"

struct page_shapes {
    struct page_json json; /* {"dim": ..., "frames": [[shape, numbers...], ...]}, ... */
    size_t count;
    struct page_shape *shape; /* owned: hash table by encoding; NULL: empty */
};

/* Opens an empty set. Exits with status 1 if memory is exhausted, as page_shapes_index() does. */
void page_shapes_open(struct page_shapes *out);
void page_shapes_close(struct page_shapes *shapes);

/* Adds a geometry if it is new. In: all its frames are valid. Returns its index. */
size_t page_shapes_index(struct page_shapes *shapes, const struct geometry *geometry);

#endif
