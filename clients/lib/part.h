/* A part of a question, which one datagram has room for, and the answers to it. */
#ifndef PART_H
#define PART_H

#include "fmb_client.h"
#include "question.h"

/* No frame that comes whole takes less: in 2D, at rest. */
enum { PART_FRAME_BYTES_MIN = 80, PART_FRAMES_MAX = QUERY_BYTES_MAX / PART_FRAME_BYTES_MIN };

struct part {
    bool alone;    /* a pair query */
    int32_t which; /* QUERY_PAIRS_ */
    int32_t split; /* with ACROSS */
    int32_t total; /* of pairs */
    int32_t frame_count;
    unsigned frame[PART_FRAMES_MAX];   /* [in the part]: index in the scene */
    uint16_t pair[QUERY_PAIRS_MAX][2]; /* LISTED: [total][a, b], indices in the part */
    size_t bytes;                      /* of the query with all frames whole */
    size_t row, column;                /* for cut.h and order.h */
};

/* A pair that is not separated. */
struct part_found {
    int32_t number;           /* in the part, in its order */
    struct fmb_answer answer; /* with verdict 0: the method cannot decide it */
};

/* All 0: none yet. */
struct part_answers {
    int32_t answered; /* pairs, the first ones; those not found are separated */
    int status;       /* of the others, once there will be no more */
    char text[QUERY_TEXT_MAX];
    struct part_found *found;  /* owned, in order */
    size_t count, room, given; /* given: those before this one have been looked at */
    char *certificate;         /* owned; NULL: none */
};

void part_answers_clear(struct part_answers *answers);

/* The rest is without an answer. text may be NULL: that of the status. */
void part_answers_refuse(struct part_answers *answers, int status, const char *text);

/* Bytes that the result takes at most. */
size_t part_result_bytes(const struct part *part, const struct fmb_client_scene *scene);

/* With ALL and ACROSS: how many pairs of the part come before those of frame a of the part. */
int32_t part_pairs_before(const struct part *part, int32_t a);

/* Takes what a result with FMB_OK says of the pairs from answers->answered on. NONSENSE: it does
 * not fit the question; nothing was taken. */
enum part_taken { PART_TAKEN, PART_NONSENSE, PART_NO_MEMORY };
enum part_taken part_take_scene(const struct part *part, const struct fmb_client_scene *scene,
                                const struct scene_result *result, struct part_answers *answers);
enum part_taken part_take_pair(const struct part *part, const struct fmb_client_scene *scene,
                               const struct pair_result *result, struct part_answers *answers);

#endif
