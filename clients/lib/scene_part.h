/* A part of a scene that fits a datagram, and its answers. */
#ifndef SCENE_PART_H
#define SCENE_PART_H

#include "fmb_client.h"
#include "client_scene.h"

struct part {
    bool single;   /* a pair query */
    int32_t which; /* QUERY_PAIRS_ */
    int32_t split; /* with ACROSS */
    int32_t total; /* of pairs */
    int32_t placement_count;
    unsigned placement[QUERY_PLACEMENTS_MAX]; /* [in the part]: index in the scene */
    uint16_t pair[QUERY_PAIRS_MAX][2];        /* LISTED: [total][a, b], indices in the part */
    size_t bytes;                             /* of the query, without ignored pairs */
    size_t row, column;                       /* for division.h and order.h */
};

/* A pair that is not separated, or has a gap. */
struct part_answer {
    int32_t number;           /* in the part, in its order */
    struct fmb_answer answer; /* with verdict 0: the method cannot decide it */
};

/* All 0: none yet. */
struct part_answers {
    int32_t answered; /* the first so many pairs; those not listed in answer are separated */
    int status;       /* of the other pairs, once no more answers will come */
    char text[QUERY_TEXT_MAX];
    struct part_answer *answer;        /* owned, [count], in order */
    size_t count, capacity, delivered; /* delivered: index of the first not delivered yet */
    char *certificate;                 /* owned; NULL: none */
};

void part_answers_clear(struct part_answers *answers);

/* Sets the status of all pairs not answered. text: NULL or "" for that of the status. */
void part_answers_refuse(struct part_answers *answers, int status, const char *text);

/* Whether a separated pair is near. */
static inline bool part_is_near(const struct fmb_client_scene *scene, const struct fmb_gap *gap)
{
    return scene->margin > 0 && gap->bounds[0] <= scene->margin;
}

/* Most bytes of the result. */
size_t part_result_bytes(const struct part *part, const struct fmb_client_scene *scene);

/* With ALL and ACROSS: number of the first pair of placement a of the part. */
int32_t part_pairs_before(const struct part *part, int32_t a);

/* Adds the answers of a result with FMB_OK, for the pairs from answers->answered on. MALFORMED: the
 * result does not match the part; nothing was added. */
enum part_taken { PART_TAKEN, PART_MALFORMED, PART_NO_MEMORY };
enum part_taken part_take_scene(const struct part *part, const struct fmb_client_scene *scene,
                                const struct scene_result *result, struct part_answers *answers);
enum part_taken part_take_pair(const struct fmb_client_scene *scene,
                               const struct pair_result *result, struct part_answers *answers);

/* The answer number k of a result, whose contacts before it number *contact, which is kept up. */
void part_read_answer(const struct scene_result *result, int32_t k, int32_t *contact,
                      struct fmb_answer *out);

#endif
