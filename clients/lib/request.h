/* Requests: queries under way, each of which is sent until its result comes.
 *
 * LCM loses datagrams without notice. A query without a result is therefore sent again, with the
 * same sequence number. A busy service is queried again after a pause. A second result of a query
 * is ignored.
 *
 * A service answers the queries of a client in order, with few exceptions. So, as in RACK (RFC
 * 8985), a query is presumed lost and is repeated when a query that was sent later has its result:
 * at once, or after a reordering window if such repeats have been spurious (both results came). No
 * query follows the one that was sent last. That one is repeated when no result has come for an
 * interval, which is some milliseconds more than the usual response time (struct request_pace). Its
 * result then shows which of the others were lost.
 *
 * Each query backs off by itself. Repeats that the observed loss explains keep the interval. After
 * them the service is presumed slow: the interval doubles with each repeat, up to the client's
 * timeout, and a query that is presumed lost is not repeated before its interval ends.
 *
 * The number and the bytes of queries under way are limited, so that the receive buffers of both
 * ends can hold them.
 *
 * This module handles kinds of messages. Their contents are processed by handlers. */
#ifndef REQUEST_H
#define REQUEST_H

#include "fmb_client_raw.h"
#include "query.h"

#include <stdbool.h>
#include <stdint.h>

/* A well-formed result; or the end of a request without one: status is negative (enum
 * fmb_client_status). */
struct request_result {
    enum fmb_client_kind kind;
    int status;
    const char *detail; /* "" if OK, or if there is no result */
    /* The decoded result. Only the member of its kind may be read. */
    const struct pair_result *pair;
    const struct scene_result *scene;
    const unsigned char *bytes; /* of the message; NULL: there is no result */
    size_t size;
    int64_t number; /* sequence number of the query */
};

/* What a handler returns about a result. */
enum request_taken {
    REQUEST_MALFORMED, /* it does not match the query, and is ignored */
    REQUEST_COMPLETE,
    REQUEST_NEXT /* the handler has written another query into the request, to be sent */
};

/* Bytes at the start of each query: fingerprint, utime, and the ids that this module writes. */
enum { REQUEST_IDS_END = 32 };

struct request;

/* Called with a result of the request; or without one, when the request has ended. */
typedef enum request_taken request_handler(void *user, struct request *request,
                                           const struct request_result *result);

struct request {
    bool under_way;
    enum fmb_client_kind kind;
    request_handler *handler;
    void *user;
    fmb_client_raw_sink *raw_sink; /* of a raw query */
    int64_t number;                /* sequence number */
    int64_t first_at;              /* time of first sending; times are those of clock_ns() */
    int64_t sent_at;               /* time of last sending */
    int64_t pending_at; /* time of the first sending that is not known to be lost or refused */
    int64_t deadline;   /* time to send it again, or to give it up */
    int64_t give_up_at; /* time to give it up at the latest */
    int64_t interval;   /* from sent_at to deadline */
    double loss_chance; /* probability that as many sendings in a row are lost as it had repeats */
    int refusals;       /* times that the service was busy */
    bool repeated;      /* sent more than once */
    bool pausing;       /* the deadline ends a pause after a refusal */
    bool presumed_lost; /* since it was last sent, a query that was sent later got its result */
    size_t charge;      /* bytes that it takes of a receive buffer */
    size_t size;
    unsigned char query[QUERY_BYTES_MAX];
};

/* Response time of one kind of query, estimated like the round-trip time of RFC 6298, and only from
 * queries that were not repeated (Karn's algorithm). If all queries are repeated before their
 * results, retry grows until one is not. Nanoseconds; times are those of clock_ns(). */
struct request_pace {
    int64_t mean, deviation; /* 0: none measured so far */
    int64_t retry;           /* first interval of the next query: from 8 ms to the timeout */
    /* Moving averages: share of results that came after a repeat, other than after a pause; share
     * of results that came twice, so that the repeat was spurious. */
    double loss_share, spurious_share;
    int unmeasured;             /* number of results in a row for which retry was too short */
    int64_t measured_at;        /* time of the last measurement */
    int64_t received_at;        /* time of the last result of a request under way */
    int64_t newest_answered_at; /* newest pending_at of the requests that have results */
    int64_t newest_sent_at;     /* newest sent_at of the requests under way */
    int64_t reordering_window;  /* from the result of a later query to the repeat of this one */
};

/* The functions by which requests reach the bus, from the owner of the requests. */
struct request_transport {
    void *user;
    /* Returns false if the query could not be sent. */
    bool (*publish)(void *user, enum fmb_client_kind kind, const unsigned char *query, size_t size);
    /* Waits until a datagram is pending or other_fd (-1: none) is readable, up to timeout_ms. */
    void (*wait)(void *user, int other_fd, int timeout_ms);
    /* Passes the results in pending datagrams to requests_take(). Returns false if the bus has
     * failed. */
    bool (*receive)(void *user);
};

/* The owner sets transport to tries, and calls requests_forget_pace(); all else is 0 at first. */
struct requests {
    struct request_transport transport;
    int64_t client_id;
    int64_t timeout_ns; /* of one try */
    int tries;
    struct fmb_client_counts counts;
    struct request request[FMB_CLIENT_RAW_WINDOW];
    int count;           /* under way */
    size_t charge;       /* of all of them */
    int64_t next_number; /* sequence number of the next query */
    int64_t received_at; /* time of the last result; clock_ns() */
    bool outage;         /* the service stopped answering */
    struct request_pace pace[FMB_CLIENT_KINDS];
};

/* Resets the estimates: at the start, and when the service has stopped answering. */
void requests_forget_pace(struct requests *requests);

/* Whether another request may begin. bytes: of its query or its result, the larger of the two. */
bool requests_ready(const struct requests *requests, size_t bytes);

/* Begins a request. The caller writes request->query and size, then calls request_send(). */
struct request *request_begin(struct requests *requests, enum fmb_client_kind kind, size_t bytes,
                              request_handler *handler, void *user);
void request_send(struct requests *requests, struct request *request);

/* Ends a request. The handler is not called. */
void request_end(struct requests *requests, struct request *request);

/* Waits until a datagram comes, a deadline is reached, other_fd (-1: none) is readable, or it is
 * `until` (clock_ns()). Then receives pending datagrams, and repeats or gives up what is due. */
void requests_step(struct requests *requests, int other_fd, int64_t until);

/* Ends all requests without a result, with this status. */
void requests_give_up(struct requests *requests, int status);

/* Processes a result for this client. */
void requests_take(struct requests *requests, const struct request_result *result);

#endif
