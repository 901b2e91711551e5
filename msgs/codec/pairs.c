/* The pairs of a scene query, by number. */
#include "query.h"

#include "pair_number.h"

int32_t query_stored_placements(const struct scene_query *query)
{
    return query->placement_count < QUERY_PLACEMENTS_MAX ? query->placement_count
                                                         : QUERY_PLACEMENTS_MAX;
}

static struct pair_numbers numbers_of(const struct scene_query *query)
{
    return (struct pair_numbers){query->which == FMB_PAIRS_ACROSS,
                                 (size_t) query_stored_placements(query), (size_t) query->split};
}

int64_t query_pair_number(const struct scene_query *query, unsigned a, unsigned b)
{
    return (int64_t) pair_number(numbers_of(query), a, b);
}

int64_t query_pair_count(const struct scene_query *query)
{
    return query->which == FMB_PAIRS_LISTED ? query->index_count / 2
                                            : (int64_t) pairs_total(numbers_of(query));
}

bool query_has_pair(const struct scene_query *query, unsigned a, unsigned b)
{
    return pair_is_among(numbers_of(query), a, b);
}

/* ---- Sets of pairs ---- */

void query_marks_clear(struct query_marks *marks, unsigned placements)
{
    marks->placements = placements;
    memset(marks->bit, 0, placements * placements / 8 + 1);
}

static unsigned bit_of(const struct query_marks *marks, const unsigned pair[2])
{
    const unsigned lower = pair[0] < pair[1] ? pair[0] : pair[1];
    return lower * marks->placements + (pair[0] + pair[1] - lower);
}

bool query_is_marked(const struct query_marks *marks, const unsigned pair[2])
{
    const unsigned bit = bit_of(marks, pair);
    return marks->bit[bit / 8] >> bit % 8 & 1;
}

void query_mark(struct query_marks *marks, const unsigned pair[2])
{
    const unsigned bit = bit_of(marks, pair);
    marks->bit[bit / 8] |= (unsigned char) (1u << bit % 8);
}

/* ---- Pairs that are decided ---- */

/* Marks a pair that is not decided. Returns 1 if it is one from first_pair to end_pair that was not
 * marked; else 0. */
static int count_undecided(const struct scene_query *query, int32_t end_pair,
                           struct query_marks *marks, const unsigned pair[2])
{
    const bool ordered = pair[0] < pair[1];
    const unsigned a = pair[!ordered], b = pair[ordered];
    if (!query_has_pair(query, a, b) || query_is_marked(marks, pair))
        return 0;
    const int64_t number = query_pair_number(query, a, b);
    query_mark(marks, pair);
    return number >= query->first_pair && number < end_pair;
}

static bool has_undecided(const struct scene_query *query)
{
    bool grouped = false;
    for (int32_t i = 0; i < query_stored_placements(query) && !grouped; i++)
        grouped = query->placement[i].placed.group != 0;
    return query->which != FMB_PAIRS_LISTED && (query->ignored_count > 1 || grouped);
}

int64_t query_pairs_decided(const struct scene_query *query, int32_t end_pair,
                            struct query_marks *marks)
{
    int64_t decided = (int64_t) end_pair - query->first_pair;
    const struct query_placement *placement = query->placement;
    const unsigned n = (unsigned) query_stored_placements(query);
    if (!has_undecided(query))
        return decided;
    query_marks_clear(marks, n);
    for (int32_t k = 0; k < query->ignored_count / 2; k++)
        decided -= count_undecided(query, end_pair, marks, query->ignored[k]);
    for (unsigned a = 0; a < n; a++)
        for (unsigned b = a + 1; b < n && placement[a].placed.group != 0; b++)
            if (placement[a].placed.group == placement[b].placed.group)
                decided -= count_undecided(query, end_pair, marks, (const unsigned[2]){a, b});
    return decided;
}
