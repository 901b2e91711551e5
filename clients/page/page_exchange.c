#include "page_exchange.h"

#include <inttypes.h>
#include <string.h>

/* Logs also contain queries that were refused: their bodies may be none. */
static void add_body(struct page *page, const struct exchange *exchange, int32_t i)
{
    const struct query_placement *placement = &exchange->query->placement[i];
    const struct body_view *view = &placement->body;
    struct owned_scene memory = {.dim = 0};
    struct fmb_placement placed = placement->placed;
    char missing[2 * HANDLE_BYTES + 50] = "the log does not define its handle, ";
    const bool is_named = query_by_handle(placement);
    placed.name = exchange_name(exchange, i);
    placed.body = is_named ? NULL : body_of_view(view, &memory);
    for (size_t k = 0, used = strlen(missing); is_named && k < HANDLE_BYTES; k++)
        snprintf(missing + used + 2 * k, 3, "%02x", view->handle.bytes[k]);
    const bool is_good = fmb_placement_check(&placed) == FMB_OK &&
                         (placement->velocity_count == 0 || placement->velocity_count == view->dim);
    page_body(page, &placed,
              is_named  ? missing
              : is_good ? NULL
                        : "it is no body that can be drawn");
    scene_clear(&memory);
}

static struct page_result result_of(const struct exchange *exchange)
{
    struct page_result out = {.given = exchange->result};
    if (!out.given)
        return out;
    const struct result_head *head = &exchange->result->head;
    const struct fmb_method *by = head->method ? fmb_method_by_number(head->method) : NULL;
    out.error = head->status == FMB_OK ? NULL : fmb_status_text(head->status);
    out.method = by ? by->name : NULL;
    out.compute_ns = head->compute_ns;
    if (exchange->fits && head->status == FMB_OK)
        memcpy(out.count, exchange_count(exchange).verdict, sizeof out.count);
    return out;
}

static bool is_different(const struct exchange_pair *pair)
{
    const struct fmb_client_answer *a = &pair->answer[0], *b = &pair->answer[1];
    return pair->answered[0] && pair->answered[1] &&
           (a->status != b->status || !query_same_answer(&a->answer, &b->answer));
}

static bool certificates_differ(const struct exchange *then, const struct exchange *now)
{
    const char *a = then->named.certificate, *b = now->named.certificate;
    return then->fits && now->fits && then->of.status == FMB_OK && now->of.status == FMB_OK &&
           (a && b ? strcmp(a, b) != 0 : a != b);
}

void page_take(struct page *page, const struct page_replayed *replayed, struct exchange *then,
               struct exchange *now)
{
    static const char *const outcome[REPLAY_OUTCOMES] = {
        "same",     "different",         "busy", "unknown body", "not defined",
        "not held", "no result recorded"};
    const struct logged_query *query = now->query;
    const struct scene_query *scene = query->kind == LOG_SCENE_QUERY ? &query->scene : NULL;
    exchange_begin(then);
    exchange_begin(now);
    struct page_step step = {
        .time = ((double) replayed->place.utime - (double) replayed->begin) / 1e6,
        .duration = scene ? scene->duration : query->pair.duration,
        .margin = scene ? scene->margin : 0,
        .label = scene ? scene->label : NULL,
        .all = scene && scene->which != FMB_PAIRS_LISTED,
        .log = replayed->log,
        .event = replayed->place.number,
        .offset = replayed->place.offset,
        .outcome = outcome[replayed->outcome],
        .differs = replayed->outcome == REPLAY_DIFFERENT,
        .result = {result_of(then), result_of(now)}};
    char note[100];
    if (*replayed->note) {
        step.note = replayed->note;
        *then = (struct exchange){.query = query}; /* its pairs are of another scene */
        exchange_begin(then);
    } else if (!scene) {
        if (certificates_differ(then, now))
            step.note = "The certificates differ.";
    } else {
        const int64_t total = query_pair_count(scene), end = now->of.end_pair;
        if (scene->first_pair > 0 || end < total) {
            snprintf(note, sizeof note, "Pairs %" PRId32 " to %" PRId64 " of %" PRId64 ".",
                     scene->first_pair, end, total);
            step.note = note;
            step.all = false;
        }
    }
    page_step_begin(page, &step);
    for (int32_t i = 0; i < query->placement_count; i++)
        add_body(page, now, i);
    struct exchange *const both[2] = {then, now};
    for (struct exchange_pair pair; exchange_next_of_both(both, &pair);) {
        const int last = pair.answered[1];
        page_pair(page, both[last]->of.dim ? both[last]->of.dim : both[1 - last]->of.dim,
                  is_different(&pair) ? &pair.answer[0] : NULL, &pair.answer[last]);
    }
    page_step_end(page);
}
