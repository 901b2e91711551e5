#include "same.h"

#include "geometry.h"

#include <stdlib.h>
#include <string.h>

bool same_doubles(const double *a, const double *b, size_t count)
{
    return count == 0 || memcmp(a, b, count * sizeof *a) == 0;
}

/* ---- Bodies ---- */

/* Numbers of a frame by the comments of placement_t.lcm; 0: no such shape. vertices: its count; 0:
 * it has none. */
static int64_t numbers_of(int32_t dim, int shape, int32_t vertices)
{
    if (dim != 2 && dim != 3)
        return 0;
    switch (shape) {
    case FMB_MSGS_PLACEMENT_T_SHAPE_TETRAHEDRON_VERTICES: return dim * (dim + 1);
    case FMB_MSGS_PLACEMENT_T_SHAPE_FACE_VERTICES: return dim == 3 ? 9 : 0;
    case FMB_MSGS_PLACEMENT_T_SHAPE_HULL: return vertices > 0 ? (int64_t) dim * vertices : 0;
    case FMB_MSGS_PLACEMENT_T_SHAPE_CUBOID:
    case FMB_MSGS_PLACEMENT_T_SHAPE_TETRAHEDRON: return dim + dim * dim;
    case FMB_MSGS_PLACEMENT_T_SHAPE_FACE: return dim == 3 ? 9 : 0;
    case FMB_MSGS_PLACEMENT_T_SHAPE_BOX: return 2 * dim;
    default: return 0;
    }
}

/* Frame after frame, until one does not fit. */
static bool same_frames(const struct body_view *geometry, const fmb_msgs_body_t *message)
{
    static double read[QUERY_NUMBERS_MAX];
    const int32_t dim = message->dim;
    struct geometry_reader reader = geometry_begin(geometry);
    struct geometry_frame frame;
    int32_t number = 0, f = 0, c = 0;
    for (; f < message->num_frames; f++) {
        const bool has_radius = message->shapes[f] >= FMB_MSGS_PLACEMENT_T_SHAPE_RADIUS;
        const int shape = message->shapes[f] - (has_radius ? FMB_MSGS_PLACEMENT_T_SHAPE_RADIUS : 0);
        const bool vertices = shape == FMB_MSGS_PLACEMENT_T_SHAPE_HULL ||
                              shape >= FMB_MSGS_PLACEMENT_T_SHAPE_TETRAHEDRON_VERTICES;
        const int32_t given = vertices && c < message->num_counts ? message->counts[c++] : 0;
        const int64_t count = numbers_of(dim, shape, given);
        const bool fits = count > 0 && count + has_radius <= message->num_numbers - number &&
                          (!vertices || (int64_t) dim * given == count);
        if (geometry_next(&reader, &frame) != fits)
            return false;
        if (!fits)
            return true;
        const int by_components = shape < 6 ? shape : shape == 7 ? FMB_FACE : FMB_TETRAHEDRON;
        geometry_numbers(&frame, read);
        const double radius = has_radius ? message->numbers[number++] : 0;
        if (reader.dim != dim || frame.shape != by_components || frame.by_vertices != vertices ||
            frame.count != (size_t) count || !same_doubles(&frame.radius, &radius, 1) ||
            !same_doubles(read, message->numbers + number, frame.count))
            return false;
        number += (int32_t) count;
    }
    return !geometry_next(&reader, &frame) && reader.counts_left == message->num_counts - c &&
           reader.numbers_left == message->num_numbers - number;
}

/* Bytes of a body_t before its geometry: fingerprint and handle. */
enum { GEOMETRY_AT = 24 };

bool same_geometry(const struct body_view *geometry, const fmb_msgs_body_t *message)
{
    const int size = fmb_msgs_body_t_encoded_size(message);
    uint8_t *encoded = fuzz_room((size_t) size);
    FUZZ_CHECK(fmb_msgs_body_t_encode(encoded, 0, size, message) == size);
    const bool same = geometry->size == (size_t) size - GEOMETRY_AT &&
                      memcmp(geometry->bytes, encoded + GEOMETRY_AT, geometry->size) == 0;
    free(encoded);
    return same && same_frames(geometry, message);
}

