/* Writes certificates of pairs with a hull. A direction in doubles proves most separated pairs;
 * hull_exact.c proves the others, in steps. */
#include "certificate_hull.h"

#include "hull_search.h"
#include "integer.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>

/* ---- Text ---- */

void certificate_write_vector(struct certificate_writer *writer, int dim, mpq_t v[3])
{
    for (int axis = 0; axis < dim; axis++) {
        certificate_write_text(writer, axis == 0 ? " (" : " ");
        certificate_write_number(writer, v[axis]);
    }
    certificate_write_text(writer, ")");
}

static void write_normal(struct certificate_writer *writer, int dim, mpz_t n[3])
{
    mpq_t normal[3];
    mpz_t divisor;
    mpq_inits(normal[0], normal[1], normal[2], NULL);
    mpz_init(divisor);
    mpz_gcd(divisor, n[0], n[1]);
    mpz_gcd(divisor, divisor, n[2]);
    for (int axis = 0; axis < dim; axis++)
        mpz_divexact(mpq_numref(normal[axis]), n[axis], divisor);
    certificate_write_text(writer, " normal");
    certificate_write_vector(writer, dim, normal);
    mpq_clears(normal[0], normal[1], normal[2], NULL);
    mpz_clear(divisor);
}

/* Sets *vertex to the first vertex of frame f, from *vertex on, that has a positive weight, and out
 * to its weight / total, not reduced. Returns false if there is none. */
static bool next_vertex(const struct hull_proof *proof, int f, unsigned *vertex, mpq_t out)
{
    unsigned next = UINT_MAX;
    for (unsigned c = 0; c < proof->count; c++) {
        const unsigned v = proof->column[c].vertex[f];
        if (v >= *vertex && v < next && mpz_sgn(proof->weight[c]) > 0)
            next = v;
    }
    mpq_set_ui(out, 0, 1);
    for (unsigned c = 0; c < proof->count; c++)
        if (proof->column[c].vertex[f] == next)
            mpz_add(mpq_numref(out), mpq_numref(out), proof->weight[c]);
    mpz_set(mpq_denref(out), proof->total);
    *vertex = next;
    return next != UINT_MAX;
}

/* out := the time of the proof as a fraction of the window, not reduced. */
static void set_late(const struct hull_proof *proof, mpq_t out)
{
    mpq_set_ui(out, 0, 1);
    for (unsigned c = 0; c < proof->count; c++)
        if (proof->column[c].end)
            mpz_add(mpq_numref(out), mpq_numref(out), proof->weight[c]);
    mpz_set(mpq_denref(out), proof->total);
}

static void write_time(struct certificate_writer *writer, const struct hull_proof *proof,
                       double duration)
{
    mpq_t late, window;
    mpq_inits(late, window, NULL);
    set_late(proof, late);
    mpq_canonicalize(late);
    mpq_set_d(window, duration);
    mpq_mul(late, late, window);
    certificate_write_text(writer, " at ");
    certificate_write_number(writer, late);
    mpq_clears(late, window, NULL);
}

/* The point is that of the first frame, at its time. */
static void write_point(struct certificate_writer *writer, const struct hull_proof *proof, int dim)
{
    const struct hull_integers *integers = proof->integers;
    mpq_t weight, point[3];
    mpz_t at[3], sum[3], total;
    mpq_inits(weight, point[0], point[1], point[2], NULL);
    mpz_inits(at[0], at[1], at[2], sum[0], sum[1], sum[2], total, NULL);
    set_late(proof, weight);
    for (int axis = 0; axis < dim; axis++)
        mpz_mul(sum[axis], mpq_numref(weight), integers->side[0].displacement[axis]);
    for (unsigned v = 0; next_vertex(proof, 0, &v, weight); v++) {
        hull_integers_place(integers, 0, v, at);
        for (int axis = 0; axis < dim; axis++)
            mpz_addmul(sum[axis], mpq_numref(weight), at[axis]);
    }
    mpz_mul(total, proof->total, integers->scale);
    for (int axis = 0; axis < dim; axis++)
        certificate_set_scaled(point[axis], sum[axis], total, integers->unit);
    certificate_write_vector(writer, dim, point);
    mpq_clears(weight, point[0], point[1], point[2], NULL);
    mpz_clears(at[0], at[1], at[2], sum[0], sum[1], sum[2], total, NULL);
}

