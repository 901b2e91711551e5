#include "support.h"

/* Two lanes on every machine: four gain less than a quarter of a decision. */
#define LANES 2
#include "lanes.h"

#include <math.h>
#include <string.h>

enum { VECTORS = SUPPORT_BLOCK / LANES };

INLINE lanes load(const double *at)
{
    lanes out;
    memcpy(&out, at, sizeof out);
    return out;
}

INLINE lanes values_at(const double *v, size_t stride, const lanes n[FMB_DIM_MAX], const int dim)
{
    const lanes plane = n[0] * load(v) + n[1] * load(v + stride);
    return dim == 2 ? plane : plane + n[2] * load(v + 2 * stride);
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

/* The first block with the greatest value of all lanes. */
INLINE double first_block(lanes value, lanes block, double *most)
{
    double first = INFINITY;
    *most = -INFINITY;
    for (int lane = 0; lane < LANES; lane++)
        *most = value[lane] > *most ? value[lane] : *most;
    for (int lane = 0; lane < LANES; lane++)
        if (value[lane] == *most && block[lane] < first)
            first = block[lane];
    return first;
}

INLINE struct support scan(const struct support_vertices *vertices, const double n[FMB_DIM_MAX],
                           const int dim)
{
    const lanes direction[FMB_DIM_MAX] = {lanes_of(n[0]), lanes_of(n[1]),
                                          lanes_of(dim == 2 ? 0 : n[2])};
    const size_t stride = vertices->stride;
    lanes best = lanes_of(-INFINITY), where = lanes_of(0);
    for (unsigned i = 0; i < vertices->count; i += SUPPORT_BLOCK) {
        const lanes most = block_max(vertices->at + i, stride, direction, dim);
        const lanes_mask above = most > best;
        best = lanes_select(above, most, best);
        where = lanes_select(above, lanes_of(i), where);
    }
    struct support out;
    const unsigned first = (unsigned) first_block(best, where, &out.value);
    unsigned i = first;
    while (i + 1 < vertices->count && i + 1 < first + SUPPORT_BLOCK &&
           support_value(vertices, n, i) != out.value)
        i++;
    out.index = i;
    return out;
}

struct support support_max(const struct support_vertices *vertices, const double n[FMB_DIM_MAX])
{
    return vertices->dim == 2 ? scan(vertices, n, 2) : scan(vertices, n, 3);
}
