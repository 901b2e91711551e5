/* A query, of a pair or of a scene. */
#ifndef ANY_QUERY_H
#define ANY_QUERY_H

#include "log_kind.h"
#include "query.h"

struct any_query {
    enum log_kind kind; /* LOG_PAIR_QUERY or LOG_SCENE_QUERY */
    union {
        struct pair_query pair;
        struct scene_query scene;
    };
};

/* As wire_read_pair_query(). Of a query longer than QUERY_BYTES_MAX, which a service refuses
 * unread, only the header is read; other fields are 0. */
const char *any_query_read(struct any_query *out, enum log_kind kind, const unsigned char *bytes,
                           uint32_t size);

/* The placements that the struct holds; *count of them. */
struct placement *any_query_placements(struct any_query *query, int32_t *count);

/* The number of pairs of a scene query, ignored ones included. */
int64_t any_query_pairs(const struct scene_query *query);

/* With PAIRS_ALL and PAIRS_ACROSS: the number of the pair (a, b) of placements, in the order of
 * (a, b). On input: a pair of the query. */
int64_t any_query_pair_number(const struct scene_query *query, unsigned a, unsigned b);

/* Encodes a query that was read. Returns the size; 0: it exceeds a datagram, or the struct did not
 * hold all of it. */
size_t any_query_write(const struct any_query *query, unsigned char out[QUERY_BYTES_MAX]);

#endif
