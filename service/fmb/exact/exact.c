#include "exact.h"

#include "integer.h"

#include <string.h>

long exact_pair_unit(const struct frame_pair *pair)
{
    const struct placed_frame *placed[2] = {&pair->a, &pair->b};
    long unit = INTEGER_NO_EXPONENT;
    for (int f = 0; f < 2; f++) {
        const struct fmb_frame *frame = placed[f]->frame;
        const struct fmb_placement *placement = placed[f]->placement;
        const int dim = frame->dim;
        long lengths = INTEGER_NO_EXPONENT;
        for (int i = 0; i < frame->count; i++) {
            lengths = integer_vector_unit(lengths, frame->component[i], dim);
            lengths = integer_vector_unit(lengths, frame->remainder[i], dim);
        }
        if (frame->shape == FMB_HULL)
            lengths = frame->bits[0];
        if (frame->shape == FMB_BOX) { /* halves of sizes */
            lengths -= lengths < INTEGER_NO_EXPONENT;
            lengths = integer_vector_unit(lengths, frame->centre, dim);
        } else {
            lengths = integer_vector_unit(lengths, frame->origin, dim);
        }
        unit = integer_lower_unit(unit, lengths);
        unit = integer_vector_unit(unit, placement->position, dim);
        const long speed = integer_vector_unit(INTEGER_NO_EXPONENT, placement->velocity, dim);
        if (speed < INTEGER_NO_EXPONENT)
            unit = integer_lower_unit(unit, speed + dyadic_of(pair->duration).exponent);
    }
    return unit;
}

/* Sets the directions of the edges of frame f of a pair. */
static void set_edges(struct exact_frame *frame, int f)
{
    const int first = f * EXACT_OF_B;
    for (int i = 0; i < frame->count; i++)
        frame->edge[i] = (struct exact_edge){first + i, -1, frame->component[i]};
    frame->edges = frame->count;
    if (!frame->simplex)
        return;
    for (int i = 0; i < frame->count; i++) {
        for (int j = i + 1; j < frame->count; j++) {
            mpz_t *difference = frame->difference[frame->edges - frame->count];
            for (int axis = 0; axis < 3; axis++)
                mpz_sub(difference[axis], frame->component[j][axis], frame->component[i][axis]);
            frame->edge[frame->edges++] = (struct exact_edge){first + j, first + i, difference};
        }
    }
}

void exact_pair_complete(struct exact_pair *pair)
{
    struct exact_frame *a = &pair->frame[0], *b = &pair->frame[1];
    set_edges(a, 0);
    set_edges(b, 1);
    for (int axis = 0; axis < 3; axis++) {
        mpz_sub(pair->offset[axis], b->origin[axis], a->origin[axis]);
        mpz_sub(pair->drift[axis], b->displacement[axis], a->displacement[axis]);
    }
}

/* ---- Orientations ----
 *
 * For a quaternion q of integers, n R(q) is a matrix of integers, n = |q|^2. All lengths of a pair
 * are multiplied by scale: n_a n_b, or n_a if n_a = n_b. This changes no sign, no time and no
 * direction. Points are divided by scale at the end. */

void exact_turn_each(struct exact_turn *turn, void (*call)(mpz_ptr))
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            call(turn->row[i][j]);
    call(turn->norm);
}

/* q := the smallest integers proportional to the orientation. divisor is overwritten. */
static void set_quaternion(const struct fmb_placement *placement, mpz_t q[4], mpz_t divisor)
{
    const int count = placement->orientation_count;
    const long unit = integer_vector_unit(INTEGER_NO_EXPONENT, placement->orientation, count);
    mpz_set_ui(divisor, 0);
    for (int i = 0; i < count; i++) {
        const int at = count == 2 && i == 1 ? 3 : i;
        integer_set(q[at], dyadic_of(placement->orientation[i]), unit);
        mpz_gcd(divisor, divisor, q[at]);
    }
    for (int i = 0; i < 4; i++)
        mpz_divexact(q[i], q[i], divisor);
}

