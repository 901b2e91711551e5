#include "scene_pairs.h"

#include <assert.h>
#include <string.h>

/* Frame a is asked against the frames from partners() on, if it is one of the first askers(). */
static unsigned askers(const struct scene_query *query)
{
    return (unsigned) (query->which == QUERY_PAIRS_ACROSS ? query->split : query->frame_count);
}

static unsigned partners(const struct scene_query *query, unsigned a)
{
    return query->which == QUERY_PAIRS_ACROSS ? (unsigned) query->split : a + 1;
}

/* The pairs of the frames before a. 1,400 frames have fewer than 2^20 pairs. */
static int32_t pairs_before(const struct scene_query *query, unsigned a)
{
    const int32_t n = query->frame_count, i = (int32_t) a;
    if (query->which == QUERY_PAIRS_ACROSS)
        return i * (n - query->split);
    return i * n - i * (i + 1) / 2;
}

int32_t scene_pairs_total(const struct scene_query *query)
{
    if (query->which == QUERY_PAIRS_LISTED)
        return query->index_count / 2;
    return pairs_before(query, askers(query));
}

int32_t scene_pairs_number(const struct scene_query *query, const unsigned (*pair)[2], size_t k)
{
    if (query->which == QUERY_PAIRS_LISTED)
        return (int32_t) (pair - query->pair) + (int32_t) k;
    const unsigned a = pair[k][0], b = pair[k][1];
    return pairs_before(query, a) + (int32_t) (b - partners(query, a));
}

/* ---- All and across ---- */

static void find_partners(struct scene_pairs *pairs, unsigned from)
{
    const enum fmb_status status = fmb_tree_ask(&pairs->tree, &pairs->frame[pairs->a], from,
                                                pairs->found, &pairs->found_count);
    assert(status == FMB_OK);
    (void) status;
    pairs->given = 0;
}

static void begin_found(struct scene_pairs *pairs, void *memory)
{
    const struct scene_query *query = pairs->query;
    const enum fmb_status status = fmb_tree_build(pairs->frame, (size_t) query->frame_count,
                                                  query->duration, memory, &pairs->tree);
    assert(status == FMB_OK);
    (void) status;
    while (pairs->a < askers(query) && pairs_before(query, pairs->a + 1) <= query->first_pair)
        pairs->a++;
    const int32_t before = pairs_before(query, pairs->a);
    if (pairs->a < askers(query))
        find_partners(pairs, partners(query, pairs->a) + (unsigned) (query->first_pair - before));
}

void scene_pairs_begin(struct scene_pairs *pairs, const struct scene_query *query,
                       const struct fmb_prepared *frame, void *memory)
{
    pairs->query = query;
    pairs->frame = frame;
    pairs->listed = query->first_pair;
    pairs->a = 0;
    pairs->found_count = pairs->given = 0;
    if (query->which != QUERY_PAIRS_LISTED)
        begin_found(pairs, memory);
}

static size_t next_found(struct scene_pairs *pairs, unsigned (*room)[2], size_t max)
{
    size_t count = 0;
    while (count < max && pairs->a < askers(pairs->query)) {
        if (pairs->given < pairs->found_count) {
            room[count][0] = pairs->a;
            room[count++][1] = pairs->found[pairs->given++];
        } else if (++pairs->a < askers(pairs->query)) {
            find_partners(pairs, partners(pairs->query, pairs->a));
        }
    }
    return count;
}

size_t scene_pairs_next(struct scene_pairs *pairs, unsigned (*room)[2], size_t max,
                        const unsigned (**out)[2])
{
    if (pairs->query->which != QUERY_PAIRS_LISTED) {
        *out = (const unsigned(*)[2]) room;
        return next_found(pairs, room, max);
    }
    const size_t left = (size_t) (pairs->query->index_count / 2 - pairs->listed);
    const size_t count = left < max ? left : max;
    *out = pairs->query->pair + pairs->listed;
    pairs->listed += (int32_t) count;
    return count;
}
