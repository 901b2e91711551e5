/* A query, of a pair or of a scene. */
#ifndef ANY_QUERY_H
#define ANY_QUERY_H

#include "log_kind.h"
#include "query.h"

struct any_query {
    enum log_kind kind; /* PAIR_QUERY or SCENE_QUERY */
    union {
        struct pair_query pair;
        struct scene_query scene;
    };
};

/* As wire_read_pair_query(). */
const char *any_query_read(struct any_query *out, enum log_kind kind, const unsigned char *bytes,
                           size_t size);

/* Those that were kept; *count of them. */
struct query_frame *any_query_frames(struct any_query *query, int32_t *count);

/* Whether all of it was kept that was read. */
bool any_query_is_whole(const struct any_query *query);

/* On input: one that is whole. Returns the size; 0: it is more than one datagram holds. */
size_t any_query_write(const struct any_query *query, unsigned char out[QUERY_BYTES_MAX]);

#endif