void exact_turn_set(const struct fmb_placement *placement, struct exact_turn *turn)
{
    turn->turned = placement->orientation_count != 0;
    mpz_set_ui(turn->norm, 1);
    if (!turn->turned)
        return;
    mpz_t q[4], product;
    mpz_inits(q[0], q[1], q[2], q[3], product, NULL);
    set_quaternion(placement, q, product);
    mpz_set_ui(turn->norm, 0);
    for (int k = 0; k < 4; k++) {
        mpz_mul(product, q[k], q[k]);
        mpz_add(turn->norm, turn->norm, product);
        for (int i = 0; i < 3; i++) { /* ww is added; v_k v_k in row k too, else subtracted */
            if (k == 0 || k == 1 + i)
                mpz_add(turn->row[i][i], turn->row[i][i], product);
            else
                mpz_sub(turn->row[i][i], turn->row[i][i], product);
        }
    }
    for (int i = 0; i < 3; i++) { /* 2 (v_i v_j - w v_k) and 2 (v_i v_j + w v_k), i, j, k cyclic */
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        mpz_mul(product, q[1 + i], q[1 + j]);
        mpz_mul_2exp(turn->row[i][j], product, 1);
        mpz_set(turn->row[j][i], turn->row[i][j]);
        mpz_mul(product, q[0], q[1 + k]);
        mpz_submul_ui(turn->row[i][j], product, 2);
        mpz_addmul_ui(turn->row[j][i], product, 2);
    }
    mpz_clears(q[0], q[1], q[2], q[3], product, NULL);
}

void exact_turn_vector(const struct exact_turn *turn, const mpz_t factor, mpz_t v[3])
{
    if (turn->turned) {
        mpz_t out[3];
        mpz_inits(out[0], out[1], out[2], NULL);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                mpz_addmul(out[i], turn->row[i][j], v[j]);
        for (int i = 0; i < 3; i++)
            mpz_swap(v[i], out[i]);
        mpz_clears(out[0], out[1], out[2], NULL);
    }
    if (mpz_cmp_ui(factor, 1) != 0)
        for (int i = 0; i < 3; i++)
            mpz_mul(v[i], v[i], factor);
}

/* ---- Frames ---- */

/* Adds the remainders to the components. */
static void add_remainders(struct exact_frame *out, const struct fmb_frame *frame, long unit)
{
    mpz_t remainder;
    mpz_init(remainder);
    for (int i = 0; i < frame->count; i++)
        for (int axis = 0; axis < frame->dim; axis++) {
            integer_set(remainder, dyadic_of(frame->remainder[i][axis]), unit);
            mpz_add(out->component[i][axis], out->component[i][axis], remainder);
        }
    mpz_clear(remainder);
}

void exact_frame_set(struct exact_frame *out, const struct fmb_frame *frame, long unit)
{
    out->count = frame->count;
    out->simplex = frame_is_simplex(frame);
    for (int axis = 0; axis < frame->dim; axis++) {
        for (int i = 0; i < frame->count; i++)
            integer_set(out->component[i][axis], dyadic_of(frame->component[i][axis]), unit);
        if (frame->shape != FMB_BOX) {
            integer_set(out->origin[axis], dyadic_of(frame->origin[axis]), unit);
            continue;
        }
        integer_set(out->displacement[axis], dyadic_of(frame->centre[axis]), unit);
        mpz_fdiv_q_2exp(out->origin[axis], out->component[axis][axis], 1); /* exact: it is even */
        mpz_sub(out->origin[axis], out->displacement[axis], out->origin[axis]);
    }
    if (frame->rounded)
        add_remainders(out, frame, unit);
}

/* Transforms a frame from body to world coordinates. Rotated vectors, which contain the norm of
 * their rotation, are multiplied by factor; all others by scale. */
static void place_frame(struct exact_frame *out, const struct placed_frame *placed, double duration,
                        long unit, const struct exact_turn *turn, const mpz_t factor,
                        const mpz_t scale)
{
    const struct fmb_placement *placement = placed->placement;
    const struct dyadic window = dyadic_of(duration);
    mpz_t position;
    mpz_init(position);
    for (int i = 0; i < out->count; i++)
        exact_turn_vector(turn, factor, out->component[i]);
    exact_turn_vector(turn, factor, out->origin);
    for (int axis = 0; axis < placed->frame->dim; axis++) {
        integer_set(position, dyadic_of(placement->position[axis]), unit);
        mpz_addmul(out->origin[axis], position, scale);
        integer_set_product(out->displacement[axis], dyadic_of(placement->velocity[axis]), window,
                            unit);
        mpz_mul(out->displacement[axis], out->displacement[axis], scale);
    }
    mpz_clear(position);
}

