/* A question and its answer as plain structs, between the wire (wire.h), which fills and
 * reads them, and the answering code (answer.h), which knows no LCM. The fields mean what
 * the messages in msgs/ say. */
#ifndef QUERY_H
#define QUERY_H

#include "fmb/fmb.h"

#include <stdbool.h>
#include <stdint.h>

/* Ids, keys and sequence numbers: doubles hold integers exactly up to here, and some of LCM's
 * languages know no other numbers. */
#define QUERY_ID_MAX ((INT64_C(1) << 53) - 1)

/* Inline: each file that keeps things by id asks these for every message. */
static inline bool query_id_ok(int64_t id)
{
    return id >= 0 && id <= QUERY_ID_MAX;
}

/* Multiplicative hashing: the product with 2^64 / golden ratio, and its high half. */
static inline uint64_t query_id_mix(int64_t id)
{
    return (uint64_t) id * UINT64_C(0x9e3779b97f4a7c15);
}

static inline uint32_t query_id_hash(int64_t id)
{
    return (uint32_t) (query_id_mix(id) >> 32);
}

enum { QUERY_WANT_BOX = 1, QUERY_WANT_CERTIFICATE = 2, QUERY_WANT_TIMES = 4 };

/* What a query, and the result that answers it, take at most, in bytes: one datagram. */
enum { QUERY_BYTES_MAX = 65000 };

enum { QUERY_TEXT_MAX = 160 };

/* Of a certificate, with the final 0: the result that carries it is one datagram. */
enum { QUERY_CERTIFICATE_MAX = 60000 };

/* With what every query begins. */
struct query_header {
    int64_t utime, client_id, sequence_number;
};

/* A list of doubles as it came: count may be anything from 0, only the first
 * FMB_COMPONENTS_MAX numbers are kept. */
struct query_numbers {
    int32_t count;
    double number[FMB_COMPONENTS_MAX];
};

struct query_frame {
    int64_t body_id; /* 0: anonymous */
    int64_t key;     /* 0: none */
    int32_t shape;
    int32_t dim; /* equals origin.count */
    struct query_numbers origin, components, velocity;
};

struct pair_query {
    int64_t utime; /* microseconds since 1970 */
    int64_t client_id;
    int64_t sequence_number;
    double duration; /* seconds */
    int32_t method;  /* 0: the default */
    int32_t want;
    struct query_frame frame[2];
};

struct pair_result {
    int64_t utime, client_id, sequence_number;
    int64_t server_id;
    int64_t body_id[2], key[2];
    int32_t status;              /* enum fmb_status */
    char detail[QUERY_TEXT_MAX]; /* "" where OK */
    int32_t method;              /* 0 where not OK */
    int32_t dim;                 /* of the box, 2 or 3; 0 where there is none */
    struct fmb_answer answer;    /* all 0 where not OK */
    const char *certificate;     /* NULL: none. Not owned: of the answerer, or of the message */
    int64_t compute_ns;
};

/* ---- Scenes ---- */

enum { QUERY_PAIRS_LISTED = 0, QUERY_PAIRS_ALL = 1, QUERY_PAIRS_ACROSS = 2 };

/* No query of QUERY_BYTES_MAX has more frames that are good, nor more pairs listed: a frame takes
 * 48 bytes (2D, by key, at rest) or more, a pair 4. */
enum { QUERY_FRAMES_MAX = 1400, QUERY_PAIRS_MAX = QUERY_BYTES_MAX / 4 };

struct scene_query {
    int64_t utime, client_id, sequence_number;
    double duration;
    int32_t method, want;
    int32_t which; /* QUERY_PAIRS_ */
    int32_t split, first_pair;
    /* Counts as they came; of more than there is room for, the first are kept. */
    int32_t frame_count, index_count;
    struct query_frame frame[QUERY_FRAMES_MAX];
    /* [pair][a, b], as they came: a negative one is beyond every count. */
    unsigned pair[QUERY_PAIRS_MAX][2];
};

/* What a result has room for: five bytes a pair that is named and nothing else; eight a number. */
enum {
    QUERY_VERDICTS_MAX = QUERY_PAIRS_MAX,
    QUERY_FOUND_MAX = QUERY_BYTES_MAX / 5,
    QUERY_NUMBERS_MAX = QUERY_BYTES_MAX / 8
};

struct scene_result {
    int64_t utime, client_id, sequence_number;
    int64_t server_id;
    int32_t status;              /* enum fmb_status */
    char detail[QUERY_TEXT_MAX]; /* "" where OK */
    int32_t method;              /* 0 where not OK */
    int64_t lost;
    int32_t end_pair;
    int64_t compute_ns;
    int dim;           /* of the boxes, 2 or 3; 0 where there are none */
    int32_t key_count; /* 0 or the frames of the query */
    int32_t
        verdict_count; /* of pairs, from first_pair on; of found ones where the pairs are named */
    int32_t contact_count; /* of verdicts that touch or overlap */
    bool names_pairs, has_times, has_boxes;
    int64_t key[QUERY_FRAMES_MAX];
    unsigned char verdict[QUERY_VERDICTS_MAX];
    unsigned pair[QUERY_FOUND_MAX][2]; /* [verdict_count][a, b] where names_pairs */
    double times[QUERY_NUMBERS_MAX];   /* [contact][first, last], seconds, where has_times */
    double boxes[QUERY_NUMBERS_MAX];   /* [contact][lower, upper][dim], where has_boxes */
};

#endif
