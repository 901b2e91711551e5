/* A client of an instance: sends bodies whole until it has been told a key, by key from then on,
 * and whole again where a key is dead. */
#ifndef ASKER_H
#define ASKER_H

#include "instance.h"

/* Its bodies have ids from 1 to this, and others than its own are none of its business. */
enum { ASKER_BODIES_MAX = 8192 };

struct asker {
    struct instance
        *instance; /* not owned; another one takes its place where the service restarts */
    int64_t client_id;
    int64_t next_number;               /* of its next query */
    int64_t key[ASKER_BODIES_MAX + 1]; /* [body_id]; 0: none known */
};

/* Ask what the query says, with the asker's ids; frames come whole, and are changed to go by key
 * where one is known. Asked once more where keys were dead. On output: the last query and its
 * result. */
void asker_pair(struct asker *asker, struct pair_query *query, struct pair_result *result);
void asker_scene(struct asker *asker, struct scene_query *query, struct scene_result *result);

/* Forgets that the body was ever told: its next frame goes whole. For bodies that change. */
void asker_forget(struct asker *asker, int64_t body_id);

#endif