static void set_frames(struct exact_pair *out, const struct frame_pair *pair)
{
    const struct placed_frame *placed[2] = {&pair->a, &pair->b};
    struct exact_turn turn[2];
    mpz_t one;
    mpz_init_set_ui(one, 1);
    for (int f = 0; f < 2; f++) {
        exact_turn_each(&turn[f], mpz_init);
        exact_turn_set(placed[f]->placement, &turn[f]);
        exact_frame_set(&out->frame[f], placed[f]->frame, out->unit);
    }
    const bool same = mpz_cmp(turn[0].norm, turn[1].norm) == 0;
    mpz_set(out->scale, turn[0].norm);
    if (!same)
        mpz_mul(out->scale, out->scale, turn[1].norm);
    for (int f = 0; f < 2; f++)
        place_frame(&out->frame[f], placed[f], pair->duration, out->unit, &turn[f],
                    same ? one : turn[!f].norm, out->scale);
    for (int f = 0; f < 2; f++)
        exact_turn_each(&turn[f], mpz_clear);
    mpz_clear(one);
}

void exact_frame_each(struct exact_frame *frame, void (*call)(mpz_ptr))
{
    for (int axis = 0; axis < 3; axis++) {
        call(frame->origin[axis]);
        call(frame->displacement[axis]);
        for (int i = 0; i < 3; i++) {
            call(frame->component[i][axis]);
            call(frame->difference[i][axis]);
        }
    }
}

/* Calls one of mpz_init and mpz_clear for every number of a pair. */
static void pair_each(struct exact_pair *pair, void (*call)(mpz_ptr))
{
    for (int f = 0; f < 2; f++)
        exact_frame_each(&pair->frame[f], call);
    for (int axis = 0; axis < 3; axis++) {
        call(pair->offset[axis]);
        call(pair->drift[axis]);
    }
    call(pair->scale);
    for (int t = 0; t < EXACT_TRIPLES; t++)
        call(pair->triple[t]);
    for (int i = 0; i < EXACT_SCRATCH; i++)
        call(pair->scratch[i]);
}

/* ---- Products ----
 *
 * On each axis, a vector of a pair that is not rotated is a double or the product of two: an
 * integer of one or two limbs that are not zero, followed by zero limbs. Offset and drift are
 * differences of two such numbers, with limbs that are not zero in between; their products are
 * therefore computed as differences of two products. Of the 56 triple products, only those of both
 * offset and drift have wide factors, and these share one wide vector product. */

mpz_t *exact_vector(struct exact_pair *pair, int number)
{
    if (number == EXACT_OFFSET)
        return pair->offset;
    if (number == EXACT_DRIFT)
        return pair->drift;
    return pair->frame[number / EXACT_OF_B].component[number % EXACT_OF_B];
}

void exact_dot(struct exact_pair *pair, mpz_t out, mpz_t normal[3], int k)
{
    struct exact_frame *frame = pair->frame;
    mpz_t *scratch = &pair->scratch[EXACT_SCRATCH - 1];
    if (k < EXACT_OFFSET) {
        integer_dot(out, normal, exact_vector(pair, k), *scratch);
        return;
    }
    mpz_set_ui(out, 0);
    for (int f = 0; f < 2; f++)
        for (int axis = 0; axis < 3; axis++)
            integer_add_product(out, f ? 1 : -1, normal[axis],
                                (k == EXACT_OFFSET ? frame[f].origin : frame[f].displacement)[axis],
                                *scratch);
}

/* Returns the index of (i x j) . k, i < j < k, in the table: the number of triples below k, plus
 * the number of pairs below j, plus i. */
static int triple_at(int i, int j, int k)
{
    return k * (k - 1) * (k - 2) / 6 + j * (j - 1) / 2 + i;
}

