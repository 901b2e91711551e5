#include "page_event.h"

#include "page_pairs.h"

#include <math.h>
#include <string.h>

static void member(struct page_json *out, const char *name, int64_t value)
{
    page_json_raw(out, ",\"");
    page_json_raw(out, name);
    page_json_raw(out, "\":");
    page_json_integer(out, value);
}

static void text_member(struct page_json *out, const char *name, const char *value)
{
    page_json_raw(out, ",\"");
    page_json_raw(out, name);
    page_json_raw(out, "\":");
    page_json_string(out, value);
}

static void add_numbers(struct page_json *out, const double *numbers, int count)
{
    for (int i = 0; i < count; i++) {
        page_json_raw(out, ",");
        page_json_number(out, numbers[i]);
    }
}

/* ---- Frames ---------------------------------------------------------------------------------- */

enum { SHAPE_UNKNOWN = -1, SHAPE_NONE = -2 };

static bool are_finite(const struct query_numbers *numbers)
{
    for (int32_t i = 0; i < numbers->count; i++)
        if (!isfinite(numbers->number[i]))
            return false;
    return true;
}

/* What was refused may be in the log too. */
static bool is_frame(const struct query_frame *frame)
{
    const int count = frame->dim * fmb_component_count(frame->dim, frame->shape);
    return count > 0 && frame->components.count == count && frame->origin.count == frame->dim &&
           (frame->velocity.count == 0 || frame->velocity.count == frame->dim) &&
           are_finite(&frame->components) && are_finite(&frame->origin) &&
           are_finite(&frame->velocity);
}

static void write_frame(const struct query_frame *frame, struct page_shapes *shapes,
                        struct page_json *out)
{
    page_json_raw(out, "[");
    page_json_integer(out, frame->body_id);
    page_json_raw(out, ",");
    if (is_frame(frame)) {
        page_json_integer(out, (int64_t) page_shapes_index(shapes, frame));
        add_numbers(out, frame->origin.number, frame->dim);
        add_numbers(out, frame->velocity.number, frame->velocity.count);
    } else if (frame->components.count == 0 && frame->key != 0) {
        page_json_integer(out, SHAPE_UNKNOWN);
        page_json_raw(out, ",");
        page_json_integer(out, frame->key);
    } else {
        page_json_integer(out, SHAPE_NONE);
    }
    page_json_raw(out, "]");
}

static void write_frames(const struct replayed *replayed, struct page_shapes *shapes,
                         struct page_json *out)
{
    const struct scene_query *scene = replayed->scene;
    const struct query_frame *frame = scene ? scene->frame : replayed->pair->frame;
    const int32_t count = scene ? scene->frame_count : 2;
    const int32_t kept = count < QUERY_FRAMES_MAX ? count : QUERY_FRAMES_MAX;
    page_json_raw(out, ",\n\"frames\":[");
    for (int32_t i = 0; i < kept; i++) {
        page_json_raw(out, i ? "," : "");
        write_frame(&frame[i], shapes, out);
    }
    page_json_raw(out, "]");
    if (kept < count)
        member(out, "more_frames", count - kept);
}

/* ---- Results --------------------------------------------------------------------------------- */

static void begin_result(struct page_json *out, const char *name)
{
    page_json_raw(out, ",\n\"");
    page_json_raw(out, name);
    page_json_raw(out, "\":");
}

/* Without the end of the object. */
static void write_result(struct page_json *out, int32_t status, const char *detail, int32_t method,
                         int64_t compute_ns)
{
    const struct fmb_method *by = method ? fmb_method_by_number(method) : NULL;
    page_json_raw(out, "{\"status\":");
    page_json_integer(out, status);
    if (status != FMB_OK) {
        text_member(out, "says", fmb_status_text(status));
        text_member(out, "detail", detail);
    }
    text_member(out, "method", by ? by->name : "");
    member(out, "ns", compute_ns);
}

static void write_pair_result(struct page_json *out, const char *name,
                              const struct pair_result *result)
{
    begin_result(out, name);
    if (!result) {
        page_json_raw(out, "null");
        return;
    }
    write_result(out, result->status, result->detail, result->method, result->compute_ns);
    page_json_raw(out, "}");
}

