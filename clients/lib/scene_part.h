/* A part of a scene: its queries, one after the other, and its answers. It is a pair of placements,
 * or what fits a datagram (division.h).
 *
 * A part takes several queries if a result has no space for all answers, or if the service does not
 * hold a body. If the bodies that it does not hold do not fit a datagram together with the
 * remainder of the part, they are sent first, in queries without pairs. */
#ifndef SCENE_PART_H
#define SCENE_PART_H

#include "fmb_client.h"
#include "pair_number.h"
#include "request.h"

struct scene_run;

/* The answer to a pair that is not separated, or has a gap. */
struct part_answer {
    int32_t number;           /* of the pair in the part, from 0 */
    struct fmb_answer answer; /* verdict 0: the method cannot decide the pair */
};

/* All 0: none yet. */
struct part_answers {
    int32_t answered; /* number of pairs, from the first on; those not in `answer` are separated */
    int status;       /* of the other pairs, once the part is complete */
    char text[QUERY_TEXT_MAX];
    struct part_answer *answer; /* owned, [count], in order */
    size_t count, delivered;    /* delivered: index of the first not delivered yet */
    char *certificate;          /* owned; NULL: none */
};

struct part {
    bool single;   /* a pair query */
    int32_t which; /* enum fmb_pairs */
    int32_t split; /* with ACROSS */
    int32_t total; /* of pairs */
    int32_t placement_count;
    unsigned placement[QUERY_PLACEMENTS_MAX]; /* [in the part]: index in the scene */
    uint16_t pair[QUERY_PAIRS_MAX][2];        /* LISTED: [total][a, b], indices in the part */
    size_t bytes;                             /* of the query, without ignored pairs */
    size_t row, column;                       /* for division.h and scene_run.c */
    struct scene_run *run;
    struct part_answers answers;
    bool done;                        /* no more answers will come */
    bool defining;                    /* the last query only has bodies */
    int definitions;                  /* number of such queries */
    int unknown;                      /* number of results with status UNKNOWN_BODY */
    bool whole[QUERY_PLACEMENTS_MAX]; /* [in the part]: sent with frames in the last query */
};

/* The numbers of the pairs of a part that is ALL or ACROSS. */
static inline struct pair_numbers part_numbers(const struct part *part)
{
    return (struct pair_numbers){part->which == FMB_PAIRS_ACROSS, (size_t) part->placement_count,
                                 (size_t) part->split};
}

/* Whether a separated pair with this gap is near. */
static inline bool part_is_near(const struct fmb_scene *scene, const struct fmb_gap *gap)
{
    return scene->margin > 0 && gap->bounds[0] <= scene->margin;
}

void part_answers_clear(struct part_answers *answers);

/* Returns an upper bound of the bytes of a result, for a pair query with a certificate of usual
 * length. */
size_t part_result_bytes(const struct part *part, const struct fmb_scene *scene);

/* Begins a part, whose fields up to column are set. On input: requests_ready() for its bytes.
 * Returns when its query is sent, or it is done. */
void part_begin(struct scene_run *run, struct part *part, size_t bytes);

/* The handler of the requests of a part, which is their user. */
request_handler part_take;

#endif
