#include "exchange.h"

#include "allocate.h"
#include "wire.h"

#include <stdlib.h>
#include <string.h>

static bool are_below(const unsigned (*pair)[2], int32_t count, unsigned limit)
{
    for (int32_t k = 0; k < count; k++)
        if (pair[k][0] >= limit || pair[k][1] >= limit)
            return false;
    return true;
}

/* Whether the indices of the query are in range, and the result, of status OK, has answers to pairs
 * of the query only, in their order. */
static bool result_fits(const struct scene_query *query, const struct scene_result *result)
{
    const int32_t n = query_stored_placements(query), first = query->first_pair;
    const int32_t listed = query->index_count / 2, ignored = query->ignored_count / 2;
    if (query->placement_count != n || query->split < 0 || query->split > n || first < 0 ||
        listed > QUERY_PAIRS_MAX || ignored > QUERY_PAIRS_MAX ||
        !are_below(query->pair, listed, (unsigned) n) ||
        !are_below(query->ignored, ignored, (unsigned) n) || result->end_pair < first ||
        result->end_pair > query_pair_count(query))
        return false;
    if (query->which == FMB_PAIRS_LISTED)
        return (!result->names_pairs || result->verdict_count == 0) &&
               result->verdict_count == result->end_pair - first;
    int64_t before = first - 1;
    for (int32_t k = 0; k < result->verdict_count; k++) {
        const unsigned *pair = result->pair[k];
        if (!result->names_pairs || !query_has_pair(query, pair[0], pair[1]) ||
            query_pair_number(query, pair[0], pair[1]) <= before)
            return false;
        before = query_pair_number(query, pair[0], pair[1]);
    }
    return before < result->end_pair;
}

static bool lists_pairs(const struct exchange *exchange)
{
    return exchange->query && exchange->query->kind == LOG_SCENE_QUERY &&
           exchange->query->scene.which == FMB_PAIRS_LISTED;
}

/* Reads the next pair that the result names, and its number in the query. */
static void read_named(struct exchange *exchange)
{
    struct fmb_client_answer *named = &exchange->named;
    exchange->number = INT64_MAX;
    if (!exchange->fits)
        return;
    const struct pair_result *pair = &exchange->result->pair;
    const struct scene_result *scene = &exchange->result->scene;
    const int32_t k = exchange->answers++;
    if (k >= (exchange->is_pair ? 1 : scene->verdict_count))
        return;
    if (exchange->is_pair) {
        *named = (struct fmb_client_answer){.b = 1,
                                            .status = pair->status,
                                            .text = exchange->text,
                                            .answer = pair->answer,
                                            .certificate = pair->certificate};
        exchange->number = 0;
        return;
    }
    const struct scene_query *query = &exchange->query->scene;
    const bool listed = lists_pairs(exchange), decided = scene->verdict[k] != 0;
    const int32_t number = scene->end_pair - scene->verdict_count + k; /* in a list */
    const unsigned *of = listed ? query->pair[number] : scene->pair[k];
    *named = (struct fmb_client_answer){.a = of[0],
                                        .b = of[1],
                                        .status = decided ? FMB_OK : FMB_CANNOT_DECIDE,
                                        .text = decided ? "" : fmb_status_text(FMB_CANNOT_DECIDE)};
    wire_scene_answer(scene, k, &exchange->contacts, &named->answer);
    exchange->number = listed ? number : query_pair_number(query, of[0], of[1]);
}

void exchange_begin(struct exchange *exchange)
{
    const struct logged_query *query = exchange->query;
    const struct logged_result *result = exchange->result;
    static const struct result_head none;
    exchange->head = result ? &result->head : &none;
    exchange->is_pair = result && result->kind == LOG_PAIR_QUERY;
    exchange->end_pair = result && !exchange->is_pair ? result->scene.end_pair : 0;
    exchange->text = exchange->head->status == FMB_OK ? ""
                     : exchange->head->detail[0]      ? exchange->head->detail
                                                      : fmb_status_text(exchange->head->status);
    exchange->fits = exchange->is_pair || (result && query && result->head.status == FMB_OK &&
                                           result_fits(&query->scene, &result->scene));
    exchange->answers = exchange->contacts = 0;
    exchange->pair = (struct pair_cursor){0};
    read_named(exchange);
}

void exchange_end(struct exchange *exchange)
{
    if (!exchange->all)
        return;
    scene_clear(exchange->all);
    free(exchange->all);
    exchange->all = NULL;
}

