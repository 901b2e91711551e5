/* A difference, with the position of its query in the logs. */
#ifndef LOCATED_DIFFERENCE_H
#define LOCATED_DIFFERENCE_H

#include "compare.h"
#include "match.h"

struct located_difference {
    struct match_place place; /* of the query */
    enum log_kind kind;       /* of the query */
    int64_t client_id, sequence_number;
    struct difference difference;
};

/* Most bytes of a certificate shown in a report, final 0 included. */
enum { DIFFERENCE_TEXT_MAX = 200 };

typedef void located_difference_sink(void *user, const struct located_difference *located);

#endif
