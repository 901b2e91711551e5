/* Answers the queries of a log by a service on the bus; local_answerer.h does so in this process.
 * Uses the request engine of the client library, which keeps many queries under way, repeats lost
 * ones and pauses when the service is busy. This module restores the ids. For one thread at a time.
 */
#ifndef ANSWER_BUS_H
#define ANSWER_BUS_H

#include "fmb_client.h"
#include "local_answerer.h"
#include "match.h"
#include "tally.h"

/* Called when a query was answered. item: as passed to answer_bus_query(). Returns whether the
 * answer is final; false: the query will be passed again. */
typedef bool answer_bus_sink(void *user, struct match_item *item,
                             const struct new_result *answered);

struct answer_bus;

/* Returns NULL if the bus cannot be opened, which was reported on stderr. From then on SIGINT and
 * SIGTERM are blocked and end the replay. Exits with status 1 if memory is exhausted. */
struct answer_bus *answer_bus_open(const struct fmb_client_options *options, answer_bus_sink *sink,
                                   void *user);
void answer_bus_close(struct answer_bus *bus); /* may be NULL */

/* The next three functions may call the sink for earlier queries. */

/* Sends a query as soon as the client library has capacity for it. In: valid ids; at most
 * QUERY_BYTES_MAX bytes, which are copied. The item has to stay valid until the sink is called. */
void answer_bus_query(struct answer_bus *bus, struct match_item *item, const unsigned char *bytes,
                      uint32_t size);

/* Sends a scene query without pairs, so that the service caches bodies of the query `item`, and
 * waits until all queries under way are answered. */
void answer_bus_supply(struct answer_bus *bus, struct match_item *item, const unsigned char *bytes,
                       uint32_t size);

/* Waits until all queries are answered. */
void answer_bus_finish(struct answer_bus *bus);

/* Whether the replay may continue. After its end the sink is no longer called. NO_SERVICE: no
 * service answers. */
enum answer_bus_end {
    ANSWER_BUS_NO_END,
    ANSWER_BUS_SIGNAL,
    ANSWER_BUS_NO_SERVICE,
    ANSWER_BUS_FAILED
};
bool answer_bus_is_running(struct answer_bus *bus);

struct tally_bus answer_bus_counts(const struct answer_bus *bus);

#endif
