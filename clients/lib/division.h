/* Divides a scene into parts that fit a datagram, in an order in which sorting the answers into the
 * order of the pairs takes little memory (scene_run.h).
 *
 * A part is small enough for all its bodies to be sent whole. There is one exception: a scene that
 * fits a datagram only if the bodies that the service holds are sent by handle is one part. If the
 * service does not hold them after all, scene_run.c divides the scene again.
 *
 * Listed pairs are taken in order, as many as fit with the placements that they need. So are all
 * pairs of ALL and ACROSS if each pair is a separate query, or if the method is not the default.
 * Otherwise ALL and ACROSS are divided into blocks of placements, unless all fit into one datagram:
 * a part is a pair of blocks, or one block with itself. The parts with the same first block are a
 * row; the second block is the column. */
#ifndef DIVISION_H
#define DIVISION_H

#include "held.h"
#include "ignored.h"
#include "scene_part.h"

/* A placement of the scene. */
struct division_body {
    struct held_body *entry; /* NULL: it is always sent whole */
    uint32_t bytes, least;   /* bytes in a query: whole (but see by_handle); as it is sent now */
    uint64_t part;           /* without blocks: number of the last part that has it */
    uint16_t index;          /* in that part */
};

struct division {
    const struct fmb_scene *scene;
    struct division_body *body; /* owned, [placement_count] */
    struct ignored ignored;
    unsigned *ignored_memory; /* owned */
    bool single, blocks;
    bool by_handle;        /* the exception: bytes are least of all bodies */
    struct pair_cursor at; /* without blocks: after the parts so far */
    uint64_t part;         /* without blocks: number of the last part, from 1 */
    /* Block i has the placements start[i] to start[i + 1] - 1. The first row_count begin rows. */
    unsigned *start; /* owned, [block_count + 1]; NULL without blocks */
    size_t block_count, row_count;
    size_t row, column; /* of the next part: its blocks */
};

/* On input: a checked scene, which must outlive the division. single: each pair is a separate
 * query. whole: without the exception above. scratch: memory for QUERY_BYTES_MAX bytes of geometry.
 * Returns false if out of memory. The caller calls division_end() in either case. */
bool division_begin(const struct fmb_scene *scene, bool single, bool whole, struct held *held,
                    unsigned char *scratch, struct division *out);
void division_end(struct division *division);

/* Returns true and the next part, of at most pairs_max pairs if they are listed; or false after the
 * last one. Sets the first fields of *out, up to column. */
bool division_next(struct division *division, int32_t pairs_max, struct part *out);

/* Writes the ignored pairs of a part, as indices in the part. Returns their number, at most max; 0
 * without blocks. */
int32_t division_ignored(struct division *division, const struct part *part, int32_t max,
                         unsigned (*out)[2]);

/* Returns the first column of a row. */
size_t division_first_column(const struct division *division, size_t row);

#endif
