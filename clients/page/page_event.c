#include "page_event.h"

#include "cursor.h"
#include "geometry.h"
#include "keyed_hash.h"
#include "logged_query.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- JSON in memory -------------------------------------------------------------------------- */

void page_json_flush(struct page_json *page)
{
    if (fflush(page->json.out) != 0 || ferror(page->json.out))
        allocate_failed();
}

void page_json_open(struct page_json *out)
{
    memset(out, 0, sizeof *out);
    FILE *stream = open_memstream(&out->bytes, &out->used);
    if (!stream)
        allocate_failed();
    out->json = (struct json_writer){.out = stream, .page = true};
    page_json_flush(out); /* so that bytes is not NULL */
}

void page_json_close(struct page_json *page)
{
    fclose(page->json.out);
    free(page->bytes);
    memset(page, 0, sizeof *page);
}

/* ---- Shapes ---------------------------------------------------------------------------------- */

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

/* The page has components, which may be rounded. */
static void write_frame(struct json_writer *json, int dim, const struct geometry_frame *frame)
{
    double *number = allocate(frame->count, sizeof *number);
    geometry_numbers(frame, number);
    json_begin(json, NULL, '[');
    json_integer(json, NULL, frame->shape);
    for (size_t i = 0; i < frame->count; i++)
        json_number(json, NULL,
                    frame->by_vertices && i >= (size_t) dim ? number[i] - number[i % (size_t) dim]
                                                            : number[i]);
    json_end(json, ']');
    free(number);
}

static void write_shape(struct json_writer *json, const struct body_view *body)
{
    struct geometry_reader reader = geometry_begin(body);
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

/* Adds a body if it is new. In: all its frames are valid. Returns its index. */
static size_t index_of_shape(struct page_shapes *shapes, const struct body_view *body)
{
    struct page_shape *found;
    HASH_FIND(hh, shapes->shape, body->bytes, body->size, found);
    if (found)
        return found->index;
    found = allocate(1, sizeof *found + body->size);
    memcpy(found->bytes, body->bytes, body->size);
    found->index = shapes->count++;
    HASH_ADD_KEYPTR(hh, shapes->shape, found->bytes, body->size, found);
    write_shape(&shapes->json.json, body);
    return found->index;
}

/* ---- Placements ------------------------------------------------------------------------------ */

enum { SHAPE_UNKNOWN = -1, SHAPE_NONE = -2 };

static bool are_finite(const double *numbers, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(numbers[i]))
            return false;
    return true;
}

static bool is_orientation(const double *orientation, int count)
{
    double largest = 0;
    for (int i = 0; i < count; i++)
        largest = fmax(largest, fabs(orientation[i]));
    return count == 0 || (largest > 0 && are_finite(orientation, count));
}

/* Whether there are frames and all are valid: logs also contain queries that were refused. */
static bool has_frames(const struct body_view *body)
{
    struct geometry_reader reader = geometry_begin(body);
    struct geometry_frame frame;
    bool good = body->frame_count > 0;
    while (good && reader.frames_left > 0) {
        good = geometry_next(&reader, &frame);
        for (size_t i = 0; good && i < frame.count; i++)
            good = isfinite(cursor_double_at(frame.number + 8 * i));
    }
    return good && reader.counts_left == 0 && reader.numbers_left == 0;
}

static bool is_drawable(const struct query_placement *placement)
{
    const struct fmb_placement *placed = &placement->placed;
    const int dim = placement->body.dim;
    return has_frames(&placement->body) && are_finite(placed->position, dim) &&
           (placed->orientation_count == 0 || placed->orientation_count == (dim == 2 ? 2 : 4)) &&
           is_orientation(placed->orientation, placed->orientation_count) &&
           (placement->velocity_count == 0 || placement->velocity_count == dim) &&
           are_finite(placed->velocity, placement->velocity_count);
}

static void write_numbers(struct json_writer *out, const double *numbers, int count)
{
    for (int i = 0; i < count; i++)
        json_number(out, NULL, numbers[i]);
}

static void write_handle(struct json_writer *out, const struct handle *handle)
{
    char text[2 * HANDLE_BYTES + 1];
    for (int i = 0; i < HANDLE_BYTES; i++)
        snprintf(text + 2 * i, 3, "%02x", handle->bytes[i]);
    json_string(out, NULL, text);
}