/* Computes the triple products. In: all triples are 0; those of zero vectors stay so.
 *
 * mixed: all triples. Otherwise only the vector products of two components of one frame are
 * computed. They give all triples except those of one component of each frame with the offset or
 * the drift, which only slabs of two frames need. */
static void set_triples(struct exact_pair *pair, bool mixed)
{
    bool zero[EXACT_VECTORS];
    mpz_t normal[3];
    mpz_inits(normal[0], normal[1], normal[2], NULL);
    for (int k = 0; k < EXACT_VECTORS; k++)
        zero[k] = integer_is_zero(exact_vector(pair, k));
    for (int j = 1; j < EXACT_OFFSET; j++)
        for (int i = 0; i < j; i++) {
            const bool same = i >= EXACT_OF_B || j < EXACT_OF_B;
            if (zero[i] || zero[j] || !(same || mixed))
                continue;
            integer_cross(normal, exact_vector(pair, i), exact_vector(pair, j), pair->scratch[0]);
            for (int k = i < EXACT_OF_B ? j + 1 : 0; k < EXACT_VECTORS; k++) {
                if (zero[k] || (k >= EXACT_OF_B && k <= j) || (!same && k < EXACT_OFFSET))
                    continue;
                const int at = k < i ? triple_at(k, i, j) : triple_at(i, j, k);
                exact_dot(pair, pair->triple[at], normal, k);
            }
        }
    if (zero[EXACT_OFFSET] || zero[EXACT_DRIFT]) {
        mpz_clears(normal[0], normal[1], normal[2], NULL);
        return;
    }
    /* (offset x drift) . i = (i x offset) . drift */
    integer_cross(normal, pair->offset, pair->drift, pair->scratch[0]);
    for (int i = 0; i < EXACT_OFFSET; i++)
        if (!zero[i])
            exact_dot(pair, pair->triple[triple_at(i, EXACT_OFFSET, EXACT_DRIFT)], normal, i);
    mpz_clears(normal[0], normal[1], normal[2], NULL);
}

/* value[k] += sign (i x j) . k */
static void add_triples(const struct exact_pair *pair, int sign, int i, int j,
                        mpz_t value[EXACT_VECTORS])
{
    if (i == j)
        return;
    const int low = i < j ? i : j, high = i < j ? j : i;
    for (int k = 0; k < EXACT_VECTORS; k++) {
        if (k == i || k == j)
            continue;
        /* Sorting moves k past low, high or both; each transposition changes the sign. */
        const bool between = k > low && k < high;
        const mpz_t *triple = &pair->triple[k < low   ? triple_at(k, low, high)
                                            : between ? triple_at(low, k, high)
                                                      : triple_at(low, high, k)];
        if ((sign > 0) == ((i < j) != between))
            mpz_add(value[k], value[k], *triple);
        else
            mpz_sub(value[k], value[k], *triple);
    }
}

void exact_cross_values(struct exact_pair *pair, const struct exact_edge *u,
                        const struct exact_edge *v, mpz_t value[EXACT_VECTORS])
{
    for (int k = 0; k < EXACT_VECTORS; k++)
        mpz_set_ui(value[k], 0);
    add_triples(pair, 1, u->plus, v->plus, value);
    if (u->minus >= 0)
        add_triples(pair, -1, u->minus, v->plus, value);
    if (v->minus >= 0)
        add_triples(pair, -1, u->plus, v->minus, value);
    if (u->minus >= 0 && v->minus >= 0)
        add_triples(pair, 1, u->minus, v->minus, value);
}

/* The box needs only slabs of single frames; if the pair moves, mixed triples for crossings. */
void exact_pair_init(struct exact_pair *out, const struct frame_pair *pair, bool difference)
{
    pair_each(out, mpz_init);
    out->unit = exact_pair_unit(pair);
    out->moving = pair->duration > 0 && pair_moves(pair);
    set_frames(out, pair);
    exact_pair_complete(out);
    if (pair->a.frame->dim == 3) /* in 2D all vectors lie in one plane */
        set_triples(out, difference || out->moving);
}

void exact_pair_clear(struct exact_pair *pair)
{
    pair_each(pair, mpz_clear);
}

