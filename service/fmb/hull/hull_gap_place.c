/* Vertices placed exactly, then rounded: for pairs whose positions cancel, or whose numbers are too
 * large or too small for doubles.
 *
 * Method. Each vertex is placed in integers (hull_vertices.h). Lengths are divided by a power of
 * two, such that the largest coordinate, or displacement over the window, is near 1: a first pass
 * measures it, a second one rounds.
 *
 * Accuracy, with u = 2^-53: each coordinate is rounded down, so that it is off by 2 u of itself,
 * and a vertex by 2 u of its length. */
#include "hull_gap.h"

#include "hull_vertices.h"
#include "integer.h"

#include <limits.h>
#include <math.h>
#include <string.h>

static const long no_exponent = LONG_MIN / 2;

/* Returns x / scale in units of 2^exponent, or 0 while that is measured. */
static double rounded(struct hull_gap_placed *placed, struct exact_pair *exact, const mpz_t x)
{
    if (!placed->measures)
        return integer_ratio_round(x, exact->scale, exact->unit - placed->exponent, ROUND_DOWN,
                                   exact->scratch + 1);
    const long exponent =
        exact->unit + (long) mpz_sizeinbase(x, 2) - (long) mpz_sizeinbase(exact->scale, 2);
    if (mpz_sgn(x) != 0 && exponent > placed->exponent)
        placed->exponent = exponent;
    return 0;
}

static void place_batch(void *context, struct hull_batch *batch)
{
    struct hull_gap_placed *placed = context;
    struct exact_pair *exact = &batch->exact;
    for (int f = 0; f < 2; f++) {
        const size_t stride = placed->pair.view[f].vertices.stride;
        for (unsigned k = 0; k < batch->count[f]; k++) {
            hull_batch_vertex(batch, f, k, placed->at);
            for (int axis = 0; axis < placed->pair.dim; axis++)
                placed->memory[f][(size_t) axis * stride + batch->first[f] + k] =
                    rounded(placed, exact, placed->at[axis]);
        }
    }
    if (batch->first[0] + batch->first[1] > 0)
        return;
    for (int axis = 0; axis < placed->pair.dim; axis++) {
        for (int f = 0; f < 2; f++)
            placed->displacement[f][axis] =
                rounded(placed, exact, exact->frame[f].displacement[axis]);
        placed->pair.drift[axis] = rounded(placed, exact, exact->drift[axis]);
    }
}

/* Sets the padding, the middle and the bounds of a view. Returns its largest coordinate. */
static double complete(struct hull_view *view, double *at)
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
    view->radius = sqrt(square) * (1 + 0x1p-40);
    view->slack = 0x1p-51 * view->radius;
    return largest;
}

static size_t bytes_of(const struct support_vertices *vertices)
{
    return (size_t) vertices->stride * FMB_DIM_MAX * sizeof(double);
}

void hull_gap_place_begin(const struct hull_pair *pair, struct hull_gap_placed *out)
{
    void *(*allocate)(size_t);
    memset(out, 0, sizeof *out);
    mp_get_memory_functions(&allocate, NULL, NULL);
    out->measures = true;
    out->exponent = no_exponent;
    out->pair.frames = pair->frames;
    out->pair.dim = pair->dim;
    out->pair.drifts = pair->drifts;
    for (int f = 0; f < 2; f++) {
        struct hull_view *view = &out->pair.view[f];
        view->placed = pair->view[f].placed;
        view->vertices = pair->view[f].vertices;
        out->memory[f] = allocate(bytes_of(&view->vertices));
        view->vertices.at = out->memory[f];
        view->rotation.dim = pair->dim;
        rotation_set_planar(1, 0, true, &view->rotation);
    }
    mpz_inits(out->at[0], out->at[1], out->at[2], NULL);
}

static void set_pair(struct hull_gap_placed *placed)
{
    double reach = 0, error = 0x1p-1000;
    for (int f = 0; f < 2; f++) {
        struct hull_view *view = &placed->pair.view[f];
        placed->least = fmax(placed->least, complete(view, placed->memory[f]));
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            placed->least = fmax(placed->least, 0.5 * fabs(placed->displacement[f][axis]));
        reach += view->radius;
        error += view->slack;
    }
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        reach += fabs(placed->pair.drift[axis]);
    placed->pair.reach = reach;
    placed->pair.error = 32 * 0x1p-53 * reach + error;
}

bool hull_gap_place_step(struct hull_gap_placed *placed, int count)
{
    for (; count > 0; count--) {
        if (hull_vertices_visit(placed->pair.frames, placed->next++, place_batch, placed))
            continue;
        if (!placed->measures) {
            set_pair(placed);
            return true;
        }
        placed->measures = false;
        placed->next = 0;
        if (placed->exponent == no_exponent) /* all is 0 */
            placed->exponent = 0;
    }
    return false;
}

void hull_gap_place_end(struct hull_gap_placed *placed)
{
    void (*release)(void *, size_t);
    mp_get_memory_functions(NULL, NULL, &release);
    for (int f = 0; f < 2; f++)
        release(placed->memory[f], bytes_of(&placed->pair.view[f].vertices));
    mpz_clears(placed->at[0], placed->at[1], placed->at[2], NULL);
}
