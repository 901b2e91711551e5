/* A log, and a live service that its queries are asked of, without a bus; and answer_now(), which
 * says what the answers should be. */
#ifndef WORLD_H
#define WORLD_H

#include "answer.h"
#include "live.h"

enum { WORLD_CLIENT = 77, WORLD_THEN_FIRST_KEY = 5000, WORLD_LIVE_FIRST_KEY = 900000 };

/* One that was recorded, or the one that is asked. */
struct world_service {
    struct answerer answerer;
    bool cuts;    /* ends scenes after the first block of pairs */
    int busy;     /* so many queries more */
    bool forgets; /* all bodies, before each query */
    bool silent;  /* tells no keys */
    size_t bodies;
};

struct world {
    struct world_service then, live_service;
    struct known_bodies *known_live, *known_now;
    struct learner *learner_live, *learner_now;
    struct live *live;
    struct answer_now *now;
    struct match_item query, result; /* that were recorded last */
    unsigned char query_bytes[LOG_DATA_MAX], result_bytes[LOG_DATA_MAX];
    struct live_query asked;
    int asks;  /* that the last query took */
    int parts; /* of them, results that decided something */
    int64_t number;
};

extern struct world world;

/* Of the result that a service made last. */
union world_result {
    struct pair_result pair;
    struct scene_result scene;
};
extern union world_result world_result;

/* For cmocka. */
int world_open(void **state);
int world_close(void **state);

/* Another service in the place of the live one, with room for so many bodies. */
void world_use_service(size_t bodies);

/* All its bodies are gone, and their keys are dead. */
void world_forget(struct world_service *service);

/* From a query to the result, in bytes. Returns the size. */
size_t world_serve(struct world_service *service, enum log_kind kind, const unsigned char *bytes,
                   size_t size, unsigned char *out);
int32_t world_status(enum log_kind kind); /* of the result that was made last */

/* The query goes into the log, with what the service said then. The bytes are in query_bytes. */
void world_record_bytes(enum log_kind kind, const struct query_header *ids, size_t size);
void world_record_pair(struct pair_query *pair);
void world_record_scene(struct scene_query *scene);

/* What the last of them tells of keys. */
void world_learn(void);

/* Asks it: the beginning; once, with what the service says to that; or until there is an answer. */
enum answer_now_outcome world_begin(void);
enum live_taken world_ask_once(bool patient);
void world_ask(void);

/* Asks it, and fails the test where the answer is not what answer_now() gives; or, the other one,
 * what was recorded, where that was an answer. */
void world_assert_as_now(void);
void world_assert_as_then(void);

/* ---- Queries ---- */

/* 2D frames at rest, of different bodies: 48 bytes by key and 80 whole each. All pairs of them.
 * They are 1.5 wide or more, and so far from each other. */
void world_throng_at(struct scene_query *scene, int frames, double distance);
void world_throng(struct scene_query *scene, int frames); /* at 1.5: they touch or overlap */

/* The same by key: a client told the service its bodies in parts, all is in the log. */
void world_tell_throng_at(struct scene_query *scene, int frames, double distance);
void world_tell_throng(struct scene_query *scene, int frames);

/* Two squares; and by key, likewise. */
struct pair_query world_pair(void);
struct pair_query world_keyed_pair(void);

#endif
