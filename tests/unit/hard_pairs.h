/* Families of pairs that are hard for a reason: the families of the campaigns, and windows and
 * numbers that the campaigns do not have. */
#ifndef HARD_PAIRS_H
#define HARD_PAIRS_H

#include <stddef.h>

#include "draw.h"
#include "family.h"
#include "question.h"

struct hard_family {
    const char *name;
    void (*draw_question)(struct draw *draw, struct question *question);
    int verdict;                 /* of all pairs; 0: all three occur; -1: any */
    long usual;                  /* number of pairs */
    const struct family *family; /* NULL: draw_question draws */
};

/* NULL after the last one. The first one has small whole numbers. */
enum { HARD_FAMILIES_MAX = 128 };
const struct hard_family *hard_family_at(size_t index);

/* A pair of finite numbers, each body of one frame. */
void hard_draw(struct draw *draw, const struct hard_family *family, struct question *question);

#endif
