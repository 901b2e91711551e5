/* What a recording has heard, and what it has not. */
#ifndef RECORD_TALLY_H
#define RECORD_TALLY_H

#include "log_kind.h"
#include "record_answered.h"
#include "record_gaps.h"

/* All 0 at the start. */
struct tally {
    int64_t heard[LOG_KINDS]; /* messages */
    int64_t bytes;            /* of a log that holds them all */
    int64_t malformed;        /* of the service's kinds, those that are no such message */
    struct gaps gaps;
    struct answered answered;
};

/* A message of size bytes on a channel. */
void tally_note(struct tally *tally, enum log_kind kind, size_t channel_length, const void *data,
                uint32_t size);

/* Of all kinds. */
int64_t tally_heard(const struct tally *tally);

/* For people and for JSON: "pair_queries". */
const char *tally_kind_name(enum log_kind kind);

#endif
