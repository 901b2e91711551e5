/* Checks certificates of pairs with a hull, by the definitions of fmb.h. A frame is the convex hull
 * of its vertices, in body coordinates: v_0, v_1, ...
 *
 * A normal N. As in certificate_check.c, N . (b - a) has its least value at vertices and at an end
 * of the window. N . R v is (R^T N) . v, and R^T is the rotation of the conjugate quaternion.
 *
 * A point p. With positive weights that sum to 1 and sum_i w_i v_i = p, less position and t v, it
 * is in the frame. It is in the relative interior of the hull of the named vertices (Rockafellar,
 * Convex Analysis, theorem 6.9), which is part of that of the frame if both have the same affine
 * hull. */
#include "certificate_check.h"

#include <string.h>

/* A linearly independent set of vectors in echelon form. */
struct span {
    int rank;
    mpq_t vector[AXES][AXES];
    int pivot[AXES];
};

struct hull_side {
    const struct fmb_placement *placement;
    const struct fmb_frame *frame;
    unsigned count;  /* of vertices */
    mpq_t low, high; /* of the normal over the frame at time 0 */
    mpq_t sum[AXES]; /* of the weighted vertices, body coordinates */
    mpq_t total;     /* of the weights */
    struct span all, named;
};

struct hull_proof {
    int dim;
    struct hull_side side[2];
    mpq_t duration, time, normal[AXES], point[AXES];
    mpq_t vertex[AXES], first[AXES], number, weight, gap;
};

static void span_each(struct span *span, void (*call)(mpq_ptr))
{
    for (int i = 0; i < AXES; i++)
        check_each_axis(span->vector[i], call);
}

static void proof_each(struct hull_proof *proof, void (*call)(mpq_ptr))
{
    for (int f = 0; f < 2; f++) {
        struct hull_side *side = &proof->side[f];
        call(side->low);
        call(side->high);
        call(side->total);
        check_each_axis(side->sum, call);
        span_each(&side->all, call);
        span_each(&side->named, call);
    }
    check_each_axis(proof->normal, call);
    check_each_axis(proof->point, call);
    check_each_axis(proof->vertex, call);
    check_each_axis(proof->first, call);
    call(proof->duration);
    call(proof->time);
    call(proof->number);
    call(proof->weight);
    call(proof->gap);
}

/* ---- Vertices ---- */

static unsigned vertex_count(const struct fmb_frame *frame)
{
    switch (frame->shape) {
    case FMB_HULL: return frame->vertex_count;
    case FMB_TETRAHEDRON:
    case FMB_FACE: return (unsigned) frame->count + 1;
    default: return 1U << frame->count;
    }
}

/* Adds component i, and the box's half of it with the other sign if half is true. */
static void add_component(struct hull_proof *proof, const struct fmb_frame *frame, int i, bool half)
{
    for (int axis = 0; axis < frame->dim; axis++) {
        mpq_set_d(proof->number, frame->component[i][axis]);
        if (half) {
            mpq_div_2exp(proof->number, proof->number, 1);
            mpq_neg(proof->number, proof->number);
        }
        mpq_add(proof->vertex[axis], proof->vertex[axis], proof->number);
        mpq_set_d(proof->number, frame->remainder[i][axis]);
        if (!half)
            mpq_add(proof->vertex[axis], proof->vertex[axis], proof->number);
    }
}

/* proof->vertex := vertex k of the frame, in body coordinates, numbered as fmb.h says. */
static void set_vertex(struct hull_proof *proof, const struct fmb_frame *frame, unsigned k)
{
    const bool box = frame->shape == FMB_BOX;
    const bool simplex = frame->shape == FMB_TETRAHEDRON || frame->shape == FMB_FACE;
    for (int axis = 0; axis < frame->dim; axis++)
        mpq_set_d(proof->vertex[axis],
                  frame->shape == FMB_HULL
                      ? frame->vertices[(size_t) axis * frame->vertex_stride + k]
                  : box ? frame->centre[axis]
                        : frame->origin[axis]);
    for (int i = 0; frame->shape != FMB_HULL && i < frame->count; i++) {
        if (box)
            add_component(proof, frame, i, true);
        if (simplex ? k == (unsigned) i + 1 : k >> i & 1)
            add_component(proof, frame, i, false);
    }
}

/* ---- Affine hulls ---- */

