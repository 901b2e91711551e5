/* A query of a log with its recorded result (then) and the new one (now), and an iteration over its
 * pairs. No shared state. */
#ifndef REPLAYED_H
#define REPLAYED_H

#include "logged_query.h"

/* How the two results compare. */
enum replay_outcome {
    REPLAY_SAME,
    REPLAY_DIFFERENT,
    /* Nothing to compare: */
    REPLAY_BUSY,       /* the service was busy */
    REPLAY_UNKNOWN,    /* the service did not hold a body then */
    REPLAY_UNDEFINED,  /* a handle that the log does not define */
    REPLAY_NOT_HELD,   /* not answered: the cache has no memory for the bodies */
    REPLAY_UNRECORDED, /* no result was recorded */
    REPLAY_OUTCOMES
};

struct replayed {
    const char *log;      /* path of the log */
    int64_t event_number; /* of the query */
    int64_t offset;       /* of its header in the log, bytes */
    int64_t utime;        /* of the log, microseconds since 1970 */
    enum replay_outcome outcome;
    /* Placements by handle have their geometry, and a frame_count, if the log defines them. then is
     * NULL if no result was recorded. */
    const struct logged_query *query;
    const struct logged_result *now, *then;
    const struct logged_query *then_query; /* of then; NULL: query, or it is not known */
    /* How the scene of then_query differs from the scene of query; if it does, their pairs do not
     * correspond. NULL: it does not differ, or then_query is not known. */
    const char *change;
    /* then is paired with the query by its order alone, and its own query is not known. */
    bool by_order;
    const char *note; /* how the scenes differ; NULL: they do not */
};

/* ---- Pairs ---- */

/* What one result states about a pair. */
struct replayed_side {
    bool answered;            /* false: nothing, and the other members are 0 */
    int dim;                  /* of box and gap; 0: there is neither */
    struct fmb_answer answer; /* verdict 0: the method could not decide */
};

struct replayed_pair {
    unsigned a, b; /* indices of placements */
    struct replayed_side then, now;
};

/* Position of an iteration in one of the results. */
struct replayed_place {
    const struct scene_result *result; /* NULL: none, or it answers nothing */
    int32_t verdict, contact; /* indices of the next verdict, and of the next times and box */
};

struct replayed_pairs {
    const struct replayed *replayed; /* not owned */
    bool pair_given;
    struct replayed_place then, now;
};

/* Begins an iteration: over the pair of a pair query; over listed pairs that a result answers; over
 * pairs of all or across that a result names, since all others are separated. A result that does
 * not belong to this query, or belongs to another scene, answers no pair. */
void replayed_pairs_begin(const struct replayed *replayed, struct replayed_pairs *out);

/* Returns true and the next pair, or false after the last one. Pairs come in the order of the
 * query. */
bool replayed_pairs_next(struct replayed_pairs *pairs, struct replayed_pair *out);

/* Counts the pairs that the result answers with each verdict, including those it does not name;
 * none if the result is NULL, or none to this query. */
void replayed_count(const struct scene_query *query, const struct scene_result *result,
                    int64_t count[FMB_OVERLAPPING + 1]);

/* The number of pairs that the result decides. */
int64_t replayed_decided(const struct scene_query *query, const struct scene_result *result);

#endif
