/* Divides a scene into parts that fit a datagram, in an order that needs little memory to sort
 * their answers into the order of the pairs. Parts are small enough for all their bodies to be sent
 * whole. But a scene is one part if it fits a datagram with the bodies that the service holds by
 * handle; if the service turns out not to hold them, scene_run.c has it divided again.
 *
 * Listed pairs are taken in order, as many as fit with the placements that they need. ALL and
 * ACROSS are divided into blocks of placements, unless all fit into one datagram: each part is a
 * pair of blocks, or one block with itself, and the parts with the same first block are a row. If
 * each pair is a separate query, or the method only decides listed pairs, all pairs are taken in
 * order. */
#ifndef CUT_H
#define CUT_H

#include "held.h"
#include "scene_part.h"

struct cut_place;

/* A placement of the scene. */
struct cut_body {
    struct held_body *held; /* its entry, while that has this serial number; NULL: anonymous */
    uint64_t serial;
    uint32_t bytes, least; /* in a query: whole; as it will be sent */
};

struct cut {
    const struct fmb_client_scene *scene;
    struct cut_body *body;  /* owned, [placement_count] */
    unsigned (*ignored)[2]; /* owned, [ignored_count]: a < b, in the order of (a, b), each once */
    size_t ignored_count;
    bool single, blocks;
    bool by_handle;                /* one part, too large for bodies that are sent whole */
    struct client_scene_cursor at; /* without blocks: after the parts so far */
    uint64_t part;                 /* number of the last part */
    struct cut_place
        *place; /* owned, [placement_count]: the last part with this placement, and its index */
    /* Block i has the placements start[i] to start[i + 1] - 1. The first row_count begin rows. */
    unsigned *start; /* owned, [block_count + 1] */
    size_t block_count, row_count;
    size_t row, column; /* of the next part: its blocks */
};

/* On input: a checked scene, which must outlive the cut; single: each pair is a separate query;
 * whole: bodies that the service holds count as whole too; scratch: for QUERY_BYTES_MAX bytes of
 * geometry. False: out of memory; cut_end() is called all the same. */
bool cut_begin(const struct fmb_client_scene *scene, bool single, bool whole, struct held *held,
               unsigned char *scratch, struct cut *out);
void cut_end(struct cut *cut);

/* The next part; at most pairs_max pairs if they are listed. False: there is none. */
bool cut_next(struct cut *cut, int32_t pairs_max, struct part *out);

/* Whether the pair is ignored. */
bool cut_ignores(const struct cut *cut, const unsigned pair[2]);

/* The ignored pairs of a part, as indices in the part. Returns their number, at most max. */
int32_t cut_ignored(const struct cut *cut, const struct part *part, int32_t max,
                    unsigned (*out)[2]);

/* The first column of a row. */
size_t cut_column(const struct cut *cut, size_t row);

#endif
