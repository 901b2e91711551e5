/* A caller's scene: checks it, iterates over its pairs, and converts its placements. */
#ifndef QUESTION_H
#define QUESTION_H

#include "fmb_client.h"
#include "query.h"

/* Checks a scene. Returns FMB_OK; or a status, and why has the place and the reason. */
int question_check(const struct fmb_client_scene *scene, char why[FMB_CLIENT_WHY_MAX]);

/* On input: a checked placement. On output: *out with frames, which are encoded in geometry. */
void question_placement(const struct fmb_client_placement *of,
                        unsigned char geometry[GEOMETRY_FRAME_BYTES_MAX], struct placement *out);

/* Bytes that a placement with frames takes in a query. */
size_t question_placement_bytes(const struct fmb_client_placement *placement);

/* Iterates over the pairs in order; all 0 at first. */
struct question_cursor {
    size_t next; /* listed pairs: index of the next one */
    size_t a, b; /* else: the next pair; b is 0 before the first */
};

/* Returns true and the next pair, or false after the last one. */
bool question_next_pair(const struct fmb_client_scene *scene, struct question_cursor *cursor,
                        unsigned out[2]);

#endif
