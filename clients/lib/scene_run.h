/* Queries a scene: divides it into parts of one datagram (division.h), keeps several under way
 * (request.h), and delivers the answers in the order of the pairs: of listed pairs at once, of
 * blocks when their row is complete. */
#ifndef SCENE_RUN_H
#define SCENE_RUN_H

#include "division.h"

/* The owner sets requests, held and within; all else is 0 at first. */
struct scene_run {
    struct requests *requests;
    struct held *held;
    double within; /* time limit for a scene, seconds; 0: none */
    const struct fmb_scene *scene;
    fmb_client_sink *sink;
    void *user;
    struct division division;
    struct part_answers *row; /* owned, [block_count]: the current row, by column */
    int status;               /* not 0: the remaining pairs are given up with it */
    int64_t until;            /* end of the time for the scene; clock_ns() */
    uint64_t oldest, next;    /* parts: first not delivered, first not begun */
    bool has_next;            /* the next part is in its slot already */
    bool divide_again;        /* the only part has to be divided: nothing is delivered */
    struct part part[FMB_CLIENT_RAW_WINDOW]; /* [part % FMB_CLIENT_RAW_WINDOW] */
    /* Most pairs listed in a query, so that the queries under way are decided within half a
     * timeout; estimated from the compute times of results, for this method and want. */
    int32_t pairs_max;
    const struct fmb_method *method;
    unsigned want;
    struct scene_query query; /* being written */
    /* The encoded frames of its placements, and of one more. */
    unsigned char geometry[2 * QUERY_BYTES_MAX];
};

/* Queries the pairs of a checked scene and passes the answers to sink, in their order. single: each
 * pair is a query of its own. Returns FMB_OK or FMB_CLIENT_NO_MEMORY. */
int scene_run(struct scene_run *run, const struct fmb_scene *scene, bool single,
              fmb_client_sink *sink, void *user);

#endif
