#include "page_shapes.h"

#include "allocate.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

struct page_shape {
    int32_t shape, dim, count;
    double number[FMB_COMPONENTS_MAX]; /* 0 beyond count */
};

void page_shapes_clear(struct page_shapes *shapes)
{
    page_json_clear(&shapes->json);
    free(shapes->shape);
    free(shapes->slot);
    memset(shapes, 0, sizeof *shapes);
}

static struct page_shape shape_of(const struct query_frame *frame)
{
    struct page_shape shape;
    assert(frame->components.count >= 0 && frame->components.count <= FMB_COMPONENTS_MAX);
    memset(&shape, 0, sizeof shape); /* what lies between the members too: bytes are compared */
    shape.shape = frame->shape;
    shape.dim = frame->dim;
    shape.count = frame->components.count;
    memcpy(shape.number, frame->components.number, (size_t) shape.count * sizeof *shape.number);
    return shape;
}

static uint64_t hash(const struct page_shape *shape)
{
    int64_t mixed = shape->shape * 4 + shape->dim;
    for (int i = 0; i < FMB_COMPONENTS_MAX; i++) {
        int64_t bits;
        memcpy(&bits, &shape->number[i], sizeof bits);
        mixed = (int64_t) (query_id_mix(mixed) >> 29 ^ (uint64_t) bits);
    }
    return query_id_mix(mixed) >> 20;
}

/* The slot that holds the shape, or the free one where it belongs. Some are always free. */
static size_t find(const struct page_shapes *shapes, const struct page_shape *shape)
{
    size_t at = hash(shape) & (shapes->slot_count - 1);
    while (shapes->slot[at] &&
           memcmp(&shapes->shape[shapes->slot[at] - 1], shape, sizeof *shape) != 0)
        at = (at + 1) & (shapes->slot_count - 1);
    return at;
}

/* No more than half of the slots are taken. */
static void make_slots(struct page_shapes *shapes)
{
    enum { SLOTS_MIN = 64 };
    if (2 * (shapes->count + 1) <= shapes->slot_count)
        return;
    shapes->slot_count = shapes->slot_count ? 2 * shapes->slot_count : SLOTS_MIN;
    free(shapes->slot);
    shapes->slot = allocate(shapes->slot_count, sizeof *shapes->slot);
    for (size_t i = 0; i < shapes->count; i++)
        shapes->slot[find(shapes, &shapes->shape[i])] = i + 1;
}

static void write_shape(struct page_json *json, const struct page_shape *shape)
{
    page_json_raw(json, json->used ? ",\n{\"shape\":" : "{\"shape\":");
    page_json_integer(json, shape->shape);
    page_json_raw(json, ",\"dim\":");
    page_json_integer(json, shape->dim);
    for (int32_t i = 0; i < shape->count; i++) {
        page_json_raw(json, i ? "," : ",\"c\":[");
        page_json_number(json, shape->number[i]);
    }
    page_json_raw(json, "]}");
}

size_t page_shapes_index(struct page_shapes *shapes, const struct query_frame *frame)
{
    const struct page_shape shape = shape_of(frame);
    make_slots(shapes);
    const size_t slot = find(shapes, &shape);
    if (!shapes->slot[slot]) {
        shapes->shape =
            allocate_room(shapes->shape, &shapes->room, shapes->count + 1, sizeof shape);
        shapes->shape[shapes->count++] = shape;
        shapes->slot[slot] = shapes->count;
        write_shape(&shapes->json, &shape);
    }
    return shapes->slot[slot] - 1;
}
