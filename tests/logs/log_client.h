/* A client of an instance: sends a body whole until a result carries its handle, by handle from
 * then on, and whole again where the handle is not held. */
#ifndef LOG_CLIENT_H
#define LOG_CLIENT_H

#include "instance.h"

/* Its bodies have ids from 1 to this. */
enum { LOG_CLIENT_BODIES_MAX = 8192 };

struct log_client {
    struct instance
        *instance; /* not owned; another one takes its place where the service restarts */
    int64_t client_id;
    int64_t next_number;                             /* of its next query */
    struct handle handle[LOG_CLIENT_BODIES_MAX + 1]; /* [body_id]; all 0: none known */
};

/* Send the query with the client's ids; its bodies are whole, and go by handle where one is
 * known. Once more where a handle was not held. On output: the result; of a pair also the last
 * query that was sent. */
void log_client_pair(struct log_client *log_client, struct pair_query *query,
                     struct pair_result *result);
void log_client_scene(struct log_client *log_client, const struct scene_query *query,
                      struct scene_result *result);

/* The body goes whole next time: it has changed. */
void log_client_forget(struct log_client *log_client, int64_t body_id);

/* Names a body by the handle that the client knows; else leaves it whole. */
void log_client_name(const struct log_client *log_client, struct query_placement *placement);

#endif
