/* Slabs in integers against the same in GMP (slab_truth.h), in every width, with numbers at the
 * ends of what fits; and whether what is said not to round does not. */

#include "unit.h"

#include <math.h>

#include "draw.h"
#include "limbs_decide.h"
#include "question.h"
#include "referee.h"
#include "slab_truth.h"
#include "slabs.h"
#include "support_integers.h"

/* ---- Numbers of a span ---- */

/* The most bits of lengths for numbers of 2, 3, 4, 5, 6 and 8 limbs. */
static const int widest[] = {39, 61, 82, 103, 125, 167};
enum { WIDTHS = sizeof widest / sizeof widest[0] };

/* A multiple of 2^unit below 2^(unit + bits) in magnitude, often as large or as small as that
 * allows; mantissas of ones, of one bit, of any. */
static double draw_length(struct draw *draw, int unit, int bits)
{
    const int size = bits < 53 ? bits : draw_int(draw, 1, 53); /* of the mantissa */
    double mantissa = ldexp(1, size) - 1;
    switch (draw_int(draw, 0, 5)) {
    case 0: return 0;
    case 1: mantissa = 1; break;
    case 2: mantissa = ldexp(1, size - 1); break;
    case 3: mantissa = (double) (draw_bits(draw) >> (64 - size)); break;
    default: break;
    }
    const int most = bits - size;
    const int shift = draw_coin(draw) ? most : draw_coin(draw) ? 0 : draw_int(draw, 0, most);
    const double length = ldexp(mantissa, unit + shift);
    return draw_coin(draw) ? length : -length;
}

static void draw_lengths(struct draw *draw, int unit, int bits, int dim, double *vector)
{
    for (int axis = 0; axis < dim; axis++)
        vector[axis] = draw_length(draw, unit, bits);
}

/* A pair that spans as many bits from a unit on, displacements included. */
static struct question draw_question(struct draw *draw, int unit, int bits)
{
    static const double windows[] = {1, 0x1p-3, 3, 0x1.8p5, 0x1.fffffffffffffp0, 0};
    static const int window_unit[] = {0, -3, 0, 4, -52, 0}, window_bits[] = {1, 1, 2, 2, 53, 0};
    const int dim = draw_int(draw, 2, 3), window = draw_int(draw, 0, 5);
    struct question question = {{.dim = dim}, {.dim = dim}, windows[window]};
    struct solid *solids[2] = {&question.a, &question.b};
    for (int f = 0; f < 2; f++) {
        struct solid *solid = solids[f];
        solid->shape = draw_coin(draw) ? FMB_CUBOID : FMB_TETRAHEDRON;
        solid->moving = draw_coin(draw);
        for (int i = 0; i < dim; i++)
            draw_lengths(draw, unit, bits, dim, solid->component[i]);
        if (draw_int(draw, 0, 7) == 0) /* parallel edges: normals that are zero */
            memcpy(solids[1]->component[0], solids[0]->component[draw_int(draw, 0, dim - 1)],
                   sizeof solid->component[0]);
        draw_lengths(draw, unit, bits, dim, solid->origin);
        const int left = bits - window_bits[window];
        if (left > 0)
            draw_lengths(draw, unit - window_unit[window], left, dim, solid->velocity);
    }
    return question;
}

/* ---- Slabs ---- */

static int draw_edge_of(struct draw *draw, enum fmb_shape shape, int dim)
{
    static const int of_face[] = {0, 1, 5};
    switch (shape) {
    case FMB_FACE: return of_face[draw_int(draw, 0, 2)];
    case FMB_TETRAHEDRON: return draw_int(draw, 0, dim == 3 ? SLABS_EDGES - 1 : 2);
    default: return draw_int(draw, 0, dim - 1);
    }
}

/* Any edge: two of them may be no slab of the pair. */
static int draw_edge(struct draw *draw, const struct question *question)
{
    const int dim = question->a.dim;
    switch (draw_int(draw, 0, 4)) {
    case 0: return SLABS_DRIFT;
    case 1:
    case 2: return draw_edge_of(draw, question->a.shape, dim);
    default: return SLABS_EDGE_OF_B + draw_edge_of(draw, question->b.shape, dim);
    }
}

