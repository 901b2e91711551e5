#include "support.h"

/* Two lanes on every machine: four gain less than a quarter of a decision. */
#define LANES 2
#include "lanes.h"

#include <math.h>

enum { VECTORS = SUPPORT_BLOCK / LANES };

INLINE lanes values_at(const double *v, size_t stride, const lanes n[FMB_DIM_MAX], const int dim)
{
    const lanes plane = n[0] * lanes_load(v) + n[1] * lanes_load(v + stride);
    return dim == 2 ? plane : plane + n[2] * lanes_load(v + 2 * stride);
}

/* The greatest value of a block, in each lane. */
INLINE lanes block_max(const double *v, size_t stride, const lanes n[FMB_DIM_MAX], const int dim)
{
    lanes most = values_at(v, stride, n, dim);
    UNROLL(4)
    for (int k = 1; k < VECTORS; k++)
        most = lanes_max(values_at(v + k * LANES, stride, n, dim), most);
    return most;
}

/* Returns the first vertex of a block with this value, the greatest of the block; its first vertex
 * if there is none, because sums overflow. The vertices that fill the block up come last. */
INLINE unsigned first_with(const double *v, size_t stride, const lanes n[FMB_DIM_MAX],
                           const int dim, lanes value)
{
    unsigned bits = 0;
    UNROLL(4)
    for (int k = 0; k < VECTORS; k++)
        bits |= lanes_mask_bits(values_at(v + k * LANES, stride, n, dim) == value) << k * LANES;
    return bits ? (unsigned) __builtin_ctz(bits) : 0;
}

/* No branch but that of the loop: which lane, and which vertex of a block, is the greatest cannot
 * be predicted. */
INLINE struct support scan(const struct support_vertices *vertices, const double n[FMB_DIM_MAX],
                           const int dim)
{
    const lanes direction[FMB_DIM_MAX] = {lanes_of(n[0]), lanes_of(n[1]),
                                          lanes_of(dim == 2 ? 0 : n[2])};
    const size_t stride = vertices->stride;
    lanes best = lanes_of(-INFINITY), where = lanes_of(0), here = lanes_of(0);
    for (unsigned i = 0; i < vertices->count; i += SUPPORT_BLOCK) {
        const lanes most = block_max(vertices->at + i, stride, direction, dim);
        where = lanes_select(most > best, here, where);
        best = lanes_max(most, best);
        here += SUPPORT_BLOCK;
    }
    const lanes all = lanes_max(best, lanes_swap(best));
    where = lanes_select(best == all, where, lanes_of(INFINITY));
    const unsigned first = (unsigned) lanes_min(where, lanes_swap(where))[0];
    const unsigned i = first_with(vertices->at + first, stride, direction, dim, all);
    return (struct support){.index = first + i, .value = all[0]};
}

struct support support_max(const struct support_vertices *vertices, const double n[FMB_DIM_MAX])
{
    return vertices->dim == 2 ? scan(vertices, n, 2) : scan(vertices, n, 3);
}

/* Most blocks have no such vertex. */
INLINE unsigned list(const struct support_vertices *vertices, const double n[FMB_DIM_MAX],
                     double least, uint16_t *out, const int dim)
{
    const lanes direction[FMB_DIM_MAX] = {lanes_of(n[0]), lanes_of(n[1]),
                                          lanes_of(dim == 2 ? 0 : n[2])};
    const size_t stride = vertices->stride;
    unsigned listed = 0;
    for (unsigned first = 0; first < vertices->count; first += SUPPORT_BLOCK) {
        const double *v = vertices->at + first;
        unsigned less = 0;
        UNROLL(4)
        for (int k = 0; k < VECTORS; k++)
            less |=
                lanes_mask_bits(values_at(v + k * LANES, stride, direction, dim) < lanes_of(least))
                << k * LANES;
        for (unsigned rest = ~less & ((1U << SUPPORT_BLOCK) - 1); rest; rest &= rest - 1) {
            const unsigned i = first + (unsigned) __builtin_ctz(rest);
            if (i < vertices->count)
                out[listed++] = (uint16_t) i;
        }
    }
    return listed;
}

unsigned support_list(const struct support_vertices *vertices, const double n[FMB_DIM_MAX],
                      double least, uint16_t *out)
{
    return vertices->dim == 2 ? list(vertices, n, least, out, 2) : list(vertices, n, least, out, 3);
}
