/* Cuts a question into parts that one datagram has room for, in an order in which their answers can
 * be put into that of the pairs with little memory.
 *
 * Pairs that are listed are taken as they come, as many as fit with the frames that they need. ALL
 * and ACROSS are cut into blocks of frames, unless one datagram has room for all: each part is two
 * blocks against each other, or one in itself, and a row are the parts with the same first block.
 * Pairs that are asked one by one, or by a method that decides listed pairs alone, are taken one
 * after the other, whichever they are. */
#ifndef CUT_H
#define CUT_H

#include "part.h"

struct cut_place;

struct cut {
    const struct fmb_client_scene *scene;
    bool alone, blocks;
    struct question_cursor at; /* without blocks: behind the parts so far */
    uint64_t part;             /* number of the last one */
    struct cut_place
        *place; /* owned, [frame_count]: the last part that a frame was in, and where */
    /* Block i has the frames from start[i] up to start[i + 1]. The first ones begin rows. */
    unsigned *start; /* owned, [block_count + 1] */
    size_t block_count, row_count;
    size_t row, column; /* of the next part: its blocks */
};

/* On input: a checked question, to outlive the cut; whether its pairs are asked one by one.
 * False: no memory. */
bool cut_begin(const struct fmb_client_scene *scene, bool alone, struct cut *out);
void cut_end(struct cut *cut);

/* The next part; of those that are listed, with pairs_max pairs at most. False: there is none. */
bool cut_next(struct cut *cut, int32_t pairs_max, struct part *out);

/* The first column of a row. */
size_t cut_column(const struct cut *cut, size_t row);

#endif