/* Two edges in the order of slabs: of a, of b, the drift; not the drift twice. */
static struct slab_normal draw_normal(struct draw *draw, const struct question *question)
{
    struct slab_normal normal = {draw_edge(draw, question), draw_edge(draw, question)};
    while (question->a.dim == 3 && normal.u == SLABS_DRIFT)
        normal.u = draw_edge(draw, question);
    if (normal.u >= SLABS_EDGE_OF_B && normal.v < SLABS_EDGE_OF_B)
        return (struct slab_normal){normal.v, normal.u};
    return normal;
}

/* Whether x 2^of_x = y 2^of_y. */
static bool same_number(mpz_t x, long of_x, mpz_t y, long of_y)
{
    if (of_x > of_y)
        mpz_mul_2exp(x, x, (mp_bitcnt_t) (of_x - of_y));
    else
        mpz_mul_2exp(y, y, (mp_bitcnt_t) (of_y - of_x));
    return mpz_cmp(x, y) == 0;
}

/* Sets the numbers of a slab; 0 if its normal is. */
static void set_numbers(struct limbs_pair *pair, struct slab_normal normal, mpz_t low, mpz_t high,
                        mpz_t start, mpz_t slope)
{
    struct limbs_products of;
    struct limbs_slab slab;
    memset(&slab, 0, sizeof slab);
    if (limbs_products_of(pair, normal, &of))
        limbs_set_slab(pair, &of, &slab);
    limbs_to_mpz(pair->limbs, slab.low, low);
    limbs_to_mpz(pair->limbs, slab.high, high);
    limbs_to_mpz(pair->limbs, slab.start, start);
    limbs_to_mpz(pair->limbs, slab.slope, slope);
}

/* Whether the gap of one slab has this sign. Prepares the pair anew, so it is called once a pair.
 */
static bool have_sign(const struct limbs_question *question, struct slab_normal normal, int sign)
{
    return limbs_slabs(question, &normal, NULL, 1, NULL) == sign;
}

/* Compares one slab; returns the sign of its gap. */
static int compare_slab(const struct question *question, struct dyadic_span span,
                        struct limbs_pair *limbs, struct slab_normal normal,
                        struct slab_truth *truth)
{
    mpz_t low, high, start, slope;
    const int dim = question->a.dim;
    const long unit = dim * span.unit, of_truth = dim * truth->unit;
    slab_truth_compute(truth, normal);
    const int expected = truth->zero ? -1 : mpz_sgn(truth->gap);
    mpz_inits(low, high, start, slope, NULL);
    set_numbers(limbs, normal, low, high, start, slope);
    if (!same_number(low, unit, truth->low, of_truth) ||
        !same_number(high, unit, truth->high, of_truth) ||
        !same_number(start, unit, truth->start, of_truth) ||
        !same_number(slope, unit, truth->slope, of_truth))
        referee_fail(question, "the numbers of a slab");
    mpz_clears(low, high, start, slope, NULL);
    return expected;
}

struct seen {
    long pairs, zero, sign[3];
    int most; /* bits of a span */
};

static int limbs_of(long bits)
{
    return bits <= 39 ? 2 : (int) (3 * bits + 8) / 64 + 1;
}

static void compare_pair(struct draw *draw, const struct question *question,
                         struct slab_truth *truth, struct seen *seen)
{
    struct ready ready;
    struct limbs_question integers;
    static struct limbs_pair limbs;
    referee_ready(question, &ready);
    const struct frame_pair frames = pair_frames(&ready.pair);
    const struct dyadic_span span = limbs_span_of(&frames);
    const long bits = span.top - span.unit;
    limbs_question_set(&frames, span, LIMBS_SLABS, &integers);
    if (bits < 0)
        return;
    if (integers.limbs != limbs_of(bits))
        referee_fail(question, "another width");
    limbs_prepare(&integers, &limbs);
    slab_truth_set(truth, &ready.pair);
    for (int n = 0; n < 4; n++) {
        const struct slab_normal normal = draw_normal(draw, question);
        const int sign = compare_slab(question, span, &limbs, normal, truth);
        if (n == 0 && !have_sign(&integers, normal, sign))
            referee_fail(question, "the sign of a gap");
        seen->sign[sign + 1]++;
        seen->zero += truth->zero;
    }
    seen->pairs++;
    seen->most = bits > seen->most ? (int) bits : seen->most;
}

