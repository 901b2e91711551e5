/* A difference, with the place of its query in the logs. */
#ifndef FOUND_H
#define FOUND_H

#include "compare.h"
#include "match.h"

struct found {
    struct match_place place; /* of the query */
    enum log_kind kind;       /* of the query */
    int64_t client_id, sequence_number;
    struct difference difference;
};

/* Most bytes of a certificate shown in a report, final 0 included. */
enum { FOUND_TEXT_MAX = 200 };

typedef void found_sink(void *user, const struct found *found);

#endif
