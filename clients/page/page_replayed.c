#include "page_replayed.h"

#include "scene.h"

#include <inttypes.h>
#include <string.h>

/* ---- Placements: logs also contain queries that were refused --------------------------------- */

static void add_body(struct page *page, const struct query_placement *placement, const char *name)
{
    const struct body_view *view = &placement->body;
    struct owned_scene memory = {.dim = 0};
    struct fmb_placement placed = placement->placed;
    char missing[2 * HANDLE_BYTES + 50] = "the log does not define its handle, ";
    const bool is_named = query_by_handle(placement);
    placed.name = name;
    placed.body = is_named ? NULL : body_of_view(view, &memory);
    for (size_t i = 0, used = strlen(missing); is_named && i < HANDLE_BYTES; i++)
        snprintf(missing + used + 2 * i, 3, "%02x", view->handle.bytes[i]);
    const bool is_good = fmb_placement_check(&placed) == FMB_OK &&
                         (placement->velocity_count == 0 || placement->velocity_count == view->dim);
    page_body(page, &placed,
              is_named  ? missing
              : is_good ? NULL
                        : "it is no body that can be drawn");
    scene_clear(&memory);
}

static void add_bodies(struct page *page, const struct body_names *names,
                       const struct replayed *replayed)
{
    const struct query_placement *placement = replayed->query->placement;
    const int64_t client = replayed->query->header.client_id;
    for (int32_t i = 0; i < replayed->query->placement_count; i++)
        add_body(page, &placement[i], body_names_find(names, client, placement[i].placed.id));
}

/* ---- Results --------------------------------------------------------------------------------- */

static struct page_result result_of(const struct logged_query *query,
                                    const struct logged_result *result)
{
    if (!result)
        return (struct page_result){.given = false};
    const struct result_head *head = &result->head;
    const struct fmb_method *by = head->method ? fmb_method_by_number(head->method) : NULL;
    struct page_result out = {
        .given = true,
        .error = head->status == FMB_OK ? NULL : fmb_status_text(head->status),
        .method = by ? by->name : NULL,
        .compute_ns = head->compute_ns};
    if (query->kind == LOG_SCENE_QUERY)
        replayed_count(&query->scene, &result->scene, out.count);
    else if (head->status == FMB_OK && result->pair.answer.verdict <= FMB_OVERLAPPING)
        out.count[result->pair.answer.verdict] = 1;
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
    return a->status == FMB_OK && b->status == FMB_OK &&
           (a->certificate && b->certificate ? strcmp(a->certificate, b->certificate) != 0
                                             : a->certificate != b->certificate);
}

void page_take(struct page *page, const struct body_names *names, int64_t begin,
               const struct replayed *replayed)
{
    static const char *const outcome[REPLAY_OUTCOMES] = {
        "same",     "different",         "busy", "unknown body", "not defined",
        "not held", "no result recorded"};
    const struct logged_query *query = replayed->query;
    const struct logged_result *then = replayed->then, *now = replayed->now;
    const struct scene_query *scene = query->kind == LOG_SCENE_QUERY ? &query->scene : NULL;
    struct page_step step = {
        .time = ((double) replayed->utime - (double) begin) / 1e6,
        .duration = scene ? scene->duration : query->pair.duration,
        .margin = scene ? scene->margin : 0,
        .label = scene ? scene->label : NULL,
        .all = scene && scene->which != FMB_PAIRS_LISTED,
        .log = replayed->log,
        .event = replayed->event_number,
        .offset = replayed->offset,
        .outcome = {outcome[replayed->outcome], replayed->outcome == REPLAY_DIFFERENT},
        .result = {result_of(replayed->then_query ? replayed->then_query : query, then),
                   result_of(query, now)}};
    char note[100];
    if (replayed->note) {
        step.note = replayed->note;
    } else if (!scene) {
        if (then && now && certificates_differ(&then->pair, &now->pair))
            step.note = "The certificates differ.";
    } else {
        const int64_t total = query_pair_count(scene);
        const int64_t end = now ? now->scene.end_pair : total;
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
