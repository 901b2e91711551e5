#include "sweep.h"

#include "allocate.h"

#include <stdlib.h>

struct box {
    double low[3], high[3];
};

static void set_box(const struct mesh *mesh, size_t face, struct box *out)
{
    for (int axis = 0; axis < 3; axis++) {
        out->low[axis] = out->high[axis] = mesh->vertex[mesh->face[face][0]][axis];
        for (int corner = 1; corner < 3; corner++) {
            const double x = mesh->vertex[mesh->face[face][corner]][axis];
            out->low[axis] = x < out->low[axis] ? x : out->low[axis];
            out->high[axis] = x > out->high[axis] ? x : out->high[axis];
        }
    }
}

static int compare(const void *x, const void *y)
{
    const double p = ((const struct box *) x)->low[0], q = ((const struct box *) y)->low[0];
    return (p > q) - (p < q);
}

static struct box *sorted(const struct mesh *mesh)
{
    struct box *out = allocate(mesh->face_count, sizeof *out);
    for (size_t i = 0; i < mesh->face_count; i++)
        set_box(mesh, i, &out[i]);
    qsort(out, mesh->face_count, sizeof *out, compare);
    return out;
}

static int meet_across(const struct box *x, const struct box *y)
{
    return (x->low[1] <= y->high[1]) & (y->low[1] <= x->high[1]) & (x->low[2] <= y->high[2]) &
           (y->low[2] <= x->high[2]);
}

/* Those that begin no earlier than this one, and before it ends. */
static uint64_t count_from(const struct box *box, const struct box *other, const struct box *end)
{
    uint64_t found = 0;
    for (; other < end && other->low[0] <= box->high[0]; other++)
        found += (uint64_t) meet_across(box, other);
    return found;
}

uint64_t sweep_pairs(const struct mesh *a, const struct mesh *b)
{
    struct box *of_a = sorted(a), *of_b = sorted(b);
    const struct box *x = of_a, *y = of_b;
    const struct box *const end_a = of_a + a->face_count, *const end_b = of_b + b->face_count;
    uint64_t found = 0;
    while (x < end_a && y < end_b)
        if (x->low[0] <= y->low[0])
            found += count_from(x++, y, end_b);
        else
            found += count_from(y++, x, end_a);
    free(of_a);
    free(of_b);
    return found;
}
