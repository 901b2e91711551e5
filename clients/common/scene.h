/* A scene as a user writes it: bodies, and the pairs to be decided. Independent of JSON and of the
 * bus. */
#ifndef SCENE_H
#define SCENE_H

#include "geometry.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SCENE_NAME_MAX = QUERY_NAME_MAX }; /* bytes */

struct scene_body {
    int64_t id;                    /* 1 to 2^53-1, unique in the scene */
    char name[SCENE_NAME_MAX + 1]; /* UTF-8 without control characters; "": none */
    int64_t group;                 /* 0: none */
    struct geometry_frame *given;  /* owned, [body.frame_count]: the frames as they were given */
    struct fmb_body body;          /* of one frame, or of those in frames */
    struct fmb_frame *frames;      /* owned; NULL: one, inside body */
    double position[FMB_DIM_MAX];
    double velocity[FMB_DIM_MAX]; /* per second */
    double orientation[4];
    int orientation_count; /* 0, 4 (2D: 2) */
};

/* Makes body and frames of the frames in given, [count] of dimension dim. On output: FMB_OK; or the
 * status of the engine, and *bad is the first frame that it refuses. */
enum fmb_status scene_body_make(int dim, size_t count, struct scene_body *body, size_t *bad);

/* Returns a copy without the frames as given; the caller frees it with scene_body_clear(). */
struct scene_body scene_body_copy(const struct scene_body *body);
void scene_body_clear(struct scene_body *body);

/* Returns the placement of a body for the engine. It points into the body. */
struct fmb_placement scene_placement(const struct scene_body *body);

/* Returns the name of a body; if it has none, its id, written into text. */
enum { SCENE_LABEL_MAX = 24 };
const char *scene_label(const struct scene_body *body, char text[SCENE_LABEL_MAX]);

/* Indices of two different bodies. */
struct scene_pair {
    size_t a, b;
};

struct scene {
    char label[SCENE_NAME_MAX + 1]; /* as the name of a body */
    int dim;                        /* 2 or 3, of all bodies */
    double duration;                /* seconds, >= 0 */
    /* >= 0. If not 0, contacts have gaps, and so have separated pairs that are no farther apart. */
    double margin;
    size_t body_count;
    struct scene_body *body; /* owned */
    bool all_pairs;          /* (i, j), i < j, in body order, except those left out; not stored */
    size_t pair_count;       /* of those listed; 0 with all_pairs */
    struct scene_pair *pair; /* owned; NULL with all_pairs */
    /* With all_pairs: pairs that are left out besides those within a group, a < b, in the order of
     * (a, b), each once. */
    size_t ignored_count;
    struct scene_pair *ignored; /* owned */
};

/* Frees what the scene owns, and sets it to {0}, an empty scene. */
void scene_clear(struct scene *scene);

/* Whether two bodies are of one group. */
bool scene_is_within_group(const struct scene *scene, struct scene_pair pair);

/* Brings the ignored pairs into the form above. On input each has two different indices. */
void scene_sort_ignored(struct scene *scene);

/* Whether the pair is among the ignored ones, in either order, or within a group. */
bool scene_ignores(const struct scene *scene, struct scene_pair pair);

uint64_t scene_count_pairs(const struct scene *scene);

/* Iterates over the pairs in the order of the scene; {0} at first. */
struct scene_cursor {
    size_t next; /* index of the next listed pair, or of the next ignored one */
    size_t a, b; /* all pairs: of pair_find() */
};

/* Returns true and the next pair, or false after the last one. */
bool scene_next_pair(const struct scene *scene, struct scene_cursor *cursor,
                     struct scene_pair *out);

#endif
