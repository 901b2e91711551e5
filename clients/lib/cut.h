/* Divides a scene into parts that fit a datagram, in an order that needs little memory to sort
 * their answers into the order of the pairs.
 *
 * Listed pairs are taken in order, as many as fit with the placements that they need. ALL and
 * ACROSS are divided into blocks of placements, unless all fit into one datagram: each part is a
 * pair of blocks, or one block with itself, and the parts with the same first block are a row. If
 * each pair is a separate query, or the method only decides listed pairs, all pairs are taken in
 * order. */
#ifndef CUT_H
#define CUT_H

#include "scene_part.h"

struct cut_place;

struct cut {
    const struct fmb_client_scene *scene;
    bool single, blocks;
    struct question_cursor at; /* without blocks: after the parts so far */
    uint64_t part;             /* number of the last part */
    struct cut_place
        *place; /* owned, [placement_count]: the last part with this placement, and its index */
    /* Block i has the placements start[i] to start[i + 1] - 1. The first row_count begin rows. */
    unsigned *start; /* owned, [block_count + 1] */
    size_t block_count, row_count;
    size_t row, column; /* of the next part: its blocks */
};

/* On input: a checked scene, which must outlive the cut; single: each pair is a separate query.
 * False: out of memory. */
bool cut_begin(const struct fmb_client_scene *scene, bool single, struct cut *out);
void cut_end(struct cut *cut);

/* The next part; at most pairs_max pairs if they are listed. False: there is none. */
bool cut_next(struct cut *cut, int32_t pairs_max, struct part *out);

/* The first column of a row. */
size_t cut_column(const struct cut *cut, size_t row);

#endif
