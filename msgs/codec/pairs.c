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

/* Pairs that are not decided, each counted once. */
struct undecided {
    const struct scene_query *query;
    int32_t end_pair;
    int64_t count; /* of those from first_pair to end_pair */
    struct query_marks *marks;
};

static void count_undecided(struct undecided *undecided, const unsigned pair[2])
{
    const struct scene_query *query = undecided->query;
    const unsigned n = (unsigned) query_stored_placements(query);
    const unsigned a = pair[0] < pair[1] ? pair[0] : pair[1];
    const unsigned b = pair[0] < pair[1] ? pair[1] : pair[0];
    if (!query_has_pair(query, a, b))
        return;
    const unsigned bit = a * n + b;
    const int64_t number = query_pair_number(query, a, b);
    const bool counted = undecided->marks->bit[bit / 8] >> bit % 8 & 1;
    undecided->marks->bit[bit / 8] |= (unsigned char) (1u << bit % 8);
    undecided->count += !counted && number >= query->first_pair && number < undecided->end_pair;
}

static void count_grouped(struct undecided *undecided)
{
    const struct scene_query *query = undecided->query;
    const unsigned n = (unsigned) query_stored_placements(query);
    for (unsigned a = 0; a < n; a++)
        for (unsigned b = a + 1; b < n && query->placement[a].group != 0; b++)
            if (query->placement[a].group == query->placement[b].group)
                count_undecided(undecided, (const unsigned[2]){a, b});
}

static bool has_undecided(const struct scene_query *query)
{
    bool grouped = false;
    for (int32_t i = 0; i < query_stored_placements(query) && !grouped; i++)
        grouped = query->placement[i].group != 0;
    return query->which != FMB_PAIRS_LISTED && (query->ignored_count > 1 || grouped);
}

int64_t query_pairs_decided(const struct scene_query *query, int32_t end_pair,
                            struct query_marks *marks)
{
    struct undecided undecided = {.query = query, .end_pair = end_pair, .marks = marks};
    const size_t n = (size_t) query_stored_placements(query);
    if (has_undecided(query)) {
        memset(marks->bit, 0, n * n / 8 + 1);
        for (int32_t k = 0; k < query->ignored_count / 2; k++)
            count_undecided(&undecided, query->ignored[k]);
        count_grouped(&undecided);
    }
    return (int64_t) end_pair - query->first_pair - undecided.count;
}
