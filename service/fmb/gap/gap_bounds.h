/* Bounds of f at the normals of a pair in 3D: which of them may give its depth. */
#ifndef FMB_GAP_BOUNDS_H
#define FMB_GAP_BOUNDS_H

#include "gap.h"

struct gap_edge {
    double at[3], square; /* the square of its length, rounded */
    bool simplex, exact;  /* of a simplex; not a difference that was rounded */
};

/* In 3D edge 3 + r of a simplex is c_q - c_p, with p, q, r cyclic; in 2D edge 2 is c_1 - c_0. Those
 * that a frame does not have are 0. */
enum { GAP_EDGES = 6, GAP_FACES = 4, GAP_NORMALS_MAX = 2 * GAP_FACES + GAP_EDGES * GAP_EDGES };

/* The edges of each face; of a face number 2. */
static const int gap_face_edge[GAP_FACES][2] = {{1, 2}, {2, 0}, {0, 1}, {3, 4}};

INLINE int gap_next(int i)
{
    return i == 2 ? 0 : i + 1;
}

struct gap_edges {
    const struct gap_pair *pair;
    struct gap_edge of[2][GAP_EDGES], drift; /* of a negated */
};

/* Upper bounds of f, each negative, as their squares: f exceeds minus the root by at most the
 * margin. 0: none; infinite or NaN: the normal is 0. */
struct gap_bounds {
    double margin;
    int count;
    /* Faces of a, of b, GAP_FACES each; then each edge of a with all edges of b: 6 of a simplex, 4
     * of a cuboid. */
    lanes square[GAP_NORMALS_MAX / 2];
};

/* Of faces, and of edges with edges. */
void gap_bounds_set(const struct gap_edges *edges, struct gap_bounds *out);

#endif
