#include "page_shapes.h"

#include "allocate.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#define uthash_malloc(size) allocate(1, size)
#include <uthash.h>

/* The key: compared as bytes. */
struct shape {
    int32_t shape, dim, count;
    double number[FMB_COMPONENTS_MAX]; /* 0 beyond count */
};

struct page_shape {
    struct shape shape;
    size_t index;
    UT_hash_handle hh;
};

void page_shapes_open(struct page_shapes *out)
{
    memset(out, 0, sizeof *out);
    page_json_open(&out->json);
    out->hash = keyed_hash_make();
}

void page_shapes_close(struct page_shapes *shapes)
{
    struct page_shape *at = shapes->shape, *next;
    HASH_CLEAR(hh, shapes->shape);
    for (; at; at = next) {
        next = at->hh.next;
        free(at);
    }
    page_json_close(&shapes->json);
}

static struct shape shape_of(int dim, const struct geometry_frame *frame)
{
    struct shape shape;
    memset(&shape, 0, sizeof shape); /* what lies between the members too: bytes are compared */
    shape.shape = frame->shape;
    shape.dim = dim;
    shape.count = frame->count * dim;
    assert(shape.count >= 0 && shape.count <= FMB_COMPONENTS_MAX);
    memcpy(shape.number, frame->components, (size_t) shape.count * sizeof *shape.number);
    return shape;
}

static void write_shape(struct json_writer *json, const struct shape *shape)
{
    json_break(json, "\n");
    json_begin(json, NULL, '{');
    json_integer(json, "shape", shape->shape);
    json_integer(json, "dim", shape->dim);
    json_numbers(json, "c", shape->number, shape->count);
    json_end(json, '}');
}

size_t page_shapes_index(struct page_shapes *shapes, int dim, const struct geometry_frame *frame)
{
    const struct shape shape = shape_of(dim, frame);
    const unsigned hash = keyed_hash_of(&shapes->hash, &shape, sizeof shape);
    struct page_shape *found;
    HASH_FIND_BYHASHVALUE(hh, shapes->shape, &shape, sizeof shape, hash, found);
    if (found)
        return found->index;
    found = allocate(1, sizeof *found);
    memcpy(&found->shape, &shape, sizeof shape);
    found->index = shapes->count++;
    HASH_ADD_BYHASHVALUE(hh, shapes->shape, shape, sizeof shape, hash, found);
    write_shape(&shapes->json.json, &shape);
    return found->index;
}