/* ---- Verdict and times ----
 *
 * Bound on the work, for any input. Let a number of the pair, in its unit, have at most W limbs of
 * 64 bits. The unit is at least 2^-2148, the smallest unit of v T, and a coordinate lies below
 * 2^1024, so W <= 50. (A displacement has fewer than 3,172 bits: T is common to all, and if T is
 * large, the unit is at least 2^-1074.) A triple product has 3 W limbs. Without zero limbs, a
 * number of the pair has at most 3.
 *
 * - Triple products: 15 vector products of 6 short products; 50 dot products of at most 6 products
 *   of 3 limbs by 2 W; one vector product of 6 products of W by W limbs. Together 60,000
 *   products of limbs.
 * - The verdict of a solid difference: at most 44 + 12 slabs of 8 values, each a sum of at most 4
 *   triple products, and as many comparisons of these sums: 56 * 8 * 4 * 3 W = 270,000 additions of
 *   limbs.
 * - Times: at most 2 quotients of 53 bits for each slab: 44 * 2 * 2 * 3 W = 26,000.
 * - A flat difference: at most 13 slabs with normals of 2 W limbs, 6 short factors for each value.
 *   For each slab 5 comparisons of quotients, each of two products of at most (3 W)^2 limbs:
 *   13 * 5 * 2 * (3 W)^2 = 3 million, if no leading bits differ. In practice few comparisons are
 *   that close, and the others have normals of W limbs.
 * - The box: see exact_box.c.
 *
 * A pair that is rotated has its lengths times n_a n_b, the squares of quaternions of up to 253
 * bits: W <= 66, and limbs between that are not zero. Triple products are 28 vector products of 6
 * products of W by W limbs, and 56 dot products of 3 products of W by 2 W: 504 W^2 = 2.2 million
 * products of limbs. A point of a box takes 15 products of W by 3 W: 200,000, times the 77 vertices
 * 15 million.
 *
 * A product of limbs takes half a nanosecond. test_engine_work.c counts the products, and searches
 * for the slowest pair: 3 million, rotated 8 million. */

/* Returns tau, in windows, as seconds: an end of a contact (0: first, 1: last), rounded
 * outward. */
static double seconds(const struct ratio *tau, double duration, int end,
                      mpz_t scratch[EXACT_SCRATCH])
{
    struct dyadic window = dyadic_of(duration);
    if (window.mantissa == 0)
        return 0.0;
    mpz_mul_si(scratch[2], tau->num, window.mantissa);
    return integer_ratio_round(scratch[2], tau->den, window.exponent, end ? ROUND_UP : ROUND_DOWN,
                               scratch);
}

/* The path of the offset, the segment offset + tau drift, tau in [0,1], against the slabs. */
struct offset_walk {
    struct exact_pair *pair;
    struct clipped_segment span; /* for a flat difference */
    bool strict;                 /* for a solid one: strictly within all slabs so far */
    double duration, *contact;   /* seconds; contact may be NULL */
    mpz_t f0, f1;                /* normal . offset at tau = 0 and at tau = 1 */
    struct ratio crossing;       /* scratch */
};

static void set_path(struct offset_walk *walk, struct slab *slab)
{
    mpz_set(walk->f0, slab->value[EXACT_OFFSET]);
    mpz_add(walk->f1, slab->value[EXACT_OFFSET], slab->value[EXACT_DRIFT]);
}

/* A slab of a flat difference: clips the path. Returns false if nothing is left of it. */
static bool apply_to_span(void *context, struct slab *slab)
{
    struct offset_walk *walk = context;
    set_path(walk, slab);
    return clipped_segment_apply(&walk->span, walk->f0, walk->f1, slab->low, slab->high,
                                 slab->pins);
}

/* Moves an end of the contact (0: first, 1: last) to the time at which the offset crosses a bound.
 * Rounding is monotonic: the latest of the rounded times is the latest time, rounded. */
static void cross_bound(struct offset_walk *walk, const mpz_t bound, int end)
{
    ratio_cross(&walk->crossing, walk->f0, walk->f1, bound);
    const double time = seconds(&walk->crossing, walk->duration, end, walk->pair->scratch);
    if (end ? time < walk->contact[1] : time > walk->contact[0])
        walk->contact[end] = time;
}