/* From unit on as far as the doubles go, so that neither end is one that doubles do not have. */
static int draw_unit(struct draw *draw, int bits)
{
    switch (draw_int(draw, 0, 3)) {
    case 0: return -1074 + 60; /* space for the window */
    case 1: return 1000 - bits;
    case 2: return -bits / 2;
    default: return draw_int(draw, -900, 900 - bits);
    }
}

static void limbs_are_gmp(void **state)
{
    struct draw draw;
    struct slab_truth truth;
    draw_begin(&draw, "limbs_are_gmp");
    slab_truth_init(&truth);
    for (int width = 0; width < WIDTHS; width++) {
        struct seen seen = {0};
        const int least = width == 0 ? 1 : widest[width - 1] + 1;
        for (long n = draw_sample(40000); n > 0; n--) {
            const int any = draw_int(&draw, least, widest[width]);
            const int bits = draw_coin(&draw) ? widest[width] : draw_coin(&draw) ? least : any;
            struct question question = draw_question(&draw, draw_unit(&draw, bits), bits);
            compare_pair(&draw, &question, &truth, &seen);
        }
        printf(
            "# up to %d bits: %ld pairs, %d bits at most; normals that are zero %ld; gaps below "
            "0 %ld, 0 %ld, above %ld\n",
            widest[width], seen.pairs, seen.most, seen.zero, seen.sign[0], seen.sign[1],
            seen.sign[2]);
        assert_true(seen.most == widest[width] && seen.zero > 0);
        assert_true(seen.sign[0] > 0 && seen.sign[1] > 0 && seen.sign[2] > 0);
    }
    slab_truth_clear(&truth);
}

static struct question cubes_of(double size)
{
    const struct solid cube = {3,   FMB_CUBOID, {{size, 0, 0}, {0, size, 0}, {0, 0, size}},
                               {0}, {0},        false};
    return (struct question){cube, cube, 1};
}

/* ---- Orientations ---- */

static void draw_orientation(struct draw *draw, int count, double *q)
{
    const double angle = acos(-1) / (draw_coin(draw) ? 2 : 4);
    memset(q, 0, 4 * sizeof *q);
    switch (draw_int(draw, 0, 4)) {
    case 0: draw_integers(draw, count, -2, 2, q); break;
    case 1: /* quarter and half turns from libm */
        q[0] = cos(angle);
        q[draw_int(draw, 1, count - 1)] = sin(angle);
        break;
    case 2: /* integers as long as they get */
        for (int i = 0; i < count; i++)
            q[i] = draw_log(draw, -195, 0);
        break;
    default:
        for (int i = 0; i < count; i++)
            q[i] = draw_uniform(draw, -1, 1);
        break;
    }
    q[0] += q[0] == 0;
}

static double draw_number(struct draw *draw, bool whole)
{
    return whole ? draw_int(draw, -2, 2) : draw_uniform(draw, -1, 1);
}

static void draw_posed(struct draw *draw, int dim, struct solid *solid)
{
    const bool whole = draw_coin(draw);
    solid->dim = dim;
    solid->shape = (enum fmb_shape) draw_int(draw, FMB_CUBOID, FMB_BOX);
    if (dim == 2 && solid->shape == FMB_FACE)
        solid->shape = FMB_TETRAHEDRON;
    const bool box = solid->shape == FMB_BOX, local = draw_coin(draw);
    solid->moving = draw_coin(draw);
    for (int axis = 0; axis < dim; axis++) {
        for (int i = 0; i < solid_count(solid); i++) {
            const double number = draw_number(draw, whole);
            solid->component[i][axis] = !box ? number : i == axis ? fabs(number) : 0;
        }
        solid->origin[axis] = draw_number(draw, whole);
        solid->velocity[axis] = draw_number(draw, whole);
        solid->local[axis] = local ? draw_number(draw, whole) : 0;
    }
    solid->by_vertices = !box && solid->shape != FMB_CUBOID && draw_coin(draw);
    if (draw_int(draw, 0, 3) == 0)
        return;
    solid->orientation_count = dim == 3 ? 4 : 2;
    draw_orientation(draw, solid->orientation_count, solid->orientation);
}

/* The same orientation, or the opposite quaternion, in the same least integers. */
static void share_orientation(struct draw *draw, struct question *question)
{
    const double sign = draw_coin(draw) ? 1 : -1;
    question->b.orientation_count = question->a.orientation_count;
    for (int i = 0; i < 4; i++)
        question->b.orientation[i] = sign * question->a.orientation[i];
}