/* The first max numbers of the message, the remainder 0. */
static bool same_numbers(const double *numbers, int32_t max, const double *message, int32_t count)
{
    static const double none[FMB_COMPONENTS_MAX];
    const int32_t kept = count < max ? count : max;
    return same_doubles(numbers, message, (size_t) kept) &&
           same_doubles(numbers + kept, none, (size_t) (max - kept));
}

bool same_placement(const struct query_placement *placement, const fmb_msgs_placement_t *message)
{
    const fmb_msgs_body_t body = {.dim = message->dim,
                                  .num_frames = message->num_frames,
                                  .shapes = message->shapes,
                                  .num_counts = message->num_counts,
                                  .counts = message->counts,
                                  .num_numbers = message->num_numbers,
                                  .numbers = message->numbers};
    const int32_t placed =
        message->num_end_pose < message->dim ? message->num_end_pose : message->dim;
    return placement->placed.id == message->body_id &&
           memcmp(placement->body.handle.bytes, message->handle, sizeof message->handle) == 0 &&
           placement->body.dim == message->dim &&
           placement->body.frame_count == message->num_frames &&
           placement->body.count_count == message->num_counts &&
           placement->body.number_count == message->num_numbers &&
           strcmp(placement->placed.name, message->name) == 0 &&
           placement->placed.group == message->group &&
           placement->placed.orientation_count == message->num_orientation &&
           placement->velocity_count == message->num_velocity &&
           placement->placed.end_count == message->num_end_pose &&
           same_geometry(&placement->body, &body) &&
           same_numbers(placement->placed.position, FMB_DIM_MAX, message->position, message->dim) &&
           same_numbers(placement->placed.orientation, QUERY_ORIENTATION_MAX, message->orientation,
                        message->num_orientation) &&
           same_numbers(placement->placed.velocity, FMB_DIM_MAX, message->velocity,
                        message->num_velocity) &&
           same_numbers(placement->placed.end_position, FMB_DIM_MAX, message->end_pose, placed) &&
           same_numbers(placement->placed.end_orientation, QUERY_ORIENTATION_MAX,
                        message->num_end_pose > 0 ? message->end_pose + placed : NULL,
                        message->num_end_pose - placed);
}

bool same_can_hold(const struct query_placement *placement)
{
    return placement->body.dim <= FMB_DIM_MAX &&
           placement->placed.orientation_count <= QUERY_ORIENTATION_MAX &&
           placement->velocity_count <= FMB_DIM_MAX &&
           placement->placed.end_count <= placement->body.dim + QUERY_ORIENTATION_MAX;
}

bool same_handles(const struct handle *handle, int32_t count, int32_t max, const uint8_t *bytes,
                  int32_t size)
{
    bool same = count == size / HANDLE_BYTES;
    for (int32_t i = 0; i < count && i < max && same; i++)
        same = memcmp(handle[i].bytes, bytes + HANDLE_BYTES * i, HANDLE_BYTES) == 0;
    return same;
}

/* ---- Texts, bytes and headers ---- */

bool same_text(const char *text, size_t size, const char *message, bool *whole)
{
    const size_t length = strlen(message), kept = length < size ? length : size - 1;
    *whole = length == kept;
    for (size_t i = 0; i < kept; i++) {
        const bool printable = message[i] >= 0x20 && message[i] <= 0x7e;
        if (text[i] != (printable ? message[i] : '?'))
            return false;
        *whole = *whole && printable;
    }
    return text[kept] == '\0';
}

void same_bytes(const uint8_t *written, size_t size, const uint8_t *read, size_t read_size)
{
    FUZZ_CHECK(size == read_size);
    FUZZ_CHECK(memcmp(written, read, size) == 0);
}

static int64_t number_at(const uint8_t *bytes)
{
    uint64_t number = 0;
    for (int i = 0; i < 8; i++)
        number = number << 8 | bytes[i];
    return (int64_t) number;
}

void same_header(const char *(*reader)(const void *, uint32_t, struct query_header *),
                 int64_t fingerprint, const uint8_t *bytes, size_t size)
{
    struct query_header header;
    const bool accepted = !reader(bytes, (uint32_t) size, &header);
    FUZZ_CHECK(accepted == (size >= 32 && number_at(bytes) == fingerprint));
    FUZZ_CHECK(!accepted ||
               (header.utime == number_at(bytes + 8) && header.client_id == number_at(bytes + 16) &&
                header.sequence_number == number_at(bytes + 24)));
}
