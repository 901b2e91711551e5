/* The vertex of a polytope that is farthest in a direction.
 *
 * Method: one scan of the vertices, in SIMD vectors, in blocks of SUPPORT_BLOCK. Each lane keeps
 * its greatest value and the first block that has it; the first vertex of that block with the
 * greatest value of all lanes is the result. A maximum does not round, so that neither the number
 * of lanes nor that of blocks changes a bit. Ties: the lowest index.
 *
 * Accuracy, with u = 2^-53: n . v is computed with three roundings. It is off by at most 3.01 u
 * sum_i |n_i v_i| <= 3.01 u |n| |v|, and by 2^-1073 where products underflow. */
#ifndef FMB_SUPPORT_H
#define FMB_SUPPORT_H

#include "fmb.h"

enum { SUPPORT_BLOCK = 8 };

/* Vertices, x of all, then y, then z. */
struct support_vertices {
    const double *at; /* [axis][stride], finite */
    unsigned count;   /* at least 1 */
    /* A multiple of SUPPORT_BLOCK, at least count. The numbers from count on repeat a vertex. */
    unsigned stride;
    int dim;
};

/* The vertices of a hull. */
static inline struct support_vertices hull_frame_vertices(const struct fmb_frame *frame)
{
    return (struct support_vertices){frame->vertices, frame->vertex_count, frame->vertex_stride,
                                     frame->dim};
}

struct support {
    unsigned index;
    double value; /* n . v of the vertex, rounded; its zeros may have any sign */
};

/* Returns the vertex with the greatest n . v. In: n finite; [2] is not read in 2D. If sums
 * overflow, the index is that of some vertex, and the value is infinite. No shared state. */
struct support support_max(const struct support_vertices *vertices, const double n[FMB_DIM_MAX]);

/* Returns n . v of vertex i, with the same bits. */
static inline double support_value(const struct support_vertices *vertices,
                                   const double n[FMB_DIM_MAX], unsigned i)
{
    const double *v = vertices->at + i;
    const size_t stride = vertices->stride;
    const double plane = n[0] * v[0] + n[1] * v[stride];
    return vertices->dim == 2 ? plane : plane + n[2] * v[2 * stride];
}

/* Lists the vertices whose value is not less than least, ascending. out: [count]. Returns their
 * number. */
unsigned support_list(const struct support_vertices *vertices, const double n[FMB_DIM_MAX],
                      double least, uint16_t *out);

#endif
