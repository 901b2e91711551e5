#include "match.h"

#include "allocate.h"
#include "recent.h"
#include "spill.h"

#include <stdlib.h>

/* Of both what the second cache of most machines holds, and far more than is ever under way. */
enum { RECENT_BYTES = 4 << 20 };

/* Clients that give all their queries the same ids make no long search. */
enum { CHOICES_MAX = 1000 };

struct match {
    struct match_sink sink;
    struct recent *queries, *results;
    struct spill *spill;
    int64_t open;
};

static void query_gone(void *user, const struct recent_item *query)
{
    struct match *match = user;
    if (!query->matched)
        spill_put(match->spill, SPILL_QUERIES, &query->item);
}

static void result_gone(void *user, const struct recent_item *result)
{
    struct match *match = user;
    if (!result->matched)
        spill_put(match->spill, SPILL_RESULTS, &result->item);
}

struct match *match_open(const struct match_sink *sink)
{
    struct match *match = allocate(1, sizeof *match);
    *match = (struct match){.sink = *sink,
                            .queries = recent_open(RECENT_BYTES, query_gone, match),
                            .results = recent_open(RECENT_BYTES, result_gone, match),
                            .spill = spill_open()};
    return match;
}

void match_close(struct match *match)
{
    if (!match)
        return;
    recent_close(match->queries);
    recent_close(match->results);
    spill_close(match->spill);
    free(match);
}

static void mark(struct match *match, struct recent_item *item)
{
    if (!item->matched && item->item.place.mine)
        match->open--;
    item->matched = true;
}

static void both(struct match *match, struct recent_item *query, const struct match_item *result)
{
    mark(match, query);
    match->sink.both(match->sink.user, &query->item, result);
}

void match_query(struct match *match, const struct match_item *item)
{
    struct recent_item *query = recent_put(match->queries, item);
    struct recent_item *result = recent_first(match->results, item->kind, &item->ids);
    match->open += item->place.mine;
    for (int i = 0; result && i < CHOICES_MAX; i++, result = recent_next(match->results, result)) {
        if (result->matched)
            continue;
        mark(match, result);
        both(match, query, &result->item);
    }
}

/* The oldest that has no result yet, else the newest. */
static struct recent_item *choose(const struct match *match, const struct match_item *result)
{
    struct recent_item *best = recent_first(match->queries, result->kind, &result->ids);
    for (int i = 0; best && best->matched && i < CHOICES_MAX; i++) {
        struct recent_item *next = recent_next(match->queries, best);
        if (!next)
            break;
        best = next;
    }
    return best;
}

void match_result(struct match *match, const struct match_item *result)
{
    struct recent_item *query = choose(match, result);
    if (query) {
        both(match, query, result);
        return;
    }
    match->open += result->place.mine;
    recent_put(match->results, result);
}

int64_t match_open_count(const struct match *match)
{
    return match->open;
}

bool match_finish(struct match *match)
{
    recent_flush(match->queries);
    recent_flush(match->results);
    return spill_join(match->spill, &match->sink);
}