/* The vertices of a pair in integers (support_integers.h). */
static void set_vertex(struct support_integers *integers, int f, int vertex, mpz_t out[3])
{
    support_integers_place(integers, f, (unsigned) vertex, out);
}

/* out := component i of frame f; i < 0: 0. */
static void set_component(struct support_integers *integers, int f, int i, mpz_t out[3])
{
    const bool simplex = frame_is_simplex(integers->side[f].frame);
    mpz_t origin[3];
    mpz_inits(origin[0], origin[1], origin[2], NULL);
    set_vertex(integers, f, 0, origin);
    set_vertex(integers, f, i < 0 ? 0 : simplex ? i + 1 : 1 << i, out);
    for (int axis = 0; axis < 3; axis++)
        mpz_sub(out[axis], out[axis], origin[axis]);
    mpz_clears(origin[0], origin[1], origin[2], NULL);
}

static void set_edge(struct support_integers *integers, int edge, int dim, mpz_t out[3])
{
    const int e = edge % SLABS_EDGES, f = edge >= SLABS_EDGE_OF_B;
    const int p = dim == 2 ? 0 : (e + 1) % 3, q = dim == 2 ? 1 : (e + 2) % 3;
    mpz_t from[3];
    mpz_inits(from[0], from[1], from[2], NULL);
    if (edge == SLABS_DRIFT) {
        for (int axis = 0; axis < 3; axis++)
            mpz_set(out[axis], integers->drift[axis]);
    } else {
        set_component(integers, f, e < dim ? -1 : p, from);
        set_component(integers, f, e < dim ? e : q, out);
    }
    for (int axis = 0; axis < 3; axis++)
        mpz_sub(out[axis], out[axis], from[axis]);
    mpz_clears(from[0], from[1], from[2], NULL);
}

/* range := the least and the greatest normal . x over a frame. */
static void set_range(struct support_integers *integers, int f, mpz_t normal[3], mpz_t range[2])
{
    const struct fmb_frame *frame = integers->side[f].frame;
    const int count = frame_is_simplex(frame) ? frame->count + 1 : 1 << frame->count;
    mpz_t vertex[3], value, scratch;
    mpz_inits(vertex[0], vertex[1], vertex[2], value, scratch, NULL);
    for (int i = 0; i < count; i++) {
        set_vertex(integers, f, i, vertex);
        integer_dot(value, normal, vertex, scratch);
        if (i == 0 || mpz_cmp(value, range[0]) < 0)
            mpz_set(range[0], value);
        if (i == 0 || mpz_cmp(value, range[1]) > 0)
            mpz_set(range[1], value);
    }
    mpz_clears(vertex[0], vertex[1], vertex[2], value, scratch, NULL);
}

/* start - low, high - start, slope of the same slab. */
static void set_expected(struct support_integers *integers, struct slab_normal edges, int dim,
                         mpz_t out[3])
{
    mpz_t u[3], v[3], normal[3], range[2][2], scratch;
    mpz_init(scratch);
    for (int i = 0; i < 3; i++)
        mpz_inits(u[i], v[i], normal[i], NULL);
    for (int f = 0; f < 2; f++)
        mpz_inits(range[f][0], range[f][1], NULL);
    set_edge(integers, edges.u, dim, u);
    if (dim == 2) {
        mpz_neg(normal[0], u[1]);
        mpz_set(normal[1], u[0]);
    } else {
        set_edge(integers, edges.v, dim, v);
        integer_cross(normal, u, v, scratch);
    }
    for (int f = 0; f < 2; f++)
        set_range(integers, f, normal, range[f]);
    mpz_sub(out[0], range[1][1], range[0][0]);
    mpz_sub(out[1], range[0][1], range[1][0]);
    integer_dot(out[2], normal, integers->drift, scratch);
    mpz_clear(scratch);
    for (int i = 0; i < 3; i++)
        mpz_clears(u[i], v[i], normal[i], NULL);
    for (int f = 0; f < 2; f++)
        mpz_clears(range[f][0], range[f][1], NULL);
}

/* Whether x is y times a positive number, or both are 0. */
static bool same_direction(mpz_t x[3], mpz_t y[3], mpz_t scratch[2])
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        mpz_mul(scratch[0], x[i], y[j]);
        mpz_mul(scratch[1], x[j], y[i]);
        if (mpz_sgn(x[i]) != mpz_sgn(y[i]) || mpz_cmp(scratch[0], scratch[1]) != 0)
            return false;
    }
    return true;
}

