#include "scene_pairs.h"

#include <assert.h>

/* Placements whose partners are searched for at a time: tens of microseconds. */
enum { SEARCHES_MAX = 32 };

/* Pairs (a, b) have a below rows() and b from first_partner() on. */
static unsigned rows(const struct scene_query *query)
{
    return (unsigned) (query->which == QUERY_PAIRS_ACROSS ? query->split : query->placement_count);
}

static unsigned first_partner(const struct scene_query *query, unsigned a)
{
    return query->which == QUERY_PAIRS_ACROSS ? (unsigned) query->split : a + 1;
}

/* The pairs of the placements before a: fewer than 2^20. */
static int32_t pairs_before(const struct scene_query *query, unsigned a)
{
    const int32_t n = query->placement_count, i = (int32_t) a;
    if (query->which == QUERY_PAIRS_ACROSS)
        return i * (n - query->split);
    return i * n - i * (i + 1) / 2;
}

static int32_t number_of(const struct scene_query *query, unsigned a, unsigned b)
{
    return pairs_before(query, a) + (int32_t) (b - first_partner(query, a));
}

int32_t scene_pairs_total(const struct scene_query *query)
{
    if (query->which == QUERY_PAIRS_LISTED)
        return query->index_count / 2;
    return pairs_before(query, rows(query));
}

int32_t scene_pairs_number(const struct scene_query *query, const unsigned (*block)[2], size_t k)
{
    if (query->which == QUERY_PAIRS_LISTED)
        return (int32_t) (block - query->pair) + (int32_t) k;
    return number_of(query, block[k][0], block[k][1]);
}

int32_t scene_pairs_position(const struct scene_pairs *pairs)
{
    if (pairs->query->which == QUERY_PAIRS_LISTED)
        return pairs->next;
    if (pairs->given < pairs->found_count)
        return number_of(pairs->query, pairs->a, pairs->found[pairs->given]);
    return pairs->a < rows(pairs->query) ? pairs_before(pairs->query, pairs->a + 1)
                                         : scene_pairs_total(pairs->query);
}

/* ---- All and across ---- */

static void find_partners(struct scene_pairs *pairs, unsigned from)
{
    const enum fmb_status status = fmb_tree_ask(&pairs->tree, &pairs->prepared[pairs->a], from,
                                                pairs->found, &pairs->found_count);
    assert(status == FMB_OK);
    (void) status;
    pairs->given = 0;
}

static void begin_found(struct scene_pairs *pairs, void *memory)
{
    const struct scene_query *query = pairs->query;
    const enum fmb_status status = fmb_tree_build(pairs->prepared, (size_t) query->placement_count,
                                                  query->duration, memory, &pairs->tree);
    assert(status == FMB_OK);
    (void) status;
    while (pairs->a < rows(query) && pairs_before(query, pairs->a + 1) <= query->first_pair)
        pairs->a++;
    const int32_t before = pairs_before(query, pairs->a);
    if (pairs->a < rows(query))
        find_partners(pairs,
                      first_partner(query, pairs->a) + (unsigned) (query->first_pair - before));
}

void scene_pairs_begin(struct scene_pairs *pairs, const struct scene_query *query,
                       const struct fmb_prepared *prepared, void *memory)
{
    pairs->query = query;
    pairs->prepared = prepared;
    pairs->next = query->first_pair;
    pairs->a = 0;
    pairs->found_count = pairs->given = 0;
    if (query->which != QUERY_PAIRS_LISTED)
        begin_found(pairs, memory);
}

static size_t next_found(struct scene_pairs *pairs, unsigned (*out)[2], size_t max)
{
    size_t count = 0;
    int searches = 0;
    while (count < max && pairs->a < rows(pairs->query)) {
        if (pairs->given < pairs->found_count) {
            out[count][0] = pairs->a;
            out[count++][1] = pairs->found[pairs->given++];
        } else if (searches++ == SEARCHES_MAX) {
            break;
        } else if (++pairs->a < rows(pairs->query)) {
            find_partners(pairs, first_partner(pairs->query, pairs->a));
        }
    }
    return count;
}

size_t scene_pairs_next(struct scene_pairs *pairs, unsigned (*out)[2], size_t max,
                        const unsigned (**block)[2])
{
    if (pairs->query->which != QUERY_PAIRS_LISTED) {
        *block = (const unsigned(*)[2]) out;
        return next_found(pairs, out, max);
    }
    const size_t left = (size_t) (pairs->query->index_count / 2 - pairs->next);
    const size_t count = left < max ? left : max;
    *block = pairs->query->pair + pairs->next;
    pairs->next += (int32_t) count;
    return count;
}
