#include "page_exchange.h"

#include <inttypes.h>
#include <string.h>

enum { NOTE_MAX = 100 };

/* Adds a body. Its frames are stored in `memory`. Logs also contain queries that were refused:
 * their bodies may be invalid. */
static void add_body(struct page *page, const struct exchange *exchange, int32_t i,
                     struct owned_scene *memory)
{
    const struct query_placement *placement = &exchange->query->placement[i];
    const struct body_view *view = &placement->body;
    struct fmb_placement placed = placement->placed;
    char missing[2 * HANDLE_BYTES + 50] = "the log does not define its handle, ";
    const bool is_named = query_by_handle(placement);
    placed.name = exchange_name(exchange, i);
    placed.body = is_named ? NULL : body_of_view(view, memory);
    for (size_t k = 0, used = strlen(missing); is_named && k < HANDLE_BYTES; k++)
        snprintf(missing + used + 2 * k, 3, "%02x", view->handle.bytes[k]);
    const bool is_good = fmb_placement_check(&placed) == FMB_OK &&
                         (placement->velocity_count == 0 || placement->velocity_count == view->dim);
    page_body(page, &placed,
              is_named  ? missing
              : is_good ? NULL
                        : "it is not a body that can be drawn");
}

static void put_result(struct json_writer *json, const struct exchange *exchange)
{
    const struct result_head *head = exchange->head;
    if (!exchange->result) {
        json_null(json, NULL);
        return;
    }
    const int method = head->method;
    const struct fmb_method *by = method ? fmb_method_by_number(method) : NULL;
    struct exchange_counts counts = {{0}};
    if (exchange->fits && head->status == FMB_OK)
        counts = exchange_count(exchange);
    json_begin(json, NULL, '{');
    if (head->status != FMB_OK)
        json_string(json, "error", fmb_status_text(head->status));
    if (by)
        json_string(json, "method", by->name);
    json_integer(json, "compute_ns", head->compute_ns);
    json_integers(json, "counts", &counts.verdict[FMB_SEPARATED], FMB_OVERLAPPING);
    json_end(json, '}');
}

static bool certificates_differ(const struct exchange *then, const struct exchange *now)
{
    const char *a = then->named.certificate, *b = now->named.certificate;
    return then->fits && now->fits && then->head->status == FMB_OK && now->head->status == FMB_OK &&
           (a && b ? strcmp(a, b) != 0 : a != b);
}

/* What is said about the step as a whole; "": nothing. */
static void note_of(const struct exchange *then, const struct exchange *now, char out[NOTE_MAX])
{
    *out = 0;
    if (now->query->kind == LOG_PAIR_QUERY) {
        if (certificates_differ(then, now))
            strcpy(out, "The certificates differ.");
        return;
    }
    const struct scene_query *scene = &now->query->scene;
    const int64_t total = query_pair_count(scene), end = now->end_pair;
    if (scene->first_pair > 0 || end < total)
        snprintf(out, NOTE_MAX, "Pairs %" PRId32 " to %" PRId64 " of %" PRId64 ".",
                 scene->first_pair, end, total);
}

static void put_step(struct json_writer *json, const struct page_replayed *replayed,
                     const struct exchange *then, const struct exchange *now)
{
    static const char *const outcome[REPLAY_OUTCOMES] = {
        "same",     "different",         "busy", "unknown body", "not defined",
        "not held", "no result recorded"};
    const struct logged_query *query = now->query;
    char note[NOTE_MAX];
    note_of(then, now, note);
    if (query->kind == LOG_SCENE_QUERY && query->scene.which != FMB_PAIRS_LISTED &&
        (*replayed->note || !*note))
        json_bool(json, "all", true);
    if (*replayed->note || *note)
        json_string(json, "note", *replayed->note ? replayed->note : note);
    json_string(json, "log", replayed->log);
    json_integer(json, "event", replayed->place.number);
    json_integer(json, "offset", replayed->place.offset);
    json_string(json, "outcome", outcome[replayed->outcome]);
    json_begin(json, "result", '[');
    put_result(json, then);
    put_result(json, now);
    json_end(json, ']');
}

void page_take(struct page *page, const struct page_replayed *replayed, struct exchange *then,
               struct exchange *now)
{
    const struct logged_query *query = now->query;
    const bool is_scene = query->kind == LOG_SCENE_QUERY;
    const struct page_step step = {
        .time = ((double) replayed->place.utime - (double) replayed->begin) / 1e6,
        .duration = is_scene ? query->scene.duration : query->pair.duration,
        .margin = is_scene ? query->scene.margin : 0,
        .label = is_scene ? query->scene.label : NULL,
        .differs = replayed->outcome == REPLAY_DIFFERENT,
        .bodies_remain = true};
    struct owned_scene memory = {.dim = 0};
    struct json_writer *json = page_step_begin(page, &step);
    if (!json)
        return;
    exchange_begin(then);
    exchange_begin(now);
    put_step(json, replayed, then, now);
    if (*replayed->note) {
        *then = (struct exchange){.query = query}; /* its pairs are of another scene */
        exchange_begin(then);
    }
    for (int32_t i = 0; i < query->placement_count; i++)
        add_body(page, now, i, &memory);
    struct exchange *const both[2] = {then, now};
    for (struct exchange_pair pair; exchange_next_of_both(both, &pair);) {
        const int last = pair.answered[1];
        const struct fmb_client_answer *a = &pair.answer[0], *b = &pair.answer[1];
        const bool differ = pair.answered[0] && pair.answered[1] &&
                            (a->status != b->status || !query_same_answer(&a->answer, &b->answer));
        page_pair(page, both[last]->head->dim ? both[last]->head->dim : both[1 - last]->head->dim,
                  differ ? a : NULL, &pair.answer[last]);
    }
    page_step_end(page);
    scene_clear(&memory);
}
