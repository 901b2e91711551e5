/* One query of a log that was answered again, beside the result that was recorded. */
#ifndef REPLAYED_H
#define REPLAYED_H

#include "query.h"

/* How the two results compare. */
enum replay_outcome {
    REPLAY_SAME,
    REPLAY_DIFFERENT,
    /* Nothing to compare, for reasons of the moment: */
    REPLAY_BUSY,    /* the service was busy then */
    REPLAY_UNKNOWN, /* a key that was not held then, or whose components are not in the log */
    REPLAY_ALONE    /* no result was recorded */
};

struct replayed {
    const char *log;      /* path of the log */
    int64_t event_number; /* of the query */
    int64_t offset;       /* of its header in the log, bytes */
    int64_t utime;        /* of the log, microseconds since 1970 */
    enum replay_outcome outcome;
    /* A pair or a scene: of the two groups one is NULL. Frames that came by key have their
     * components here, where the log has them: then count says so. then NULL: no result was
     * recorded. */
    const struct pair_query *pair;
    const struct pair_result *pair_now, *pair_then;
    const struct scene_query *scene;
    const struct scene_result *scene_now, *scene_then;
};

#endif
