/* Vertices placed exactly, then rounded: for pairs whose positions cancel, or whose numbers are too
 * large or too small for doubles.
 *
 * Method. Each vertex is placed in integers (support_integers.h). Lengths are divided by a power of
 * two, such that the largest coordinate, or displacement over the window, is near 1: a first pass
 * measures it, a second one rounds.
 *
 * Accuracy, with u = 2^-53: each coordinate is rounded down, so that it is off by 2 u of itself,
 * and a vertex by 2 u of its length. */
#include "support_gap.h"

#include "integer.h"
#include "memory.h"

#include <limits.h>
#include <math.h>
#include <string.h>

static const long no_exponent = LONG_MIN / 2;

/* Returns x / scale in units of 2^exponent, or 0 while that is measured. */
static double rounded(struct support_placed *placed, const mpz_t x)
{
    const struct support_integers *integers = &placed->integers;
    if (!placed->measures)
        return integer_ratio_round(x, integers->scale, integers->unit - placed->exponent,
                                   ROUND_DOWN, placed->scratch);
    const long exponent =
        integers->unit + (long) mpz_sizeinbase(x, 2) - (long) mpz_sizeinbase(integers->scale, 2);
    if (mpz_sgn(x) != 0 && exponent > placed->exponent)
        placed->exponent = exponent;
    return 0;
}

static void place_vertex(struct support_placed *placed, int f, unsigned i)
{
    const size_t stride = placed->pair.view[f].vertices.stride;
    support_integers_place(&placed->integers, f, i, placed->at);
    for (int axis = 0; axis < placed->pair.dim; axis++)
        placed->memory[f][(size_t) axis * stride + i] = rounded(placed, placed->at[axis]);
}

static void place_path(struct support_placed *placed)
{
    for (int axis = 0; axis < placed->pair.dim; axis++) {
        for (int f = 0; f < 2; f++)
            placed->pair.path[f][axis] =
                rounded(placed, placed->integers.side[f].displacement[axis]);
        placed->pair.drift[axis] = rounded(placed, placed->integers.drift[axis]);
    }
}

/* Sets the padding, the middle and the bounds of a view. Returns its largest coordinate. */
static double complete(struct support_view *view, double *at)
{
    const struct support_vertices *vertices = &view->vertices;
    double largest = 0, square = 0;
    for (int axis = 0; axis < vertices->dim; axis++) {
        double *x = at + (size_t) axis * vertices->stride, most = 0, sum = 0;
        for (unsigned k = 0; k < vertices->count; k++) {
            most = fmax(most, fabs(x[k]));
            sum += x[k];
        }
        for (unsigned k = vertices->count; k < vertices->stride; k++)
            x[k] = x[0];
        view->centre[axis] = sum / vertices->count;
        largest = fmax(largest, most);
        square += most * most;
    }
    view->reach = sqrt(square) * (1 + 0x1p-40);
    view->slack = 0x1p-51 * view->reach;
    return largest;
}

static size_t bytes_of(const struct support_vertices *vertices)
{
    return (size_t) vertices->stride * FMB_DIM_MAX * sizeof(double);
}

static void numbers_each(struct support_placed *placed, void (*call)(mpz_ptr))
{
    support_integers_each(&placed->integers, call);
    INTEGER_EACH_FROM(at, placed, call);
}

void support_placed_begin(const struct support_pair *pair, struct support_placed *out)
{
    memset(out, 0, sizeof *out);
    out->measures = true;
    out->exponent = no_exponent;
    out->pair.frames = pair->frames;
    out->pair.dim = pair->dim;
    out->pair.drifts = pair->drifts;
    for (int f = 0; f < 2; f++) {
        struct support_view *view = &out->pair.view[f];
        view->placed = pair->view[f].placed;
        view->vertices = pair->view[f].vertices;
        out->memory[f] = memory_allocate(bytes_of(&view->vertices));
        view->vertices.at = out->memory[f];
        view->rotation.dim = pair->dim;
        rotation_set_planar(1, 0, true, &view->rotation);
    }
    numbers_each(out, mpz_init);
    support_integers_set(pair->frames, pair->posed, pair->at, &out->integers);
}

static void set_pair(struct support_placed *placed)
{
    double reach = 0, error = 0x1p-1000;
    for (int f = 0; f < 2; f++) {
        struct support_view *view = &placed->pair.view[f];
        placed->least = fmax(placed->least, complete(view, placed->memory[f]));
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            placed->least = fmax(placed->least, 0.5 * fabs(placed->pair.path[f][axis]));
        reach += view->reach;
        error += view->slack;
    }
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        reach += fabs(placed->pair.drift[axis]);
    placed->pair.reach = reach;
    placed->pair.error = 32 * 0x1p-53 * reach + error;
    placed->pair.usable = true;
}

bool support_placed_step(struct support_placed *placed, int count)
{
    const unsigned of_a = placed->pair.view[0].vertices.count;
    const unsigned all = of_a + placed->pair.view[1].vertices.count;
    for (; count > 0 && placed->next < all; count--, placed->next++)
        place_vertex(placed, placed->next >= of_a,
                     placed->next < of_a ? placed->next : placed->next - of_a);
    if (placed->next < all)
        return false;
    place_path(placed);
    if (!placed->measures) {
        set_pair(placed);
        return true;
    }
    placed->measures = false;
    placed->next = 0;
    if (placed->exponent == no_exponent) /* all is 0 */
        placed->exponent = 0;
    return false;
}

void support_placed_end(struct support_placed *placed)
{
    for (int f = 0; f < 2; f++)
        memory_release(placed->memory[f], bytes_of(&placed->pair.view[f].vertices));
    numbers_each(placed, mpz_clear);
}
