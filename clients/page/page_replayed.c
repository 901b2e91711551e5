#include "page_replayed.h"

#include "allocate.h"
#include "geometry.h"
#include "logged_query.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Placements: logs also contain queries that were refused --------------------------------- */

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

/* Appends the frames of a body. Returns whether there are some, and all are valid. */
static bool add_frames(const struct body_view *body, struct page_frames *out)
{
    struct geometry_reader reader = geometry_begin(body);
    struct geometry_frame frame;
    bool good = body->frame_count > 0;
    while (good && reader.frames_left > 0) {
        good = geometry_next(&reader, &frame);
        if (!good)
            break;
        double *number = allocate(frame.count, sizeof *number);
        geometry_numbers(&frame, number);
        good = are_finite(number, (int) frame.count);
        page_frames_add(out, frame.shape, frame.by_vertices, number, frame.count);
        free(number);
    }
    return good && reader.counts_left == 0 && reader.numbers_left == 0;
}

static bool is_placed(const struct query_placement *placement)
{
    const struct fmb_placement *placed = &placement->placed;
    const int dim = placement->body.dim;
    return are_finite(placed->position, dim) &&
           (placed->orientation_count == 0 || placed->orientation_count == (dim == 2 ? 2 : 4)) &&
           is_orientation(placed->orientation, placed->orientation_count) &&
           (placement->velocity_count == 0 || placement->velocity_count == dim) &&
           are_finite(placed->velocity, placement->velocity_count);
}

static void add_body(struct page *page, const struct query_placement *placement, const char *name,
                     struct page_frames *frames)
{
    const struct fmb_placement *placed = &placement->placed;
    struct page_body body = {.id = placed->id,
                             .name = name,
                             .dim = placement->body.dim,
                             .frames = frames,
                             .position = placed->position,
                             .velocity = placement->velocity_count ? placed->velocity : NULL,
                             .orientation = placed->orientation_count ? placed->orientation : NULL};
    char missing[2 * HANDLE_BYTES + 50] = "the log does not define its handle, ";
    if (query_by_handle(placement)) {
        for (size_t i = 0, used = strlen(missing); i < HANDLE_BYTES; i++)
            snprintf(missing + used + 2 * i, 3, "%02x", placement->body.handle.bytes[i]);
        body.missing = missing;
    } else if (!(body.dim == 2 || body.dim == 3) || !is_placed(placement) ||
               !add_frames(&placement->body, frames)) {
        body.missing = "it is no body that can be drawn";
    }
    page_body(page, &body);
    frames->count = 0;
}

static void add_bodies(struct page *page, const struct body_names *names,
                       const struct replayed *replayed)
{
    const struct scene_query *scene = replayed->scene;
    const struct query_placement *placement = scene ? scene->placement : replayed->pair->placement;
    const int32_t count = scene ? query_stored_placements(scene) : 2;
    const int64_t client = scene ? scene->client_id : replayed->pair->client_id;
    struct page_frames frames = {NULL, 0, 0};
    for (int32_t i = 0; i < count; i++)
        add_body(page, &placement[i], body_names_find(names, client, placement[i].placed.id),
                 &frames);
    free(frames.number);
}

/* ---- Results --------------------------------------------------------------------------------- */

static struct page_result result_of(int32_t status, int32_t method, int64_t compute_ns)
{
    const struct fmb_method *by = method ? fmb_method_by_number(method) : NULL;
    return (struct page_result){.given = true,
                                .error = status == FMB_OK ? NULL : fmb_status_text(status),
                                .method = by ? by->name : NULL,
                                .compute_ns = compute_ns};
}

static struct page_result result_of_pair(const struct pair_result *result)
{
    if (!result)
        return (struct page_result){.given = false};
    struct page_result out = result_of(result->status, result->method, result->compute_ns);
    if (result->status == FMB_OK && result->answer.verdict <= FMB_OVERLAPPING)
        out.count[result->answer.verdict] = 1;
    return out;
}

static struct page_result result_of_scene(const struct scene_query *query,
                                          const struct scene_result *result)
{
    if (!result)
        return (struct page_result){.given = false};
    struct page_result out = result_of(result->status, result->method, result->compute_ns);
    replayed_count(query, result, out.count);
    return out;
}

/* ---- Pairs ----------------------------------------------------------------------------------- */

/* Whether both results answer the pair and the answers differ. A result may end before the pair. */
static bool differs(const struct replayed_pair *pair)
{
    return pair->then.answered && pair->now.answered &&
           (pair->then.dim != pair->now.dim ||
            !query_same_answer(&pair->then.answer, &pair->now.answer));
}

static struct page_answer answer_of(const struct replayed_side *side)
{
    return (struct page_answer){.answer = side->answered ? &side->answer : NULL};
}

static void add_pairs(struct page *page, const struct replayed *replayed)
{
    struct replayed_pairs pairs;
    struct replayed_pair pair;
    replayed_pairs_begin(replayed, &pairs);
    while (replayed_pairs_next(&pairs, &pair)) {
        const struct page_answer then = answer_of(&pair.then), now = answer_of(&pair.now);
        const int dim = pair.now.dim ? pair.now.dim : pair.then.dim;
        page_pair(page, pair.a, pair.b, dim, differs(&pair) ? &then : NULL,
                  pair.now.answered ? &now : &then);
    }
}

/* ---- The step -------------------------------------------------------------------------------- */

static bool certificates_differ(const struct pair_result *a, const struct pair_result *b)
{
    return a && b && a->status == FMB_OK && b->status == FMB_OK &&
           (a->certificate && b->certificate ? strcmp(a->certificate, b->certificate) != 0
                                             : a->certificate != b->certificate);
}

void page_take(struct page *page, const struct body_names *names, int64_t begin,
               const struct replayed *replayed)
{
    static const char *const outcome[REPLAY_OUTCOMES] = {
        "same", "different", "busy", "unknown body", "not defined", "no result recorded"};
    const struct scene_query *scene = replayed->scene;
    struct page_step step = {
        .time = ((double) replayed->utime - (double) begin) / 1e6,
        .duration = scene ? scene->duration : replayed->pair->duration,
        .margin = scene ? scene->margin : 0,
        .label = scene ? scene->label : NULL,
        .all = scene && scene->which != FMB_PAIRS_LISTED,
        .log = replayed->log,
        .event = replayed->event_number,
        .offset = replayed->offset,
        .outcome = {outcome[replayed->outcome], replayed->outcome == REPLAY_DIFFERENT}};
    char note[100];
    if (!scene) {
        step.result[0] = result_of_pair(replayed->pair_then);
        step.result[1] = result_of_pair(replayed->pair_now);
        if (certificates_differ(replayed->pair_then, replayed->pair_now))
            step.note = "The certificates differ.";
    } else {
        step.result[0] = result_of_scene(scene, replayed->scene_then);
        step.result[1] = result_of_scene(scene, replayed->scene_now);
        const int64_t total = query_pair_count(scene);
        const int64_t end = replayed->scene_now ? replayed->scene_now->end_pair : total;
        if (scene->first_pair > 0 || end < total) {
            snprintf(note, sizeof note, "Pairs %" PRId32 " to %" PRId64 " of %" PRId64 ".",
                     scene->first_pair, end, total);
            step.note = note;
            step.all = false;
        }
    }
    page_step_begin(page, &step);
    add_bodies(page, names, replayed);
    add_pairs(page, replayed);
    page_step_end(page);
}
