/* Asks the service on the bus: many pairs under way at once, none lost, answers in the order
 * asked.
 *
 * LCM loses what a full buffer has no room for, and says nothing. So a query that gets no answer
 * within the time-out is sent again under the same sequence number, a service that is busy is
 * asked again after a pause, and a second answer to the same query is ignored. Memory: one window
 * of queries, however many are asked.
 *
 * Nothing but lcm_publish() and lcm_handle_timeout() is called while asking, so a service in the
 * same process and thread on memq:// can answer. */
#ifndef ASK_H
#define ASK_H

#include "query.h"

#include <lcm/lcm.h>
#include <stdbool.h>

struct ask_options {
    const char *prefix; /* of the channels; checked with bus_prefix_ok() */
    int32_t method;     /* number of a method; 0: the service's default */
    int32_t want;       /* QUERY_WANT_ bits */
    double timeout;     /* seconds for each try, > 0 */
    int retries;        /* after the first try, >= 0 */
};

struct ask;

/* On input: an open bus, to outlive the ask; prefix is copied. On output: an ask with a random
 * client id, to be closed by the caller; NULL where the bus cannot be listened to. */
struct ask *ask_open(lcm_t *lcm, const struct ask_options *options);
void ask_close(struct ask *ask);

/* The next question: fills the frames and the duration of *out, which is all 0. False: no more. */
typedef bool ask_source(void *user, struct pair_query *out);

/* The answer to the next question, in the order of the source. NULL: there was none. A status
 * other than FMB_OK is an answer too. */
typedef void ask_sink(void *user, const struct pair_result *result);

/* Asks all that source gives; returns when sink has had an answer or NULL for each. May be called
 * again for more. */
void ask_all(struct ask *ask, ask_source *source, ask_sink *sink, void *user);

/* True once a query was left without answer in all its tries while nothing else was answered
 * either, until any answer comes. Meanwhile sink gets NULL at once, and so a crowd of questions
 * that nobody answers takes no longer than one; but about once a second a query is sent once all
 * the same, and waited for, to find out whether the service is back. */
bool ask_is_silent(const struct ask *ask);

/* What a user needs to know to find out why. */
struct ask_counts {
    uint64_t asked, answered;
    uint64_t repeated;  /* queries sent again */
    uint64_t malformed; /* results that could not be read */
    uint64_t unsent;    /* queries that the bus did not take */
    uint64_t outages;   /* how often it fell silent */
};

struct ask_counts ask_counts(const struct ask *ask);

#endif
