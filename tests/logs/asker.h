/* A client of an instance: sends a body whole until a result carries its handle, by handle from
 * then on, and whole again where the handle is not held. */
#ifndef ASKER_H
#define ASKER_H

#include "instance.h"

/* Its bodies have ids from 1 to this. */
enum { ASKER_BODIES_MAX = 8192 };

struct asker {
    struct instance
        *instance; /* not owned; another one takes its place where the service restarts */
    int64_t client_id;
    int64_t next_number;                        /* of its next query */
    struct handle handle[ASKER_BODIES_MAX + 1]; /* [body_id]; all 0: none known */
};

/* Send the query with the asker's ids; its bodies are whole, and go by handle where one is known.
 * Once more where a handle was not held. On output: the result; of a pair also the last query that
 * was sent. */
void asker_pair(struct asker *asker, struct pair_query *query, struct pair_result *result);
void asker_scene(struct asker *asker, const struct scene_query *query, struct scene_result *result);

/* The body goes whole next time: it has changed. */
void asker_forget(struct asker *asker, int64_t body_id);

/* Names a body by the handle that the asker knows; else leaves it whole. */
void asker_name(const struct asker *asker, struct placement *placement);

#endif