/* The gap is the larger of low - start and start - high, at the end of the window where each is
 * less. */
static int expected_sign(mpz_t number[3], mpz_t scratch)
{
    int sign = -1;
    for (int side = 0; side < 2; side++) {
        (side ? mpz_sub : mpz_add)(scratch, number[side], number[2]);
        const int last = mpz_sgn(scratch), first = mpz_sgn(number[side]);
        const int of_side = -(last > first ? last : first);
        sign = of_side > sign ? of_side : sign;
    }
    return sign;
}

/* Returns the sign of the gap. */
static int compare_posed(const struct question *question, struct limbs_pair *limbs,
                         struct support_integers *exact, struct slab_normal edges)
{
    mpz_t low, high, start, found[3], expected[3], scratch[2];
    mpz_inits(low, high, start, scratch[0], scratch[1], NULL);
    for (int i = 0; i < 3; i++)
        mpz_inits(found[i], expected[i], NULL);
    set_numbers(limbs, edges, low, high, start, found[2]);
    mpz_sub(found[0], start, low);
    mpz_sub(found[1], high, start);
    set_expected(exact, edges, question->a.dim, expected);
    if (!same_direction(found, expected, scratch))
        referee_fail(question, "the numbers of a slab of turned frames");
    const int sign = sign_of_slabs(limbs, &edges, NULL, 1, 0, NULL);
    const bool nothing = mpz_sgn(expected[0]) == 0 && mpz_sgn(expected[1]) == 0 &&
                         mpz_sgn(expected[2]) == 0; /* perhaps the normal is zero, perhaps not */
    if (!nothing && sign != expected_sign(expected, scratch[0]))
        referee_fail(question, "the sign of a gap of turned frames");
    mpz_clears(low, high, start, scratch[0], scratch[1], NULL);
    for (int i = 0; i < 3; i++)
        mpz_clears(found[i], expected[i], NULL);
    return sign;
}

static void turned_slabs_are_gmp(void **state)
{
    struct draw draw;
    long seen[3] = {0}, same = 0, limbs_of_pair[LIMBS_MAX + 1] = {0};
    draw_begin(&draw, "turned_slabs_are_gmp");
    for (long n = draw_sample(40000); n > 0; n--) {
        const int dim = draw_int(&draw, 0, 3) ? 3 : 2;
        struct question question = {.duration = draw_int(&draw, 0, 2)};
        draw_posed(&draw, dim, &question.a);
        draw_posed(&draw, dim, &question.b);
        if (draw_int(&draw, 0, 3) == 0)
            share_orientation(&draw, &question);
        struct ready ready;
        struct limbs_question integers;
        static struct limbs_pair limbs;
        static struct support_integers exact;
        referee_ready(&question, &ready);
        const struct frame_pair frames = pair_frames(&ready.pair);
        limbs_question_set(&frames, limbs_span_of(&frames), LIMBS_SLABS, &integers);
        if (!limbs_suffice(&integers))
            continue;
        limbs_prepare(&integers, &limbs);
        memset(&exact, 0, sizeof exact);
        support_integers_each(&exact, mpz_init);
        support_integers_set(&frames, false, 0, &exact);
        for (int k = 0; k < 6; k++) {
            const struct slab_normal edges = draw_normal(&draw, &question);
            const int sign = compare_posed(&question, &limbs, &exact, edges);
            if (k == 0 && !have_sign(&integers, edges, sign))
                referee_fail(&question, "another sign by itself");
            seen[sign + 1]++;
        }
        support_integers_each(&exact, mpz_clear);
        same += limbs.common != NULL;
        limbs_of_pair[limbs.limbs]++;
    }
    printf("# %ld of equal orientations; gaps below 0 %ld, 0 %ld, above %ld; by limbs", same,
           seen[0], seen[1], seen[2]);
    for (int i = 0; i <= LIMBS_MAX; i++)
        printf(" %ld", limbs_of_pair[i]);
    printf("\n");
    assert_true(same > 0 && seen[0] > 0 && seen[1] > 0 && seen[2] > 0);
    for (int limbs = 2; limbs <= LIMBS_MAX; limbs++)
        assert_true(limbs_of_pair[limbs] > 0);
}

/* ---- What does not round ---- */