static void write_weights(struct certificate_writer *writer, const struct hull_proof *proof, int f)
{
    mpq_t weight;
    char text[16];
    mpq_init(weight);
    certificate_write_text(writer, f ? " b" : " a");
    for (unsigned v = 0; next_vertex(proof, f, &v, weight); v++) {
        mpq_canonicalize(weight);
        snprintf(text, sizeof text, " %u:", v);
        certificate_write_text(writer, text);
        certificate_write_number(writer, weight);
    }
    mpq_clear(weight);
}

/* ---- Separated by doubles ---- */

/* Writes a normal of few bits, near the direction of the point of D nearest to the origin, if its
 * values in doubles prove that the frames are separated. Returns whether they do. */
static bool write_separated(struct certificate_writer *writer, const struct hull_pair *pair,
                            const double direction[FMB_DIM_MAX])
{
    for (int bits = 6; bits <= 48; bits *= 2) {
        double outward[FMB_DIM_MAX];
        struct hull_column column;
        mpz_t n[3];
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            outward[axis] = -ldexp(trunc(ldexp(direction[axis], bits)), -bits);
        if (!(hull_support(pair, outward, &column) < -1.01 * pair->error)) /* its length: < 1.01 */
            continue;
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            mpz_init_set_d(n[axis], -ldexp(outward[axis], bits));
        certificate_write_text(writer, fmb_verdict_name(FMB_SEPARATED));
        write_normal(writer, pair->dim, n);
        mpz_clears(n[0], n[1], n[2], NULL);
        return true;
    }
    return false;
}

/* ---- Steps ---- */

static bool is_wide(const struct frame_pair *frames, const struct hull_integers *integers)
{
    const struct dyadic_span span = limbs_span_of(frames);
    return span.top - span.unit + (long) mpz_sizeinbase(integers->scale, 2) > CERTIFICATE_SPAN_MAX;
}

bool certificate_hull_begin(const struct frame_pair *frames, struct certificate_writer *writer,
                            struct certificate_hull *out)
{
    struct hull_nearest nearest = {.simplex = {.count = 0}};
    struct hull_column first[FMB_DIM_MAX + 1];
    enum fmb_verdict verdict = 0;
    out->frames = *frames;
    out->part = CERTIFICATE_DECIDING;
    hull_pair_set(&out->frames, &out->pair);
    if (out->pair.usable)
        verdict = hull_search(&out->pair, INFINITY, &nearest);
    for (unsigned i = 0; i < nearest.simplex.count; i++)
        first[i] = nearest.simplex.vertex[i].column;
    out->exact = hull_exact_begin(&out->pair, FMB_WANT_CERTIFICATE, first, nearest.simplex.count);
    if (is_wide(frames, hull_exact_proof(out->exact)->integers) ||
        (verdict == FMB_SEPARATED && write_separated(writer, &out->pair, nearest.direction)))
        certificate_hull_end(out);
    return !out->exact;
}

bool certificate_hull_step(struct certificate_hull *hull, struct certificate_writer *writer)
{
    struct hull_proof *proof = hull_exact_proof(hull->exact);
    switch (hull->part) {
    case CERTIFICATE_DECIDING:
        if (!hull_exact_step(hull->exact))
            return false;
        certificate_write_text(writer, fmb_verdict_name(proof->verdict));
        if (proof->verdict != FMB_OVERLAPPING)
            write_normal(writer, hull->pair.dim, proof->normal);
        if (proof->verdict == FMB_SEPARATED)
            certificate_hull_end(hull);
        break;
    case CERTIFICATE_POINT:
        write_time(writer, proof, hull->frames.duration);
        write_point(writer, proof, hull->pair.dim);
        break;
    case CERTIFICATE_WEIGHTS_A: write_weights(writer, proof, 0); break;
    case CERTIFICATE_WEIGHTS_B:
        write_weights(writer, proof, 1);
        certificate_hull_end(hull);
        break;
    }
    hull->part++;
    return !hull->exact;
}

void certificate_hull_end(struct certificate_hull *hull)
{
    if (hull->exact)
        hull_exact_end(hull->exact, NULL);
    hull->exact = NULL;
}