/* Adds a vector, or nothing if it depends on those that there are. It is overwritten. */
static void span_add(struct span *span, mpq_t v[AXES], mpq_t factor)
{
    int pivot = 0;
    for (int i = 0; i < span->rank; i++) {
        mpq_div(factor, v[span->pivot[i]], span->vector[i][span->pivot[i]]);
        mpq_neg(factor, factor);
        check_add_multiple(v, factor, span->vector[i], AXES);
    }
    while (pivot < AXES && mpq_sgn(v[pivot]) == 0)
        pivot++;
    if (pivot == AXES)
        return;
    check_copy(span->vector[span->rank], v);
    span->pivot[span->rank++] = pivot;
}

/* Sets the directions of the affine hull of all vertices. */
static void set_span(struct hull_proof *proof, struct hull_side *side)
{
    set_vertex(proof, side->frame, 0);
    check_copy(proof->first, proof->vertex);
    for (unsigned k = 1; k < side->count && side->all.rank < proof->dim; k++) {
        set_vertex(proof, side->frame, k);
        check_subtract(proof->vertex, proof->vertex, proof->first);
        span_add(&side->all, proof->vertex, proof->number);
    }
}

/* ---- The normal ---- */

/* Sets the least and the greatest value over the frame at time 0. */
static void set_range(struct hull_proof *proof, struct hull_side *side)
{
    struct fmb_placement conjugate = *side->placement;
    mpq_t normal[AXES], value;
    mpq_init(value);
    check_each_axis(normal, mpq_init);
    check_copy(normal, proof->normal);
    for (int i = 1; i < conjugate.orientation_count; i++)
        conjugate.orientation[i] = -conjugate.orientation[i];
    if (conjugate.orientation_count > 0)
        check_turn(&conjugate, normal);
    for (unsigned k = 0; k < side->count; k++) {
        set_vertex(proof, side->frame, k);
        check_dot(value, normal, proof->vertex);
        if (k == 0 || mpq_cmp(value, side->low) < 0)
            mpq_set(side->low, value);
        if (k == 0 || mpq_cmp(value, side->high) > 0)
            mpq_set(side->high, value);
    }
    check_set(proof->vertex, proof->dim, side->placement->position);
    check_dot(value, proof->normal, proof->vertex);
    mpq_add(side->low, side->low, value);
    mpq_add(side->high, side->high, value);
    check_each_axis(normal, mpq_clear);
    mpq_clear(value);
}

static const char *flaw_of_normal(struct hull_proof *proof, enum fmb_verdict verdict)
{
    struct hull_side *a = &proof->side[0], *b = &proof->side[1];
    set_range(proof, a);
    set_range(proof, b);
    check_set(proof->vertex, proof->dim, b->placement->velocity);
    check_set(proof->first, proof->dim, a->placement->velocity);
    check_subtract(proof->vertex, proof->vertex, proof->first);
    check_dot(proof->number, proof->normal, proof->vertex);
    mpq_mul(proof->number, proof->number, proof->duration);
    mpq_sub(proof->gap, b->low, a->high);
    if (mpq_sgn(proof->number) < 0)
        mpq_add(proof->gap, proof->gap, proof->number);
    const int sign = mpq_sgn(proof->gap);
    if (verdict == FMB_SEPARATED)
        return sign > 0 ? NULL : "the normal does not hold the frames apart all the time";
    if (sign < 0)
        return "the normal does not keep the frames on its two sides all the time";
    return mpq_equal(a->low, a->high) && mpq_equal(b->low, b->high)
               ? "the normal is constant on both frames"
               : NULL;
}

/* ---- The point ---- */

/* Takes " LETTER INDEX:WEIGHT INDEX:WEIGHT ...", indices ascending, weights positive. */
static const char *take_weights(const char **at, struct hull_proof *proof, const char *letter,
                                struct hull_side *side)
{
    unsigned next = 0;
    mpz_t index;
    mpz_init(index);
    bool good = check_take(at, letter);
    while (good && **at == ' ' && check_is_digit((*at)[1])) {
        ++*at;
        good = check_take_digits(at, index) && mpz_cmp_ui(index, next) >= 0 &&
               mpz_cmp_ui(index, side->count) < 0 && check_take(at, ":") &&
               check_take_number(at, proof->weight) && mpq_sgn(proof->weight) > 0;
        if (!good)
            break;
        set_vertex(proof, side->frame, (unsigned) mpz_get_ui(index));
        mpq_add(side->total, side->total, proof->weight);
        check_add_multiple(side->sum, proof->weight, proof->vertex, AXES);
        if (next == 0)
            check_copy(proof->first, proof->vertex);
        check_subtract(proof->vertex, proof->vertex, proof->first);
        span_add(&side->named, proof->vertex, proof->number);
        next = (unsigned) mpz_get_ui(index) + 1;
    }
    mpz_clear(index);
    return good ? NULL : "the point is not followed by weights of vertices of both frames";
}

