#include "page_shapes.h"

#include "keyed_hash.h"

#include <stdlib.h>
#include <string.h>

struct page_shape {
    size_t index;
    UT_hash_handle hh;
    unsigned char bytes[]; /* the key: the encoded geometry */
};

void page_shapes_open(struct page_shapes *out)
{
    memset(out, 0, sizeof *out);
    page_json_open(&out->json);
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

static void write_frame(struct json_writer *json, int dim, const struct geometry_frame *frame)
{
    json_begin(json, NULL, '[');
    json_integer(json, NULL, frame->shape);
    for (int i = 0; i < geometry_number_count(dim, frame->shape); i++)
        json_number(json, NULL, i < dim ? frame->origin[i] : frame->components[i - dim]);
    json_end(json, ']');
}

static void write_shape(struct json_writer *json, const struct geometry *geometry)
{
    struct geometry_reader reader = geometry_begin(geometry);
    struct geometry_frame frame;
    json_break(json, "\n");
    json_begin(json, NULL, '{');
    json_integer(json, "dim", reader.dim);
    json_begin(json, "frames", '[');
    while (geometry_next(&reader, &frame))
        write_frame(json, reader.dim, &frame);
    json_end(json, ']');
    json_end(json, '}');
}

size_t page_shapes_index(struct page_shapes *shapes, const struct geometry *geometry)
{
    struct page_shape *found;
    HASH_FIND(hh, shapes->shape, geometry->bytes, geometry->size, found);
    if (found)
        return found->index;
    found = allocate(1, sizeof *found + geometry->size);
    memcpy(found->bytes, geometry->bytes, geometry->size);
    found->index = shapes->count++;
    HASH_ADD_KEYPTR(hh, shapes->shape, found->bytes, geometry->size, found);
    write_shape(&shapes->json.json, geometry);
    return found->index;
}
