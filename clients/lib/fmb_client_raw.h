/* Sends encoded queries through the request engine of libfmb-client. For fmb replay and fmb record;
 * not installed.
 *
 * The caller passes the bytes of a query of any kind. The engine writes the client's id and a new
 * sequence number into them, sends, repeats and pauses as for the library's own queries, and passes
 * the encoded result to a callback. Up to FMB_CLIENT_RAW_WINDOW queries are under way at a time, in
 * no more bytes than a default receive buffer holds.
 *
 * While raw queries are under way, only those functions of fmb_client.h may be called that take the
 * client as const. */
#ifndef FMB_CLIENT_RAW_H
#define FMB_CLIENT_RAW_H

#include "bus.h"
#include "fmb_client.h"

enum { FMB_CLIENT_RAW_WINDOW = 64 };

enum fmb_client_kind { FMB_CLIENT_PAIR, FMB_CLIENT_SCENE, FMB_CLIENT_DEFINITION, FMB_CLIENT_KINDS };

struct fmb_client_raw_result {
    /* From 0 on: that of the result (enum fmb_status); BUSY after a minute of pauses, UNKNOWN_BODY
     * at once. Negative (enum fmb_client_status): there is no result, and bytes is NULL. */
    int status;
    const unsigned char *bytes; /* the message, well-formed; valid during the callback */
    size_t size;
    const unsigned char *query; /* as it was sent; valid during the callback */
    size_t query_size;
};

/* Called once for each query, from fmb_client_raw_step(), in the order in which they end. */
typedef void fmb_client_raw_sink(void *user, const struct fmb_client_raw_result *result);

/* Whether a query may be sent now: always if none is under way. bytes: of the query or of its
 * result, the larger of the two. */
bool fmb_client_raw_ready(const struct fmb_client *client, size_t bytes);

/* Sends a query. On input: a message of at most 63,900 bytes, which begins with fingerprint, utime,
 * client_id and sequence_number, and is copied; fmb_client_raw_ready(client, bytes) is true.
 * Returns FMB_OK; or OVER_LIMIT, WRONG_COUNT (not such a message), NO_BUS or INSIDE, and sink will
 * not be called. */
int fmb_client_raw_send(struct fmb_client *client, enum fmb_client_kind kind,
                        const unsigned char *message, size_t size, size_t bytes,
                        fmb_client_raw_sink *sink, void *user);

/* Waits until a datagram comes, a query has to be repeated, other_fd (-1: none) is readable, or
 * timeout seconds have passed; then handles what is due. Returns the number of queries under way;
 * NO_BUS (errno) or INSIDE. */
int fmb_client_raw_step(struct fmb_client *client, int other_fd, double timeout);

/* Passes all messages on the service's channels (every: on all channels) to tap from now on, before
 * the engine reads them, this client's queries and their results included. So one socket serves
 * both. tap is called from fmb_client_raw_send() and fmb_client_raw_step(), and may call neither.
 * To be called once, before the first query. Returns false if the bus cannot be received:
 * fmb_client_why(). */
bool fmb_client_raw_listen(struct fmb_client *client, bool every, bus_handler *tap, void *user);

/* The id that the engine writes into queries. */
int64_t fmb_client_raw_id(const struct fmb_client *client);

struct bus_counts fmb_client_raw_bus_counts(const struct fmb_client *client);

#endif
