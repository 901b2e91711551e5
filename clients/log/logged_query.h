/* A query of a log: of a pair or of a scene. Functions have no shared state. */
#ifndef LOGGED_QUERY_H
#define LOGGED_QUERY_H

#include "log_kind.h"
#include "query.h"

struct logged_query {
    enum log_kind kind; /* LOG_PAIR_QUERY or LOG_SCENE_QUERY */
    /* Those in the struct: [placement_count] of pair or of scene. */
    struct query_placement *placement;
    int32_t placement_count;
    union {
        struct query_header header;
        struct pair_query pair;
        struct scene_query scene;
    };
};

/* Decodes a query as wire_read_pair_query() or wire_read_scene_query(). Only the header of a query
 * longer than QUERY_BYTES_MAX is read, as a service refuses it unread; other fields are 0. Returns
 * NULL; or a static text: why it cannot be decoded. */
const char *logged_query_read(struct logged_query *out, enum log_kind kind,
                              const unsigned char *bytes, uint32_t size);

/* A result of a log. */
struct logged_result {
    enum log_kind kind; /* of its query */
    union {
        struct result_head head;
        struct pair_result pair;
        struct scene_result scene;
    };
};

/* Decodes a result. kind: of its query. Returns NULL; or a static text: why it cannot be decoded.
 */
const char *logged_result_read(struct logged_result *out, enum log_kind kind, const void *bytes,
                               uint32_t size);

/* Whether the status depends on the moment, not on the query: the service was busy, or did not hold
 * a body. */
bool logged_status_is_transient(int32_t status);

/* Encodes a decoded query. Returns its size, or 0 if it exceeds a datagram, or if the struct does
 * not hold all of the query. */
size_t logged_query_write(const struct logged_query *query, unsigned char out[QUERY_BYTES_MAX]);

struct owned_scene;

/* Converts a query to a scene (scene.h) with the same bodies, and the same pairs in the same order.
 * The scene has no method and no wanted results, and only a label that JSON can have; that of a
 * pair has no groups. In: a query that the service accepts, with a body for each placement. On
 * output: *out, which the caller clears, with the pairs from first_pair on: all pairs of a
 * PAIRS_ALL query as such, others listed. Body i is placement i, and keeps its id, unless it has
 * none or an earlier placement has the same id: then it gets the lowest free id. Exits with status
 * 1 if memory is exhausted. */
void scene_of_query(const struct logged_query *query, struct owned_scene *out);

/* Returns the body of a view, in memory of the scene; NULL: the engine refuses its frames. */
const struct fmb_body *body_of_view(const struct body_view *view, struct owned_scene *scene);

/* Whether there is such a body. */
bool scene_takes(const struct body_view *view);

#endif
