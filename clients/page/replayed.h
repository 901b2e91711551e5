/* A query of a log with its recorded and its new result. */
#ifndef REPLAYED_H
#define REPLAYED_H

#include "query.h"

/* How the two results compare. */
enum replay_outcome {
    REPLAY_SAME,
    REPLAY_DIFFERENT,
    /* Nothing to compare: */
    REPLAY_BUSY,       /* the service was busy */
    REPLAY_UNKNOWN,    /* the service did not hold a body then */
    REPLAY_UNDEFINED,  /* a handle that the log does not define */
    REPLAY_UNRECORDED, /* no result was recorded */
    REPLAY_OUTCOMES
};

struct replayed {
    const char *log;      /* path of the log */
    int64_t event_number; /* of the query */
    int64_t offset;       /* of its header in the log, bytes */
    int64_t utime;        /* of the log, microseconds since 1970 */
    enum replay_outcome outcome;
    /* Either a pair or a scene; the other group is NULL. Placements by handle have their geometry,
     * and a frame_count, if the log defines them. *_then is NULL if no result was recorded. */
    const struct pair_query *pair;
    const struct pair_result *pair_now, *pair_then;
    const struct scene_query *scene;
    const struct scene_result *scene_now, *scene_then;
};

#endif
