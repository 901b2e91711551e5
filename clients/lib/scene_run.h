/* Queries a scene: divides it into parts of one datagram (division.h), keeps several under way
 * (request.h), and delivers the answers in the order of the pairs (order.h).
 *
 * A part may take several queries, one after the other: if a result has no space for all answers,
 * or the service does not hold a body. If the bodies that it does not hold do not fit a datagram
 * together with the remainder of the part, they are sent first, in queries without pairs. */
#ifndef SCENE_RUN_H
#define SCENE_RUN_H

#include "division.h"
#include "request.h"

/* A part under way. */
struct part_run {
    struct scene_run *run;
    struct part part;
    struct part_answers answers;
    bool done;       /* no more answers will come */
    bool defining;   /* the last query only has bodies */
    int definitions; /* number of such queries */
    int unknown;     /* number of results with status UNKNOWN_BODY */
    /* [placement of the part]: sent with frames in the last query, and in the one before it. */
    bool whole[QUERY_PLACEMENTS_MAX], whole_earlier[QUERY_PLACEMENTS_MAX];
};

/* The owner sets requests, held and within; all else is 0 at first. */
struct scene_run {
    struct requests *requests;
    struct held *held;
    const struct fmb_scene *scene;
    const struct division *division;
    int status;            /* not 0: the remaining pairs are given up with it */
    double within;         /* time limit for a scene, seconds; 0: none */
    int64_t until;         /* end of that time; clock_ns() */
    uint64_t oldest, next; /* parts: first not delivered, first not begun */
    bool has_next;         /* the next part is in its slot already */
    bool divide_again;     /* the only part has to be divided: nothing is delivered */
    struct part_run part[FMB_CLIENT_RAW_WINDOW]; /* [part % FMB_CLIENT_RAW_WINDOW] */
    /* Most pairs listed in a query, so that the queries under way are decided within half a
     * timeout; estimated from the compute times of results, for this method and want. */
    int32_t pairs_max;
    const struct fmb_method *method;
    unsigned want;
    struct scene_query query; /* being written */
    /* The encoded frames of its placements, and of one more; and the encoding of no frames. */
    unsigned char geometry[2 * QUERY_BYTES_MAX], none[GEOMETRY_NONE_BYTES];
};

/* Queries the pairs of a checked scene and passes the answers to sink, in their order. single: each
 * pair is a query of its own. Returns FMB_OK or FMB_CLIENT_NO_MEMORY. */
int scene_run(struct scene_run *run, const struct fmb_scene *scene, bool single,
              fmb_client_sink *sink, void *user);

#endif