static void write_scene_result(struct page_json *out, const char *name,
                               const struct scene_query *query, const struct scene_result *result)
{
    int64_t count[FMB_OVERLAPPING + 1];
    begin_result(out, name);
    if (!result) {
        page_json_raw(out, "null");
        return;
    }
    page_pairs_count(query, result, count);
    write_result(out, result->status, result->detail, result->method, result->compute_ns);
    member(out, "end", result->end_pair);
    for (int i = 0; i <= FMB_OVERLAPPING; i++) {
        page_json_raw(out, i ? "," : ",\"count\":[");
        page_json_integer(out, count[i]);
    }
    page_json_raw(out, "]}");
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

/* Infinite as it should be, null; else what no certain method gives, in words. */
static void write_end(struct page_json *out, double value, int end)
{
    page_json_raw(out, ",");
    if (isfinite(value) || value == (end ? INFINITY : -INFINITY))
        page_json_number(out, value);
    else
        page_json_raw(out, isnan(value) ? "\"NaN\"" : value > 0 ? "\"inf\"" : "\"-inf\"");
}

static void write_side(struct page_json *out, const struct page_side *side)
{
    if (!side->answered) {
        page_json_raw(out, "null");
        return;
    }
    const bool long_form = side->has_times || side->dim > 0;
    page_json_raw(out, long_form ? "[" : "");
    page_json_integer(out, side->verdict);
    if (!long_form)
        return;
    const double none[2] = {NAN, NAN};
    add_numbers(out, side->has_times ? side->times : none, 2);
    for (int end = 0; end < 2; end++)
        for (int axis = 0; axis < side->dim; axis++)
            write_end(out, side->box[end][axis], end);
    page_json_raw(out, "]");
}

static void write_pair(struct page_json *out, const struct page_pair *pair)
{
    page_json_raw(out, "[");
    page_json_integer(out, pair->a);
    page_json_raw(out, ",");
    page_json_integer(out, pair->b);
    page_json_raw(out, ",");
    write_side(out, &pair->then);
    if (pair->differs || pair->then.answered != pair->now.answered) {
        page_json_raw(out, ",");
        write_side(out, &pair->now);
    }
    page_json_raw(out, "]");
}

enum { RANK_DIFFERS, RANK_MEETS, RANK_OTHER, RANK_COUNT };

static int rank(const struct page_pair *pair)
{
    if (pair->differs)
        return RANK_DIFFERS;
    return pair->then.verdict >= FMB_TOUCHING || pair->now.verdict >= FMB_TOUCHING ? RANK_MEETS
                                                                                   : RANK_OTHER;
}

static void write_pairs(const struct replayed *replayed, struct page_json *out)
{
    int64_t seen = 0, kept = 0;
    page_json_raw(out, ",\n\"pairs\":[");
    for (int of_rank = 0; of_rank < RANK_COUNT; of_rank++) {
        struct page_pairs pairs;
        struct page_pair pair;
        page_pairs_begin(replayed, &pairs);
        while (page_pairs_next(&pairs, &pair)) {
            if (rank(&pair) != of_rank)
                continue;
            if (seen++ >= PAGE_PAIRS_MAX)
                continue;
            page_json_raw(out, kept++ ? "," : "");
            write_pair(out, &pair);
        }
    }
    page_json_raw(out, "]");
    if (seen > kept)
        member(out, "more", seen - kept);
}

/* ---- The event ------------------------------------------------------------------------------- */

static void write_question(const struct replayed *replayed, struct page_json *out)
{
    const struct scene_query *scene = replayed->scene;
    member(out, "kind", scene ? 1 + (int64_t) scene->which : 0);
    page_json_raw(out, ",\"T\":");
    page_json_number(out, scene ? scene->duration : replayed->pair->duration);
    member(out, "want", scene ? scene->want : replayed->pair->want);
    if (scene) {
        member(out, "first", scene->first_pair);
        member(out, "split", scene->split);
        member(out, "total", page_pairs_total(scene));
    }
}

void page_event_write(const struct replayed *replayed, size_t log, struct page_shapes *shapes,
                      struct page_json *out)
{
    page_json_raw(out, out->used ? ",\n{\"n\":" : "{\"n\":");
    page_json_integer(out, replayed->event_number);
    member(out, "o", replayed->offset);
    member(out, "t", replayed->utime);
    member(out, "log", (int64_t) log);
    member(out, "is", (int64_t) replayed->outcome);
    write_question(replayed, out);
    write_frames(replayed, shapes, out);
    if (replayed->scene) {
        write_scene_result(out, "then", replayed->scene, replayed->scene_then);
        write_scene_result(out, "now", replayed->scene, replayed->scene_now);
    } else {
        write_pair_result(out, "then", replayed->pair_then);
        write_pair_result(out, "now", replayed->pair_now);
        if (certificates_differ(replayed->pair_then, replayed->pair_now))
            member(out, "certificate", 1);
    }
    write_pairs(replayed, out);
    page_json_raw(out, "}");
}
