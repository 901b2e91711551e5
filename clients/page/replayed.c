#include "replayed.h"

#include "wire.h"

#include <string.h>

static const struct replayed_side no_answer;

/* ---- A pair query ---------------------------------------------------------------------------- */

static struct replayed_side side_of_pair(const struct logged_result *result)
{
    if (!result || result->pair.status != FMB_OK)
        return no_answer;
    return (struct replayed_side){true, result->pair.dim, result->pair.answer};
}

static bool next_of_pair(struct replayed_pairs *pairs, struct replayed_pair *out)
{
    if (pairs->pair_given)
        return false;
    pairs->pair_given = true;
    out->a = 0;
    out->b = 1;
    out->then = pairs->replayed->change ? no_answer : side_of_pair(pairs->replayed->then);
    out->now = side_of_pair(pairs->replayed->now);
    return true;
}

/* ---- A scene --------------------------------------------------------------------------------- */

/* Number of listed pairs in the struct. */
static int32_t listed_count(const struct scene_query *query)
{
    const int32_t count = query->index_count / 2;
    return count < QUERY_PAIRS_MAX ? count : QUERY_PAIRS_MAX;
}

static bool has_verdict(const struct replayed_place *place)
{
    return place->result && place->verdict < place->result->verdict_count;
}

/* Returns the next answer of the result, and advances the position. */
static struct replayed_side take(struct replayed_place *place)
{
    const struct scene_result *result = place->result;
    struct replayed_side side = {.answered = true};
    wire_scene_answer(result, place->verdict++, &place->contact, &side.answer);
    side.dim = side.answer.has_box || side.answer.has_gap ? result->dim : 0;
    return side;
}

static bool next_listed(struct replayed_pairs *pairs, struct replayed_pair *out)
{
    const struct scene_query *query = &pairs->replayed->query->scene;
    const int32_t done =
        pairs->then.verdict > pairs->now.verdict ? pairs->then.verdict : pairs->now.verdict;
    if (query->first_pair < 0 || query->first_pair >= listed_count(query) - done ||
        !(has_verdict(&pairs->then) || has_verdict(&pairs->now)))
        return false;
    out->a = query->pair[query->first_pair + done][0];
    out->b = query->pair[query->first_pair + done][1];
    out->then = has_verdict(&pairs->then) ? take(&pairs->then) : no_answer;
    out->now = has_verdict(&pairs->now) ? take(&pairs->now) : no_answer;
    return true;
}

/* Whether the next pair that the result names precedes (a, b), or there is no (a, b) so far. */
static bool comes_before(const struct replayed_place *place, bool found, unsigned a, unsigned b)
{
    if (!has_verdict(place) || !place->result->names_pairs)
        return false;
    const unsigned *pair = place->result->pair[place->verdict];
    return !found || pair[0] < a || (pair[0] == a && pair[1] < b);
}

static struct replayed_side side_of_named(const struct scene_query *query,
                                          struct replayed_place *place, unsigned a, unsigned b)
{
    struct replayed_side side = no_answer;
    if (!place->result)
        return side;
    if (has_verdict(place) && place->result->names_pairs &&
        place->result->pair[place->verdict][0] == a && place->result->pair[place->verdict][1] == b)
        return take(place);
    const int64_t number = query_pair_number(query, a, b);
    side.answered = number >= query->first_pair && number < place->result->end_pair;
    side.answer.verdict = side.answered ? FMB_SEPARATED : 0;
    return side;
}

static bool next_named(struct replayed_pairs *pairs, struct replayed_pair *out)
{
    const struct replayed_place *places[] = {&pairs->then, &pairs->now};
    bool found = false;
    for (int i = 0; i < 2; i++) {
        if (!comes_before(places[i], found, out->a, out->b))
            continue;
        out->a = places[i]->result->pair[places[i]->verdict][0];
        out->b = places[i]->result->pair[places[i]->verdict][1];
        found = true;
    }
    if (!found)
        return false;
    const unsigned a = out->a, b = out->b;
    out->then = side_of_named(&pairs->replayed->query->scene, &pairs->then, a, b);
    out->now = side_of_named(&pairs->replayed->query->scene, &pairs->now, a, b);
    return true;
}

/* ---- Either ---------------------------------------------------------------------------------- */

static struct replayed_place begin(const struct replayed *replayed,
                                   const struct logged_result *result)
{
    const bool scene = result && result->kind == LOG_SCENE_QUERY &&
                       result->scene.status == FMB_OK &&
                       logged_result_fits(&replayed->query->scene, &result->scene);
    return (struct replayed_place){.result = scene ? &result->scene : NULL};
}

void replayed_pairs_begin(const struct replayed *replayed, struct replayed_pairs *out)
{
    *out =
        (struct replayed_pairs){.replayed = replayed,
                                .then = begin(replayed, replayed->change ? NULL : replayed->then),
                                .now = begin(replayed, replayed->now)};
}

bool replayed_pairs_next(struct replayed_pairs *pairs, struct replayed_pair *out)
{
    const struct logged_query *query = pairs->replayed->query;
    if (query->kind == LOG_PAIR_QUERY)
        return next_of_pair(pairs, out);
    return query->scene.which == FMB_PAIRS_LISTED ? next_listed(pairs, out)
                                                  : next_named(pairs, out);
}

void replayed_count(const struct scene_query *query, const struct scene_result *result,
                    int64_t count[FMB_OVERLAPPING + 1])
{
    memset(count, 0, (FMB_OVERLAPPING + 1) * sizeof *count);
    if (!result || result->status != FMB_OK || !logged_result_fits(query, result))
        return;
    for (int32_t i = 0; i < result->verdict_count; i++)
        if (result->verdict[i] <= FMB_OVERLAPPING)
            count[result->verdict[i]]++;
    if (query->which == FMB_PAIRS_LISTED)
        return;
    const int64_t others =
        logged_query_pairs_until(query, result->end_pair) - result->verdict_count;
    count[FMB_SEPARATED] += others > 0 ? others : 0;
}

int64_t replayed_decided(const struct scene_query *query, const struct scene_result *result)
{
    int64_t count[FMB_OVERLAPPING + 1];
    replayed_count(query, result, count);
    return count[FMB_SEPARATED] + count[FMB_TOUCHING] + count[FMB_OVERLAPPING];
}
