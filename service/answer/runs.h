/* Runs of consecutive slots of an array, of any length: taken and freed in any order, in constant
 * time. Freed runs are merged with their free neighbours. For one thread at a time. */
#ifndef RUNS_H
#define RUNS_H

#include <stdint.h>

/* Of the first and the last slot of each run; between them the fields mean nothing. Free runs are
 * in a list of those of similar length. */
struct run_slot {
    int32_t length;         /* of a free run negative */
    int32_t next, previous; /* in the list, of the first slot of a free run; -1: none */
};

/* List c has the free runs of lengths from 2^c to 2^(c + 1) - 1. */
enum { RUNS_LISTS = 31 };

struct runs {
    int32_t count;
    int32_t list[RUNS_LISTS]; /* the first of each; -1: none */
    struct run_slot *slot;    /* [count], not owned */
};

/* All slots are free. On input: count from 1. */
void runs_init(struct runs *runs, struct run_slot *slot, int32_t count);

/* Takes a run of so many slots, from 1. Returns its first slot; -1: no free run is known that is
 * long enough. One that was freed last is always known; so is any, for a run of one slot. */
int32_t runs_take(struct runs *runs, int32_t length);

/* Frees a run. On input: its first slot. Returns the first slot of the free run that contains it
 * now. */
int32_t runs_free(struct runs *runs, int32_t first);

/* On input: the first slot of a run, free or taken. */
int32_t runs_length(const struct runs *runs, int32_t first);

/* The first slot of the run after a run; of the taken one before a free one. -1: there is none. */
int32_t runs_after(const struct runs *runs, int32_t first);
int32_t runs_before(const struct runs *runs, int32_t first);

#endif
