/* Allocator of runs of consecutive slots of an array (segregated free lists with boundary tags).
 * Runs have any length, and are allocated and freed in any order in constant time. A freed run is
 * merged with its free neighbours. One struct runs may be used by one thread at a time. */
#ifndef RUNS_H
#define RUNS_H

#include <stdint.h>

/* Bookkeeping of a slot. Valid in the first and the last slot of each run only. */
struct run_slot {
    int32_t length;         /* of the run; negative if it is free */
    int32_t next, previous; /* first slot of a free run only: neighbours in its list; -1: none */
};

/* List c contains the free runs of lengths from 2^c to 2^(c + 1) - 1. */
enum { RUNS_LISTS = 31 };

struct runs {
    int32_t count;
    int32_t list[RUNS_LISTS]; /* first slot of the first run of each list; -1: the list is empty */
    struct run_slot *slot;    /* [count], not owned */
};

/* Makes all slots one free run. On input: count slots, 1 or more, which must outlive runs. */
void runs_init(struct runs *runs, struct run_slot *slot, int32_t count);

/* Allocates a run of so many slots, 1 or more. Returns its first slot; -1: no free run was found
 * that is long enough. The search is bounded, and may miss one; it never misses the run that was
 * freed last, nor any run if length is 1. */
int32_t runs_allocate(struct runs *runs, int32_t length);

/* Frees a run. On input: the first slot of an allocated run. Returns the first slot of the free run
 * that now contains it. */
int32_t runs_free(struct runs *runs, int32_t first);

/* Number of slots of a run. On input: the first slot of a run, free or allocated. */
int32_t runs_length(const struct runs *runs, int32_t first);

/* runs_after(): the first slot of the run that follows a run. runs_before(): the first slot of the
 * allocated run that precedes a free run. -1: there is none. */
int32_t runs_after(const struct runs *runs, int32_t first);
int32_t runs_before(const struct runs *runs, int32_t first);

#endif