static void write_placement(const struct query_placement *placement, struct page_shapes *shapes,
                            struct json_writer *out)
{
    json_begin(out, NULL, '[');
    json_integer(out, NULL, placement->placed.id);
    if (is_drawable(placement)) {
        const struct fmb_placement *placed = &placement->placed;
        json_integer(out, NULL, (int64_t) index_of_shape(shapes, &placement->body));
        json_numbers(out, NULL, placed->position, placement->body.dim);
        json_numbers(out, NULL, placed->orientation, placed->orientation_count);
        json_numbers(out, NULL, placed->velocity, placement->velocity_count);
    } else if (query_by_handle(placement)) {
        json_integer(out, NULL, SHAPE_UNKNOWN);
        write_handle(out, &placement->body.handle);
    } else {
        json_integer(out, NULL, SHAPE_NONE);
    }
    json_end(out, ']');
}

static void write_placements(const struct replayed *replayed, struct page_shapes *shapes,
                             struct json_writer *out)
{
    const struct scene_query *scene = replayed->scene;
    const struct query_placement *placement = scene ? scene->placement : replayed->pair->placement;
    const int32_t count = scene ? scene->placement_count : 2;
    const int32_t kept = count < QUERY_PLACEMENTS_MAX ? count : QUERY_PLACEMENTS_MAX;
    json_begin(out, "frames", '[');
    for (int32_t i = 0; i < kept; i++)
        write_placement(&placement[i], shapes, out);
    json_end(out, ']');
    if (kept < count)
        json_integer(out, "more_frames", count - kept);
}

/* ---- Results --------------------------------------------------------------------------------- */

/* Begins the object of a result; the caller ends it. */
static void begin_result(struct json_writer *out, const char *key, int32_t status,
                         const char *detail, int32_t method, int64_t compute_ns)
{
    const struct fmb_method *by = method ? fmb_method_by_number(method) : NULL;
    json_begin(out, key, '{');
    json_integer(out, "status", status);
    if (status != FMB_OK) {
        json_string(out, "says", fmb_status_text(status));
        json_string(out, "detail", detail);
    }
    json_string(out, "method", by ? by->name : "");
    json_integer(out, "ns", compute_ns);
}

static void write_pair_result(struct json_writer *out, const char *key,
                              const struct pair_result *result)
{
    if (!result) {
        json_null(out, key);
        return;
    }
    begin_result(out, key, result->status, result->detail, result->method, result->compute_ns);
    json_end(out, '}');
}

static void write_scene_result(struct json_writer *out, const char *key,
                               const struct scene_query *query, const struct scene_result *result)
{
    int64_t count[FMB_OVERLAPPING + 1];
    if (!result) {
        json_null(out, key);
        return;
    }
    replayed_count(query, result, count);
    begin_result(out, key, result->status, result->detail, result->method, result->compute_ns);
    json_integer(out, "end", result->end_pair);
    json_integers(out, "count", count, FMB_OVERLAPPING + 1);
    json_end(out, '}');
}

static bool certificates_differ(const struct pair_result *a, const struct pair_result *b)
{
    if (!a || !b || a->status != FMB_OK || b->status != FMB_OK)
        return false;
    if (!a->certificate || !b->certificate)
        return a->certificate != b->certificate;
    return strcmp(a->certificate, b->certificate) != 0;
}

/* ---- Pairs ----------------------------------------------------------------------------------- */

/* Writes an end of a box as a number, as null if it is infinite and outward, or as a string for
 * other values, which only inexact methods give. */
static void write_end(struct json_writer *out, double value, int end)
{
    if (isfinite(value) || value == (end ? INFINITY : -INFINITY))
        json_number(out, NULL, value);
    else
        json_string(out, NULL, isnan(value) ? "NaN" : value > 0 ? "inf" : "-inf");
}

static void write_gap(struct json_writer *out, int dim, const struct fmb_gap *gap)
{
    json_begin(out, NULL, '[');
    for (int end = 0; end < 2; end++)
        write_end(out, gap->bounds[end], end);
    if (gap->has_witness) {
        json_number(out, NULL, gap->time);
        for (int of = 0; of < 2; of++)
            write_numbers(out, gap->witness[of], dim);
    }
    json_end(out, ']');
}

