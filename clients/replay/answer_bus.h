/* Answers the queries of a log by a live service, where answer_now.h does so in this process: many
 * are under way at once, none is lost, and the answers come in the order of the log.
 *
 * LCM loses what a full buffer has no room for, and says nothing. So what is under way is limited,
 * in number and in bytes, to what a usual receive buffer holds; a query is sent again, under the
 * same number, when nothing has been heard for a time-out, or when one that was sent later is
 * answered already; a service that is busy is asked again after a pause, a minute in all, and then
 * that is the answer. A service that dies is waited for, and asked again. It is asked under a
 * client id of its own, so that nobody else's results are taken for those, or the other way round.
 */
#ifndef ANSWER_BUS_H
#define ANSWER_BUS_H

#include "answer_now.h"
#include "match.h"
#include "tally.h"

struct answer_bus_options {
    const char *url;    /* NULL: LCM_DEFAULT_URL, or this host */
    const char *prefix; /* of the channels, "" for none */
    double speed;       /* queries go out at their times in the log, so much faster; 0: at once */
    double timeout;     /* seconds in which nothing is heard */
    int retries; /* so many time-outs more, one after the other, and the service is given up */
};

/* What comes back, in the order in which it was given. */
struct answer_bus_sink {
    /* A query that was answered, and how. Both are good until the call returns. */
    void (*answered)(void *user, struct match_item *query, const struct answered_now *answered);
    /* What was only to be passed on. */
    void (*passed)(void *user, const struct match_item *item, bool is_result);
    void *user;
};

struct answer_bus;

/* known: the keys of the log, not owned. NULL: there is no bus, which has been said on stderr. From
 * here on SIGINT and SIGTERM are blocked: they are seen here. Ends the program where there is no
 * memory. */
struct answer_bus *answer_bus_open(const struct answer_bus_options *options,
                                   struct known_bodies *known, const struct answer_bus_sink *sink);
void answer_bus_close(struct answer_bus *bus); /* may be NULL */

/* All of these may call the sink, for what was given before. */

/* Asks a query, whose bytes are copied, once its time has come and there is room for it. DONE: its
 * answer will come. WITHOUT_BODY: of some keys the components are not known, and it was not asked;
 * if it is the last time, it is. UNREADABLE: *error. */
enum answer_now_outcome answer_bus_query(struct answer_bus *bus, const struct match_item *query,
                                         bool last, const char **error);

/* Passes on what stands behind queries in the log, once these are answered. NEWS: a result that may
 * tell keys; what comes after it and has keys waits for that. */
enum answer_bus_what { ANSWER_BUS_QUERY, ANSWER_BUS_RESULT, ANSWER_BUS_NEWS };
void answer_bus_pass(struct answer_bus *bus, const struct match_item *item,
                     enum answer_bus_what what);

/* Waits until all has been passed on. */
void answer_bus_finish(struct answer_bus *bus);

/* Whether it goes on. Once it does not, the sink is called no more, and what has no answer will
 * have none. NOBODY: nobody answers. */
enum answer_bus_end { ANSWER_BUS_NO_END, ANSWER_BUS_SIGNAL, ANSWER_BUS_NOBODY, ANSWER_BUS_FAILED };
bool answer_bus_goes_on(struct answer_bus *bus);

struct tally_bus answer_bus_counts(const struct answer_bus *bus);

#endif
