/* A difference that was found, with the place of its query. */
#ifndef FOUND_H
#define FOUND_H

#include "compare.h"
#include "match.h"

#include <stdio.h>

struct found {
    struct match_place place; /* of the query */
    enum log_kind kind;       /* of the query */
    struct query_header ids;
    struct difference difference;
};

/* Where they go. */
typedef void found_sink(void *user, const struct found *found);

/* To and from a file of this process's own or its children's; of certificates the beginning. */
enum { FOUND_TEXT_MAX = 200 };
bool found_write(FILE *file, const struct found *found);

/* *text holds the certificates of *out. False at the end. */
struct found_text {
    char then[FOUND_TEXT_MAX], now[FOUND_TEXT_MAX];
};
bool found_read(FILE *file, struct found *out, struct found_text *text);

#endif