static void write_side(struct json_writer *out, const struct replayed_side *side)
{
    static const double none[2] = {NAN, NAN};
    const struct fmb_answer *answer = &side->answer;
    if (!side->answered) {
        json_null(out, NULL);
        return;
    }
    if (!answer->has_contact && !answer->has_box && !answer->has_gap) {
        json_integer(out, NULL, answer->verdict);
        return;
    }
    json_begin(out, NULL, '[');
    json_integer(out, NULL, answer->verdict);
    write_numbers(out, answer->has_contact ? answer->contact : none, 2);
    for (int i = 0; i < 2 * side->dim && answer->has_box; i++)
        write_end(out, answer->box[i / side->dim][i % side->dim], i / side->dim);
    if (answer->has_gap)
        write_gap(out, side->dim, &answer->gap);
    json_end(out, ']');
}

/* Whether both results answer the pair, differently. */
static bool differs(const struct replayed_pair *pair)
{
    return pair->then.answered && pair->now.answered &&
           (pair->then.dim != pair->now.dim ||
            !query_same_answer(&pair->then.answer, &pair->now.answer));
}

static void write_pair(struct json_writer *out, const struct replayed_pair *pair)
{
    json_begin(out, NULL, '[');
    json_integer(out, NULL, pair->a);
    json_integer(out, NULL, pair->b);
    write_side(out, &pair->then);
    if (differs(pair) || pair->then.answered != pair->now.answered)
        write_side(out, &pair->now);
    json_end(out, ']');
}

enum { RANK_DIFFERS, RANK_CONTACT, RANK_OTHER, RANK_COUNT };

static int rank(const struct replayed_pair *pair)
{
    const bool contact =
        pair->then.answer.verdict >= FMB_TOUCHING || pair->now.answer.verdict >= FMB_TOUCHING;
    return differs(pair) ? RANK_DIFFERS : contact ? RANK_CONTACT : RANK_OTHER;
}

static void write_pairs(const struct replayed *replayed, struct json_writer *out)
{
    int64_t seen = 0, kept = 0;
    json_begin(out, "pairs", '[');
    for (int of_rank = 0; of_rank < RANK_COUNT; of_rank++) {
        struct replayed_pairs pairs;
        struct replayed_pair pair;
        replayed_pairs_begin(replayed, &pairs);
        while (replayed_pairs_next(&pairs, &pair)) {
            if (rank(&pair) != of_rank)
                continue;
            if (seen++ >= PAGE_PAIRS_MAX)
                continue;
            write_pair(out, &pair);
            kept++;
        }
    }
    json_end(out, ']');
    if (seen > kept)
        json_integer(out, "more", seen - kept);
}

/* ---- The event ------------------------------------------------------------------------------- */

static int64_t kind_of(const struct scene_query *scene)
{
    switch (scene->which) {
    case FMB_PAIRS_LISTED: return 1;
    case FMB_PAIRS_ALL: return 2;
    default: return 1 + (int64_t) scene->which;
    }
}

static void write_query(const struct replayed *replayed, struct json_writer *out)
{
    const struct scene_query *scene = replayed->scene;
    json_integer(out, "kind", scene ? kind_of(scene) : 0);
    json_number(out, "T", scene ? scene->duration : replayed->pair->duration);
    json_integer(out, "want", scene ? scene->want : replayed->pair->want);
    if (scene) {
        if (scene->margin > 0)
            json_number(out, "margin", scene->margin);
        json_integer(out, "first", scene->first_pair);
        json_integer(out, "split", scene->split);
        json_integer(out, "total", query_pair_count(scene));
    }
}

void page_event_write(const struct replayed *replayed, size_t log, struct page_shapes *shapes,
                      struct json_writer *out)
{
    json_break(out, "\n");
    json_begin(out, NULL, '{');
    json_integer(out, "n", replayed->event_number);
    json_integer(out, "o", replayed->offset);
    json_integer(out, "t", replayed->utime);
    json_integer(out, "log", (int64_t) log);
    json_integer(out, "is", (int64_t) replayed->outcome);
    write_query(replayed, out);
    write_placements(replayed, shapes, out);
    if (replayed->scene) {
        write_scene_result(out, "then", replayed->scene, replayed->scene_then);
        write_scene_result(out, "now", replayed->scene, replayed->scene_now);
    } else {
        write_pair_result(out, "then", replayed->pair_then);
        write_pair_result(out, "now", replayed->pair_now);
        if (certificates_differ(replayed->pair_then, replayed->pair_now))
            json_integer(out, "certificate", 1);
    }
    write_pairs(replayed, out);
    json_end(out, '}');
}
