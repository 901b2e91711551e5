/* The keys that a service told: which body, with which components, may be named by which number. */
#ifndef KEYS_H
#define KEYS_H

#include "query.h"

/* Bodies that are remembered. One that has the place of another takes it. */
enum { KEYS_BITS = 15, KEYS_MAX = 1 << KEYS_BITS };

struct keys_entry {
    int64_t body_id, server_id, key;
    int32_t shape, dim;
    struct query_numbers components;
};

/* All 0: none. */
struct keys {
    int64_t server_id; /* whose keys they are: those of another one are forgotten */
    struct keys_entry entry[KEYS_MAX];
};

/* On input: a frame with all its components, those beyond count being 0. On output: the key that
 * stands for exactly these, to the bit; 0: none that is known. */
int64_t keys_find(const struct keys *keys, const struct query_frame *frame);

/* This service told this key for the frame; 0 and what is no key: it has none any more. */
void keys_learn(struct keys *keys, int64_t server_id, const struct query_frame *frame, int64_t key);

#endif