/* A slab of a solid difference, or of the swept one. Along the path, normal . w goes from f0 to f1.
 * If all of the path is beyond a bound, the frames are separated: returns false. If no point of the
 * path is strictly inside a bound, the offset lies on the boundary of the swept difference
 * (slabs.h). */
static bool apply_to_solid(void *context, struct slab *slab)
{
    struct offset_walk *walk = context;
    set_path(walk, slab);
    const int low0 = mpz_cmp(walk->f0, slab->low), low1 = mpz_cmp(walk->f1, slab->low);
    const int high0 = mpz_cmp(walk->f0, slab->high), high1 = mpz_cmp(walk->f1, slab->high);
    if ((low0 < 0 && low1 < 0) || (high0 > 0 && high1 > 0))
        return false;
    if ((low0 <= 0 && low1 <= 0) || (high0 >= 0 && high1 >= 0))
        walk->strict = false;
    if (walk->contact && (low0 < 0 || high0 > 0))
        cross_bound(walk, low0 < 0 ? slab->low : slab->high, 0);
    if (walk->contact && (low1 < 0 || high1 > 0))
        cross_bound(walk, low1 < 0 ? slab->low : slab->high, 1);
    return true;
}

static enum fmb_verdict verdict_of_solid(struct offset_walk *walk)
{
    walk->strict = true;
    if (!slabs_walk(walk->pair, SLABS_OF_DIFFERENCE, apply_to_solid, walk) ||
        !slabs_walk(walk->pair, SLABS_OF_SWEPT, apply_to_solid, walk))
        return FMB_SEPARATED;
    return walk->strict ? FMB_OVERLAPPING : FMB_TOUCHING;
}

static enum fmb_verdict verdict_of_flat(struct offset_walk *walk)
{
    clipped_segment_init(&walk->span);
    enum fmb_verdict verdict = FMB_SEPARATED;
    if (slabs_walk(walk->pair, SLABS_OF_DIFFERENCE, apply_to_span, walk)) {
        verdict = clipped_segment_has_interior(&walk->span) ? FMB_OVERLAPPING : FMB_TOUCHING;
        for (int end = 0; end < 2 && walk->contact; end++)
            walk->contact[end] = seconds(clipped_segment_end(&walk->span, end), walk->duration, end,
                                         walk->pair->scratch);
    }
    clipped_segment_clear(&walk->span);
    return verdict;
}

enum fmb_verdict exact_verdict(struct exact_pair *exact, double duration, double contact[2])
{
    struct offset_walk walk = {.pair = exact, .duration = duration, .contact = contact};
    if (contact) {
        contact[0] = 0;
        contact[1] = duration + 0.0; /* never -0 */
    }
    mpz_inits(walk.f0, walk.f1, NULL);
    ratio_each(&walk.crossing, mpz_init);
    const bool solid = slabs_solid(exact);
    const enum fmb_verdict verdict = solid ? verdict_of_solid(&walk) : verdict_of_flat(&walk);
    ratio_each(&walk.crossing, mpz_clear);
    mpz_clears(walk.f0, walk.f1, NULL);
    return verdict;
}

enum fmb_status exact_decide(const struct frame_pair *pair, unsigned want,
                             struct fmb_answer *answer)
{
    struct exact_pair exact;
    double contact[2];
    exact_pair_init(&exact, pair, true);
    answer->verdict = exact_verdict(&exact, pair->duration, contact);
    if (answer->verdict != FMB_SEPARATED) {
        answer->has_contact = true;
        memcpy(answer->contact, contact, sizeof contact);
        answer->has_box = want & FMB_WANT_BOX;
        if (answer->has_box)
            exact_pair_box(&exact, answer->box);
    }
    exact_pair_clear(&exact);
    return FMB_OK;
}

void exact_box(const struct frame_pair *pair, double box[2][FMB_DIM_MAX])
{
    struct exact_pair exact;
    exact_pair_init(&exact, pair, false);
    exact_pair_box(&exact, box);
    exact_pair_clear(&exact);
}
