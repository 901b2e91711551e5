#include "query_pairs.h"

int32_t query_stored_placements(const struct scene_query *query)
{
    return query->placement_count < QUERY_PLACEMENTS_MAX ? query->placement_count
                                                         : QUERY_PLACEMENTS_MAX;
}

bool query_has_pair(const struct scene_query *query, unsigned a, unsigned b)
{
    return a < b && b < (int64_t) query_stored_placements(query) &&
           (query->which != QUERY_PAIRS_ACROSS ||
            (a < (int64_t) query->split && b >= (int64_t) query->split));
}

int64_t query_pair_number(const struct scene_query *query, unsigned a, unsigned b)
{
    const int64_t n = query_stored_placements(query), first = a, second = b;
    if (query->which == QUERY_PAIRS_ACROSS)
        return first * (n - query->split) + second - query->split;
    return first * n - first * (first + 1) / 2 + second - (first + 1);
}

size_t query_pair_bit(const unsigned pair[2])
{
    const unsigned lower = pair[0] < pair[1] ? pair[0] : pair[1];
    const unsigned upper = pair[0] < pair[1] ? pair[1] : pair[0];
    return (size_t) lower * QUERY_PLACEMENTS_MAX + upper;
}

/* Whether an ignored pair is one of those to be counted. */
static bool is_counted(const struct scene_query *query, const unsigned pair[2], int32_t end_pair)
{
    const unsigned a = pair[0] < pair[1] ? pair[0] : pair[1];
    const unsigned b = pair[0] < pair[1] ? pair[1] : pair[0];
    return query_has_pair(query, a, b) && query_pair_number(query, a, b) >= query->first_pair &&
           query_pair_number(query, a, b) < end_pair;
}

int64_t query_pairs_until(const struct scene_query *query, int32_t end_pair,
                          unsigned char set[QUERY_PAIR_SET_BYTES])
{
    int64_t pairs = (int64_t) end_pair - query->first_pair;
    if (query->which == QUERY_PAIRS_LISTED)
        return pairs;
    for (int32_t i = 0; i < query->ignored_count / 2; i++)
        if (is_counted(query, query->ignored[i], end_pair))
            set[query_pair_bit(query->ignored[i]) / 8] = 0;
    for (int32_t i = 0; i < query->ignored_count / 2; i++) {
        if (!is_counted(query, query->ignored[i], end_pair))
            continue;
        const size_t bit = query_pair_bit(query->ignored[i]);
        pairs -= !(set[bit / 8] >> bit % 8 & 1); /* not for a repetition */
        set[bit / 8] |= (unsigned char) (1u << bit % 8);
    }
    return pairs;
}
