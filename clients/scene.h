/* A scene as people write it: bodies, and which pairs of them to decide. Knows neither JSON nor
 * the bus. */
#ifndef SCENE_H
#define SCENE_H

#include "fmb/fmb.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct scene_body {
    int64_t id; /* 1 to 2^53-1, unique in the scene */
    struct fmb_body body;
    double origin[FMB_DIM_MAX];
    double velocity[FMB_DIM_MAX]; /* per second; 0 where not moving */
    bool moving;                  /* carries a velocity, zero included */
};

/* Indices of two different bodies, in the orientation asked. */
struct scene_pair {
    size_t a, b;
};

struct scene {
    int dim;         /* 2 or 3, of all bodies */
    double duration; /* seconds, >= 0 */
    size_t body_count;
    struct scene_body *body; /* owned */
    bool all_pairs;          /* i before j, in body order: never stored, there may be many */
    size_t pair_count;       /* of those listed; 0 with all_pairs */
    struct scene_pair *pair; /* owned; NULL with all_pairs */
};

/* Frees what the scene owns and leaves it empty. All 0 is an empty scene. */
void scene_clear(struct scene *scene);

uint64_t scene_count_pairs(const struct scene *scene);

/* Runs over the pairs in the order asked; start with all 0. */
struct scene_cursor {
    size_t next; /* listed pairs: index of the next one */
    size_t a, b; /* all pairs: the last one given */
};

/* On output: true and *out, or false after the last one. */
bool scene_next_pair(const struct scene *scene, struct scene_cursor *cursor,
                     struct scene_pair *out);

/* The pair as the engine takes it. It points into the scene. */
struct fmb_pair scene_fmb_pair(const struct scene *scene, struct scene_pair pair);

/* From ids to indices in O(log n), after O(n log n). */
struct scene_ids {
    size_t count;
    struct scene_id *sorted; /* owned */
};

void scene_ids_make(const struct scene *scene, struct scene_ids *out);
void scene_ids_clear(struct scene_ids *ids);

/* On output: true and *index, or false: no body has this id. */
bool scene_ids_find(const struct scene_ids *ids, int64_t id, size_t *index);

/* On output: true and the indices of two bodies with the same id, *first before *second, of
 * which *second is the smallest there is; or false: the ids are unique. */
bool scene_ids_repeated(const struct scene_ids *ids, size_t *first, size_t *second);

#endif