static void expect_exact_motion(const struct question *question, const struct slabs_pair *pair,
                                struct slab_truth *truth)
{
    for (int axis = 0; axis < question->a.dim; axis++) {
        const double offset = mpz_get_d(truth->offset[axis]);
        const double drift = mpz_get_d(truth->drift[axis]);
        if (pair->motion.offset[axis] != ldexp(offset, (int) truth->unit) ||
            (pair->motion.drifts && pair->motion.drift[axis] != ldexp(drift, (int) truth->unit)))
            referee_fail(question, "the motion has been rounded");
    }
}

/* On input: a pair that is said not to round. */
static void expect_exact_slabs(const struct question *question, const struct pair *pair,
                               const struct slabs_pair *slabs, struct slab_truth *truth)
{
    struct slab_value slab[SLABS_MAX];
    slab_truth_set(truth, pair);
    expect_exact_motion(question, slabs, truth);
    const int count = slabs_list(slabs, false, slab);
    for (int i = 0; i < count; i++)
        if (slab[i].error != 0 || slab_truth_worst(truth, &slab[i]) != 0)
            referee_fail(question, "a slab has been rounded");
}

/* Whether the pair is said not to round; if so, it must be so. */
static bool never_rounds(const struct question *question, struct slab_truth *truth)
{
    struct ready ready;
    struct slabs_pair slabs;
    referee_ready(question, &ready);
    if (!slab_truth_prepare(&ready.pair, &slabs))
        return false;
    const struct frame_pair frames = pair_frames(&ready.pair);
    const struct dyadic_span span = limbs_span_of(&frames);
    if (!limbs_never_round(&slabs, span))
        return false;
    expect_exact_slabs(question, &ready.pair, &slabs, truth);
    return true;
}

/* Numbers of so many bits that about half of the pairs are said to round. */
static void what_is_said_not_to_round_does_not(void **state)
{
    struct draw draw;
    struct slab_truth truth;
    long count[2] = {0};
    draw_begin(&draw, "what_is_said_not_to_round_does_not");
    slab_truth_init(&truth);
    for (long n = draw_sample(40000); n > 0; n--) {
        const int unit = draw_int(&draw, -190, 150);
        struct question question = draw_question(&draw, unit, draw_int(&draw, 8, 20));
        if (draw_int(&draw, 0, 3) == 0) { /* lengths far smaller than where they are */
            const double far = ldexp(draw_int(&draw, -1, 1), unit + draw_int(&draw, 20, 49));
            question.a.origin[0] += far;
            question.b.origin[0] += far;
        }
        count[never_rounds(&question, &truth)]++;
    }
    slab_truth_clear(&truth);
    printf("# %ld may round, %ld do not\n", count[0], count[1]);
    assert_true(count[0] > 0 && count[1] > 0);
}

static void expect_limit(struct question question, double last, struct slab_truth *truth)
{
    question.b.component[0][1] = 1; /* the unit */
    question.b.origin[2] = last;
    assert_true(never_rounds(&question, truth));
    question.b.origin[2] = last + 1;
    assert_false(never_rounds(&question, truth));
}

/* 6 L^2 2 R < 2^53 of cuboids, with sizes L = 2^15 (six of them in R): R < 2^23 / 12. Where one is
 * a tetrahedron 96 L^2 2 R < 2^53, with L = 2^13: R < 2^27 / 192, the same number. */
static void the_limit_is_where_it_is_said_to_be(void **state)
{
    struct slab_truth truth;
    slab_truth_init(&truth);
    expect_limit(cubes_of(0x1p15), 699050 - 6 * 0x1p15, &truth);
    struct question question = cubes_of(0x1p13);
    question.a.shape = FMB_TETRAHEDRON;
    expect_limit(question, 699050 - 6 * 0x1p13, &truth);

    question = cubes_of(1); /* the span: 50 bits */
    question.a.origin[0] = question.b.origin[0] = 0x1p49;
    assert_true(never_rounds(&question, &truth));
    question.a.origin[0] = question.b.origin[0] = 0x1p50;
    assert_false(never_rounds(&question, &truth));
    slab_truth_clear(&truth);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(limbs_are_gmp),
        cmocka_unit_test(turned_slabs_are_gmp),
        cmocka_unit_test(what_is_said_not_to_round_does_not),
        cmocka_unit_test(the_limit_is_where_it_is_said_to_be),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
