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

/* Multiplicative hashing: the high half of the product with 2^64 / golden ratio. */
static inline uint32_t query_id_hash(int64_t id)
{
    return (uint32_t) ((uint64_t) id * UINT64_C(0x9e3779b97f4a7c15) >> 32);
}

enum { QUERY_WANT_BOX = 1, QUERY_WANT_CERTIFICATE = 2 };

enum { QUERY_TEXT_MAX = 160 };

/* Of a certificate, with the final 0: the result that carries it is one datagram of less than
 * 65,000 bytes. */
enum { QUERY_CERTIFICATE_MAX = 60000 };

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

#endif
