/* Families of pairs that are hard for a reason. */
#ifndef HARD_PAIRS_H
#define HARD_PAIRS_H

#include <stddef.h>

#include "draw.h"
#include "question.h"

struct hard_family {
    const char *name;
    void (*draw_question)(struct draw *draw, struct question *question);
    int verdict; /* of all pairs; 0: all three come up; -1: any */
    long usual;  /* count */
};

/* NULL after the last one. */
const struct hard_family *hard_family_at(size_t index);

/* A pair of finite numbers. */
void hard_draw(struct draw *draw, const struct hard_family *family, struct question *question);

#endif
