#include "page_pairs.h"

#include "logged_query.h"

#include <math.h>
#include <string.h>

/* Equal, or both NaN. */
static bool same_numbers(const double *a, const double *b, int count)
{
    for (int i = 0; i < count; i++)
        if (!(a[i] == b[i] || (isnan(a[i]) && isnan(b[i]))))
            return false;
    return true;
}

static bool same(const struct page_side *a, const struct page_side *b)
{
    return a->verdict == b->verdict && a->has_times == b->has_times && a->dim == b->dim &&
           same_numbers(a->times, b->times, 2) && same_numbers(a->box[0], b->box[0], FMB_DIM_MAX) &&
           same_numbers(a->box[1], b->box[1], FMB_DIM_MAX) && a->gap_dim == b->gap_dim &&
           (a->gap_dim == 0 || query_same_gap(a->gap, b->gap));
}

static bool differs(const struct page_pair *pair)
{
    return pair->then.answered && pair->now.answered && !same(&pair->then, &pair->now);
}

/* ---- A pair query ---------------------------------------------------------------------------- */

static struct page_side side_of_pair(const struct pair_result *result)
{
    struct page_side side;
    memset(&side, 0, sizeof side);
    if (!result || result->status != FMB_OK)
        return side;
    const struct fmb_answer *answer = &result->answer;
    side.answered = true;
    side.verdict = (unsigned char) answer->verdict;
    side.has_times = answer->has_contact;
    if (answer->has_contact)
        memcpy(side.times, answer->contact, sizeof side.times);
    side.dim = answer->has_box ? result->dim : 0;
    if (answer->has_box)
        memcpy(side.box, answer->box, sizeof side.box);
    side.gap_dim = answer->has_gap ? result->dim : 0;
    side.gap = &answer->gap;
    return side;
}

static bool next_of_pair(struct page_pairs *pairs, struct page_pair *out)
{
    if (pairs->pair_given)
        return false;
    pairs->pair_given = true;
    out->a = 0;
    out->b = 1;
    out->then = side_of_pair(pairs->replayed->pair_then);
    out->now = side_of_pair(pairs->replayed->pair_now);
    return true;
}

/* ---- A scene --------------------------------------------------------------------------------- */

/* Number of listed pairs in the struct. */
static int32_t listed_count(const struct scene_query *query)
{
    const int32_t count = query->index_count / 2;
    return count < QUERY_PAIRS_MAX ? count : QUERY_PAIRS_MAX;
}

static bool has_verdict(const struct page_place *place)
{
    return place->result && place->verdict < place->result->verdict_count;
}

/* Returns the next verdict of the result, with its times, box and gap, and advances the position.
 */
static struct page_side take(struct page_place *place)
{
    const struct scene_result *result = place->result;
    struct page_side side;
    memset(&side, 0, sizeof side);
    side.answered = true;
    side.verdict = result->verdict[place->verdict];
    if (result->has_gaps) {
        side.gap = &result->gap[place->verdict];
        side.gap_dim = query_has_gap(side.gap) ? result->dim : 0;
    }
    place->verdict++;
    if (side.verdict < FMB_TOUCHING || place->contact >= result->contact_count)
        return side;
    const int32_t contact = place->contact++, dim = result->has_boxes ? result->dim : 0;
    side.has_times = result->has_times;
    if (side.has_times)
        memcpy(side.times, &result->times[2 * contact], sizeof side.times);
    side.dim = dim;
    for (int end = 0; end < 2; end++)
        for (int axis = 0; axis < dim; axis++)
            side.box[end][axis] = result->boxes[(2 * contact + end) * dim + axis];
    return side;
}

static struct page_side no_answer(void)
{
    struct page_side side;
    memset(&side, 0, sizeof side);
    return side;
}

static bool next_listed(struct page_pairs *pairs, struct page_pair *out)
{
    const struct scene_query *query = pairs->replayed->scene;
    const int32_t done =
        pairs->then.verdict > pairs->now.verdict ? pairs->then.verdict : pairs->now.verdict;
    if (query->first_pair < 0 || query->first_pair >= listed_count(query) - done ||
        !(has_verdict(&pairs->then) || has_verdict(&pairs->now)))
        return false;
    out->a = query->pair[query->first_pair + done][0];
    out->b = query->pair[query->first_pair + done][1];
    out->then = has_verdict(&pairs->then) ? take(&pairs->then) : no_answer();
    out->now = has_verdict(&pairs->now) ? take(&pairs->now) : no_answer();
    return true;
}

/* Whether the next pair that the result names precedes (a, b), or there is no (a, b) so far. */
static bool comes_before(const struct page_place *place, bool found, unsigned a, unsigned b)
{
    if (!has_verdict(place) || !place->result->names_pairs)
        return false;
    const unsigned *pair = place->result->pair[place->verdict];
    return !found || pair[0] < a || (pair[0] == a && pair[1] < b);
}

static struct page_side side_of_named(const struct scene_query *query, struct page_place *place,
                                      unsigned a, unsigned b)
{
    struct page_side side = no_answer();
    if (!place->result)
        return side;
    if (has_verdict(place) && place->result->names_pairs &&
        place->result->pair[place->verdict][0] == a && place->result->pair[place->verdict][1] == b)
        return take(place);
    const int64_t number = logged_query_pair_number(query, a, b);
    side.answered = number >= query->first_pair && number < place->result->end_pair;
    side.verdict = side.answered ? FMB_SEPARATED : 0;
    return side;
}

static bool next_named(struct page_pairs *pairs, struct page_pair *out)
{
    const struct page_place *places[] = {&pairs->then, &pairs->now};
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
    out->then = side_of_named(pairs->replayed->scene, &pairs->then, a, b);
    out->now = side_of_named(pairs->replayed->scene, &pairs->now, a, b);
    return true;
}

/* ---- Either ---------------------------------------------------------------------------------- */

static struct page_place begin(const struct scene_result *result)
{
    return (struct page_place){.result = result && result->status == FMB_OK ? result : NULL};
}

void page_pairs_begin(const struct replayed *replayed, struct page_pairs *out)
{
    *out = (struct page_pairs){.replayed = replayed,
                               .then = begin(replayed->scene_then),
                               .now = begin(replayed->scene_now)};
}

bool page_pairs_next(struct page_pairs *pairs, struct page_pair *out)
{
    const struct scene_query *scene = pairs->replayed->scene;
    bool found;
    if (!scene)
        found = next_of_pair(pairs, out);
    else if (scene->which == QUERY_PAIRS_LISTED)
        found = next_listed(pairs, out);
    else
        found = next_named(pairs, out);
    if (found)
        out->differs = differs(out);
    return found;
}

void page_pairs_count(const struct scene_query *query, const struct scene_result *result,
                      int64_t count[FMB_OVERLAPPING + 1])
{
    memset(count, 0, (FMB_OVERLAPPING + 1) * sizeof *count);
    if (!result || result->status != FMB_OK)
        return;
    for (int32_t i = 0; i < result->verdict_count; i++)
        if (result->verdict[i] <= FMB_OVERLAPPING)
            count[result->verdict[i]]++;
    if (query->which == QUERY_PAIRS_LISTED)
        return;
    const int64_t others = (int64_t) result->end_pair - query->first_pair - result->verdict_count;
    count[FMB_SEPARATED] += others > 0 ? others : 0;
}
