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

/* ---- Pairs that are not decided ---- */

void query_ignored(const struct scene_query *query, unsigned memory[QUERY_IGNORED_CAPACITY],
                   struct ignored *out)
{
    const struct fmb_scene scene = {.placement_count = (size_t) query_stored_placements(query),
                                    .ignored = query->ignored,
                                    .ignored_count = (size_t) query->ignored_count / 2};
    ignored_begin(&scene, memory, out);
}

/* Whether split and the ignored indices are in range, as those of a query that was accepted. */
static bool is_in_range(const struct scene_query *query)
{
    const unsigned n = (unsigned) query_stored_placements(query);
    if (query->split < 0 || (unsigned) query->split > n)
        return false;
    for (int32_t k = 0; k < query->ignored_count / 2; k++)
        if (query->ignored[k][0] >= n || query->ignored[k][1] >= n)
            return false;
    return true;
}

int64_t query_pairs_decided(const struct scene_query *query, int32_t end_pair,
                            unsigned memory[QUERY_IGNORED_CAPACITY])
{
    const struct pair_numbers of = numbers_of(query);
    const struct query_placement *placement = query->placement;
    int64_t decided = (int64_t) end_pair - query->first_pair;
    struct ignored ignored;
    if (query->which == FMB_PAIRS_LISTED || !is_in_range(query))
        return decided;
    query_ignored(query, memory, &ignored);
    for (size_t a = 0; a < pair_rows(of); a++) {
        const int64_t group = placement[a].placed.group;
        const int64_t before = (int64_t) pairs_before(of, a);
        size_t b = pair_first_partner(of, a);
        if (group == 0 && !ignored_has_any(&ignored, (unsigned) a))
            continue;
        for (int64_t number = before; b < of.n; b++, number++)
            decided -= number >= query->first_pair && number < end_pair &&
                       ((group != 0 && group == placement[b].placed.group) ||
                        ignored_has(&ignored, (unsigned) a, (unsigned) b));
    }
    return decided;
}
