/* A part of a scene that fits a datagram, and its answers. No shared state. */
#ifndef SCENE_PART_H
#define SCENE_PART_H

#include "fmb_client.h"
#include "client_scene.h"

struct part {
    bool single;   /* a pair query */
    int32_t which; /* enum fmb_pairs */
    int32_t split; /* with ACROSS */
    int32_t total; /* of pairs */
    int32_t placement_count;
    unsigned placement[QUERY_PLACEMENTS_MAX]; /* [in the part]: index in the scene */
    uint16_t pair[QUERY_PAIRS_MAX][2];        /* LISTED: [total][a, b], indices in the part */
    size_t bytes;                             /* of the query, without ignored pairs */
    size_t row, column;                       /* for division.h and order.h */
};

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

void part_answers_clear(struct part_answers *answers);

/* Sets the status of all pairs without an answer. text: NULL or "": the text of the status. */
void part_answers_refuse(struct part_answers *answers, int status, const char *text);

/* Whether a separated pair is near. */
static inline bool part_is_near(const struct fmb_scene *scene, const struct fmb_gap *gap)
{
    return scene->margin > 0 && gap->bounds[0] <= scene->margin;
}

/* Returns an upper bound of the bytes of a result, for a pair query with a certificate of usual
 * length. */
size_t part_result_bytes(const struct part *part, const struct fmb_scene *scene);

/* ALL and ACROSS: returns the number of pairs. */
int32_t part_pair_count(const struct part *part);

/* Adds the answers of a result with FMB_OK to those of the pairs before it. Returns MALFORMED if
 * the result does not match the query; nothing is added then, nor with NO_MEMORY. */
enum part_taken { PART_TAKEN, PART_MALFORMED, PART_NO_MEMORY };
enum part_taken part_take_scene(const struct part *part, const struct fmb_scene *scene,
                                const struct scene_result *result, struct part_answers *answers);
enum part_taken part_take_pair(const struct part *part, const struct fmb_scene *scene,
                               const struct pair_result *result, struct part_answers *answers);

#endif
