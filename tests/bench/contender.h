/* What is measured: ways to decide pairs of a scene, one table of them all. */
#ifndef CONTENDER_H
#define CONTENDER_H

#include "bench_scene.h"
#include "instructions.h"
#include "stopwatch.h"

/* Pairs to decide, T = 1, and memory for the answers of the batch. */
struct work {
    const struct scene *scene;
    const unsigned (*pair)[2];
    size_t count;
    const unsigned (*warm)[2]; /* [warm_count], other ones, decided untimed before */
    size_t warm_count;
    enum instructions instructions;  /* of the batch */
    unsigned char *verdicts;         /* [count] */
    double (*contacts)[2];           /* [count] */
    double (*boxes)[2][FMB_DIM_MAX]; /* [count] */
    struct peers *peers;             /* of the scene's bodies; NULL: they are not raced */
    double *gaps;                    /* [count], theirs */
};

/* With memory for the answers, which work_free() frees. */
struct work work_of(const struct scene *scene, const struct pairs *pairs);
void work_free(struct work *work);

enum { ANYWHERE, ONLY_MOVING, ONLY_BOXES_AT_REST };

/* What each of them is, contender_help() says. */
#define CONTENDER_MAP(X)                                             \
    X(BATCH, "batch", batch, ANYWHERE)                               \
    X(BATCH_INTERVAL, "batch+interval", batch_interval, ONLY_MOVING) \
    X(BATCH_BOX, "batch+box", batch_box, ANYWHERE)                   \
    X(SINGLE, "single", single, ANYWHERE)                            \
    X(SINGLE_COMPUTED, "single computed", single_computed, ANYWHERE) \
    X(QUERY, "query", query, ANYWHERE)                               \
    X(QUERY_BOX, "query+box", query_box, ANYWHERE)                   \
    X(FMB, "fmb", fmb, ANYWHERE)                                     \
    X(SAT, "sat", sat, ANYWHERE)                                     \
    X(SAT_PLACED, "sat placed", sat_placed, ANYWHERE)                \
    X(OBB, "obb", obb, ONLY_BOXES_AT_REST)                           \
    X(OBB_PLACED, "obb placed", obb_placed, ONLY_BOXES_AT_REST)      \
    X(PLACING, "placing", placing, ANYWHERE)                         \
    X(EXACT, "exact", exact, ANYWHERE)

enum contender {
#define X(id, name, run, where) CONTENDER_##id,
    CONTENDER_MAP(X)
#undef X
        CONTENDERS,
    CONTENDERS_AND_PEERS = CONTENDERS + PEERS_MAX /* CONTENDERS + k is peer k */
};

const char *contender_name(enum contender contender);

/* Whether it is there for such a cell. A peer: whether it gives verdicts of it. */
bool contender_runs(enum contender contender, const struct cell *cell);

/* Queries all pairs. Writes verdicts (all but PLACING): an enum fmb_verdict, or 0 where there is no
 * answer. */
void contender_run(enum contender contender, const struct work *work);

/* Runs it. Returns the share of pairs for which it contradicts the certified verdicts. Touching is
 * contact, no answer is wrong, and a pair without a certified verdict is never wrong. */
double contender_wrong(enum contender contender, const struct work *work,
                       const unsigned char *certified);

/* Lines on what the names mean. */
void contender_help(void);

struct race {
    int blocks;
    double budget; /* nanoseconds a block for each: slow ones decide the first pairs only */
};

/* Nanoseconds a pair of each, taken in turn within each block. What ran before has other code and
 * other data in the caches: each is warmed up with pairs of the same bodies, which are not those
 * that are timed, so that no branch is predicted from memory. */
void race_run(const struct race *race, const struct work *work, const enum contender *contenders,
              int count, struct spread *out);

#endif
