/* Slabs in fixed-width integers: the step between doubles and GMP.
 *
 * A slab that the filter leaves open is computed here by itself, in two's complement integers of 2
 * to LIMBS_MAX limbs of 64 bits, without allocation. Nothing rounds. A pair whose numbers need more
 * bits is left to the exact method. */
#ifndef FMB_LIMBS_H
#define FMB_LIMBS_H

#include "limbs_rotation.h"
#include "slabs.h"

/* The coordinates of an edge: those of its frame, of the other frame, and of the world. */
enum limbs_view { LIMBS_OWN, LIMBS_ACROSS, LIMBS_WORLD, LIMBS_VIEWS };

/* A pair. Lengths are integers times 2^unit of its span. Contains pointers into itself: must not be
 * copied. */
struct limbs_pair {
    const struct fmb_frame *frame[2];
    int limbs; /* of a number */
    /* For a box: half of its components, and its centre as the origin. */
    struct limbs_vector component[2][FMB_DIM_MAX], origin[2];
    struct limbs_vector offset, drift; /* of the positions */
    /* Matrices by rows, NULL for the identity: from a frame to the world and back, and to the other
     * frame. */
    const struct limbs_vector *to_world[2], *from_world[2], *across[2];
    const struct limbs_factor *norm[2], *all; /* factors of these matrices; NULL: 1 */
    const struct limbs_factor *common;        /* of equal orientations; otherwise NULL */
    struct limbs_rotation rotation[2], relative;
    /* Edges, computed when they are needed, and their storage. */
    const struct limbs_vector *view[2][SLABS_EDGES][LIMBS_VIEWS];
    struct limbs_vector storage[2][SLABS_EDGES][LIMBS_VIEWS];
};

/* Returns the span of all lengths of a pair: components, origins, positions, and displacements v T.
 */
struct dyadic_span limbs_span_of(const struct frame_pair *pair);

/* Returns whether no operation of slabs.c on this pair rounds. drift_size and sizes: as in
 * slabs_pair. */
bool limbs_never_round(const struct slabs_pair *pair, struct dyadic_span span);

/* Converts a pair. Returns false if its numbers, times those of the orientations, need more than
 * LIMBS_MAX limbs. */
bool limbs_prepare(const struct frame_pair *pair, struct dyadic_span span, struct limbs_pair *out);

/* The same, also for products with normals in the planes of faces. */
bool limbs_prepare_faces(const struct frame_pair *pair, struct dyadic_span span,
                         struct limbs_pair *out);

/* Returns the sign of the gap of a slab; -1 if its normal is zero and the slab is void. Edges are
 * in the order of slabs_list(): of a, of b, the drift. */
int limbs_gap_sign(struct limbs_pair *pair, struct slab_normal normal);

/* The planes of two faces. */
struct limbs_planes {
    bool parallel; /* their planes are */
    bool shared;   /* they are the same plane at all times of the window */
};

struct limbs_planes limbs_planes_of(struct limbs_pair *pair);

/* Computes the numbers of a slab_value exactly, times a common positive factor. */
void limbs_slab(struct limbs_pair *pair, struct slab_normal normal, mpz_t low, mpz_t high,
                mpz_t start, mpz_t slope);

/* Products of a normal with the vectors of a pair, times one positive factor. */
struct limbs_products {
    limbs_number component[2][FMB_DIM_MAX]; /* [frame][component]; of a box, of half of it */
    limbs_number offset; /* from the origin of frame 0 to that of frame 1; of a box, its centre */
    limbs_number drift;
};

/* Computes the products of the normal of a slab. Returns false if it is zero. */
bool limbs_products_of(struct limbs_pair *pair, struct slab_normal normal,
                       struct limbs_products *out);

/* The same for a normal in the plane of frame f, a face: that of the face times one of its edges.
 * On input, the pair is prepared for this. */
void limbs_products_in_face(struct limbs_pair *pair, int f, int edge, struct limbs_products *out);

#endif
