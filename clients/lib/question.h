/* A caller's question: is it one, and its frames as messages have them. */
#ifndef QUESTION_H
#define QUESTION_H

#include "fmb_client.h"
#include "query.h"

/* On output: 0; or a status, and in why the place and the reason. */
int question_check(const struct fmb_client_scene *scene, char why[FMB_CLIENT_WHY_MAX]);

/* On input: a frame that was checked. On output: the same, whole. */
void question_frame(const struct fmb_client_frame *frame, struct query_frame *out);

/* Runs over the pairs in their order; start with all 0. */
struct question_cursor {
    size_t next; /* listed pairs: index of the next one */
    size_t a, b; /* else: the next one, if b is not 0; the first one if it is */
};

/* On output: true and out, or false after the last one. */
bool question_next_pair(const struct fmb_client_scene *scene, struct question_cursor *cursor,
                        unsigned out[2]);

#endif
