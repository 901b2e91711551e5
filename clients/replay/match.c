#include "match.h"

#include "allocate.h"
#include "recent.h"
#include "spill.h"

#include <stdlib.h>

/* Of both far more than is ever under way. */
enum { RECENT_BYTES = 4 << 20 };

struct match {
    struct match_sink sink;
    struct recent *queries, *results;
    struct spill *spill;
    int64_t open;
};

static void query_gone(void *user, const struct recent_item *query)
{
    struct match *match = user;
    if (query->matched)
        match->open -= query->item.place.mine;
    else
        spill_put(match->spill, SPILL_QUERIES, &query->item);
}

/* One that nobody has waited for is that of a query with a result, come again, or of one that is no
 * longer here. */
static void result_gone(void *user, const struct recent_item *result)
{
    struct match *match = user;
    const struct match_item *item = &result->item;
    if (result->matched)
        return;
    const struct recent_item *query = recent_matched(match->queries, item->kind, &item->ids);
    if (!query) {
        spill_put(match->spill, SPILL_RESULTS, item);
        return;
    }
    match->open -= item->place.mine;
    match->sink.both(match->sink.user, &query->item, item);
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

void match_query(struct match *match, const struct match_item *item)
{
    struct recent_item *query = recent_put(match->queries, item);
    struct recent_item *result = recent_unmatched(match->results, item->kind, &item->ids);
    match->open += item->place.mine;
    if (!result)
        return;
    match->open -= result->item.place.mine;
    recent_match(match->results, result);
    recent_match(match->queries, query);
    match->sink.both(match->sink.user, &query->item, &result->item);
}

void match_result(struct match *match, const struct match_item *result)
{
    struct recent_item *query = recent_unmatched(match->queries, result->kind, &result->ids);
    if (query)
        recent_match(match->queries, query);
    else
        query = recent_matched(match->queries, result->kind, &result->ids);
    if (query) {
        match->sink.both(match->sink.user, &query->item, result);
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
    recent_flush(match->results); /* first: of queries that have one already they are told here */
    recent_flush(match->queries);
    return spill_join(match->spill, &match->sink);
}