/* Makes the pairs of the query, if it does not list them. */
static void make_pairs(struct exchange *exchange)
{
    const struct scene_query *query = &exchange->query->scene;
    struct owned_scene *all = exchange->all = allocate(1, sizeof *all);
    struct fmb_placement *placement =
        scene_alloc(all, (size_t) query->placement_count, sizeof *placement);
    for (int32_t i = 0; i < query->placement_count; i++)
        placement[i] = query->placement[i].placed;
    all->scene = (struct fmb_scene){.placements = placement,
                                    .placement_count = (size_t) query->placement_count,
                                    .which = (enum fmb_pairs) query->which,
                                    .split = (size_t) query->split,
                                    .ignored = query->ignored,
                                    .ignored_count = (size_t) (query->ignored_count / 2)};
    scene_begin_ignored(all);
}

/* Whether the result, which does not name the pair with this number, separates it. */
static bool separates(const struct exchange *exchange, int64_t number)
{
    return exchange->fits && !exchange->is_pair && !lists_pairs(exchange) &&
           number >= exchange->query->scene.first_pair && number < exchange->end_pair;
}

static struct fmb_client_answer separated_answer(unsigned a, unsigned b)
{
    return (struct fmb_client_answer){.a = a, .b = b, .text = "", .answer.verdict = FMB_SEPARATED};
}

/* Returns true and the next separated pair that comes before the next named one, or false. */
static bool next_separated(struct exchange *exchange, struct fmb_client_answer *out)
{
    const struct scene_query *query = &exchange->query->scene;
    unsigned pair[2];
    if (!exchange->all)
        make_pairs(exchange);
    const unsigned until[2] = {exchange->named.a, exchange->named.b};
    while (scene_next_pair_before(exchange->all, &exchange->pair,
                                  exchange->number < INT64_MAX ? until : NULL, pair))
        if (separates(exchange, query_pair_number(query, pair[0], pair[1]))) {
            *out = separated_answer(pair[0], pair[1]);
            return true;
        }
    return false;
}

bool exchange_next(struct exchange *exchange, bool separated, struct fmb_client_answer *out)
{
    if (separated && exchange->fits && !exchange->is_pair && !lists_pairs(exchange) &&
        next_separated(exchange, out))
        return true;
    if (exchange->number == INT64_MAX)
        return false;
    *out = exchange->named;
    read_named(exchange);
    return true;
}

bool exchange_next_of_both(struct exchange *const both[2], struct exchange_pair *out)
{
    const int first = both[1]->number < both[0]->number;
    const int64_t number = both[first]->number;
    if (number == INT64_MAX)
        return false;
    *out = (struct exchange_pair){.a = both[first]->named.a, .b = both[first]->named.b};
    for (int i = 0; i < 2; i++) {
        out->answered[i] = both[i]->number == number || separates(both[i], number);
        if (both[i]->number == number)
            exchange_next(both[i], false, &out->answer[i]);
        else if (out->answered[i])
            out->answer[i] = separated_answer(out->a, out->b);
    }
    return true;
}

struct exchange_counts exchange_count(const struct exchange *exchange)
{
    struct exchange named = *exchange;
    struct exchange_counts counts = {{0}};
    struct fmb_client_answer answer;
    exchange_begin(&named);
    while (exchange_next(&named, false, &answer))
        counts.verdict[answer.answer.verdict]++;
    if (exchange->fits && !exchange->is_pair && !lists_pairs(exchange)) {
        unsigned *memory = allocate_unset(QUERY_IGNORED_CAPACITY * sizeof *memory);
        int64_t others =
            query_pairs_decided(&exchange->query->scene, exchange->result->scene.end_pair, memory);
        free(memory);
        for (int verdict = 0; verdict <= FMB_OVERLAPPING; verdict++)
            others -= counts.verdict[verdict];
        counts.verdict[FMB_SEPARATED] += others > 0 ? others : 0;
    }
    return counts;
}

int64_t exchange_decided(const struct exchange *exchange)
{
    const struct exchange_counts counts = exchange_count(exchange);
    return counts.verdict[FMB_SEPARATED] + counts.verdict[FMB_TOUCHING] +
           counts.verdict[FMB_OVERLAPPING];
}

const char *exchange_name(const struct exchange *exchange, int32_t placement)
{
    const struct fmb_placement *placed = &exchange->query->placement[placement].placed;
    const char *name =
        body_names_find(exchange->names, exchange->query->header.client_id, placed->id);
    return name ? name : placed->name && *placed->name ? placed->name : NULL;
}
