/* The pairs of a scene query, block after block: those that are listed; or, of all and across,
 * those whose boxes meet, in the order of (a, b). */
#ifndef SCENE_PAIRS_H
#define SCENE_PAIRS_H

#include "query.h"

/* Filled in by scene_pairs_begin(). */
struct scene_pairs {
    const struct scene_query *query;
    int32_t next; /* PAIRS_LISTED: the pair */
    /* All and across: placement a and the first found_count of found[] may meet; given of these
     * pairs have been in a block. */
    struct fmb_tree tree;
    const struct fmb_prepared *prepared;
    unsigned a;
    size_t found_count, given;
    unsigned found[QUERY_PLACEMENTS_MAX];
};

/* How many pairs the query has, whether they can meet or not. */
int32_t scene_pairs_total(const struct scene_query *query);

/* On input: a query that has been checked, its placements, prepared, and
 * fmb_tree_bytes(QUERY_PLACEMENTS_MAX) bytes; all are needed until the last block. Begins with
 * first_pair. */
void scene_pairs_begin(struct scene_pairs *pairs, const struct scene_query *query,
                       const struct fmb_prepared *prepared, void *memory);

/* The next block, of max pairs or fewer, in *block: in out, or where the query lists them. Returns
 * how many, 0 also where it has searched for a while and found none. */
size_t scene_pairs_next(struct scene_pairs *pairs, unsigned (*out)[2], size_t max,
                        const unsigned (**block)[2]);

/* The number of the pair, counted as first_pair is, that the next block begins with: all before it
 * have been in blocks, or cannot meet. The total: there are no more blocks. */
int32_t scene_pairs_position(const struct scene_pairs *pairs);

/* The number of pair k of a block. */
int32_t scene_pairs_number(const struct scene_query *query, const unsigned (*block)[2], size_t k);

#endif