/* Whether the weighted vertices of the frame are the point at the time. */
static bool has_point(struct hull_proof *proof, struct hull_side *side)
{
    const struct fmb_placement *placement = side->placement;
    if (placement->orientation_count > 0)
        check_turn(placement, side->sum);
    for (int axis = 0; axis < proof->dim; axis++) {
        mpq_set_d(proof->number, placement->velocity[axis]);
        mpq_mul(proof->number, proof->number, proof->time);
        mpq_add(side->sum[axis], side->sum[axis], proof->number);
        mpq_set_d(proof->number, placement->position[axis]);
        mpq_add(side->sum[axis], side->sum[axis], proof->number);
        if (!mpq_equal(side->sum[axis], proof->point[axis]))
            return false;
    }
    return true;
}

static bool moves(const struct hull_proof *proof)
{
    for (int f = 0; f < 2; f++)
        for (int axis = 0; axis < proof->dim; axis++)
            if (proof->side[f].placement->velocity[axis] != 0)
                return true;
    return false;
}

static const char *flaw_of_point(struct hull_proof *proof, enum fmb_verdict verdict)
{
    static const char *const of_place[2] = {
        "the point is not that of the weights in the first frame",
        "the point is not that of the weights in the second frame"};
    static const char *const of_span[2] = {"the named vertices do not span the first frame",
                                           "the named vertices do not span the second frame"};
    if (mpq_sgn(proof->time) < 0 || mpq_cmp(proof->time, proof->duration) > 0)
        return "the time is not in the window";
    if (!moves(proof) && mpq_sgn(proof->time) != 0)
        return "the time of a static pair is not 0";
    for (int f = 0; f < 2; f++) {
        struct hull_side *side = &proof->side[f];
        if (mpq_cmp_ui(side->total, 1, 1) != 0)
            return "the weights do not sum to 1";
        if (!has_point(proof, side))
            return of_place[f];
        set_span(proof, side);
        if (verdict == FMB_OVERLAPPING && side->named.rank < side->all.rank)
            return of_span[f];
    }
    return NULL;
}

/* ---- The text ---- */

static const char *flaw_of(struct hull_proof *proof, enum fmb_verdict verdict, const char *text)
{
    const char *at = text, *name = fmb_verdict_name(verdict), *flaw = NULL;
    if (!name || !check_take(&at, name))
        return "the text does not begin with the verdict";
    if (verdict != FMB_OVERLAPPING) {
        if (!check_take(&at, " normal") || !check_take_point(&at, proof->dim, proof->normal))
            return "the verdict is not followed by a normal of this dimension in lowest terms";
        flaw = flaw_of_normal(proof, verdict);
    }
    if (!flaw && verdict != FMB_SEPARATED) {
        if (!check_take(&at, " at ") || !check_take_number(&at, proof->time))
            return "there is no time in lowest terms where it is due";
        if (!check_take_point(&at, proof->dim, proof->point))
            return "the time is not followed by a point of this dimension in lowest terms";
        flaw = take_weights(&at, proof, " a", &proof->side[0]);
        if (!flaw)
            flaw = take_weights(&at, proof, " b", &proof->side[1]);
        if (!flaw)
            flaw = flaw_of_point(proof, verdict);
    }
    return flaw || *at == '\0' ? flaw : "something follows the certificate";
}

const char *check_hulls(const struct fmb_placement *a, const struct fmb_placement *b,
                        double duration, enum fmb_verdict verdict, const char *text)
{
    struct hull_proof proof;
    memset(&proof, 0, sizeof proof);
    proof_each(&proof, mpq_init);
    proof.dim = a->body->dim;
    mpq_set_d(proof.duration, duration);
    for (int f = 0; f < 2; f++) {
        struct hull_side *side = &proof.side[f];
        side->placement = f ? b : a;
        side->frame = fmb_body_frame(side->placement->body, 0);
        side->count = vertex_count(side->frame);
    }
    const char *flaw = flaw_of(&proof, verdict, text);
    proof_each(&proof, mpq_clear);
    return flaw;
}
