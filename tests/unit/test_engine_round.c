/* Shapes with a radius: families of pairs against the oracle, closed forms, and what a radius of 0
 * leaves as it is. */

#include "unit.h"

#include <float.h>
#include <math.h>

#include "gap_check.h"
#include "posed.h"
#include "rational_solid.h"
#include "referee.h"
#include "round.h"
#include "rounded.h"
#include "rounded_cases.h"
#include "trial.h"

/* All that can be wanted; points where the engine gives them. */
enum { ALL = FMB_WANT_BOX | FMB_WANT_GAP | FMB_WANT_POINT };

static bool fails_of(const struct question *question, const char *what)
{
    if (question)
        question_print(question);
    print_message("# %s\n", what);
    return false;
}

/* ---- Against the oracle ---- */

struct subject {
    const struct pair *pair;
    const struct question *question; /* NULL: bodies of drawn frames */
    const struct oracle_answer *truth;
};

static bool same_bits(const void *one, const void *other, size_t size, bool has)
{
    return !has || memcmp(one, other, size) == 0;
}

/* Parts that are wanted are the same; the others are missing. */
static bool same_parts(const struct fmb_answer *whole, const struct fmb_answer *part, unsigned want)
{
    const bool contact = whole->has_contact, box = whole->has_box && want & FMB_WANT_BOX;
    const bool gap = (want & FMB_WANT_GAP) != 0;
    const bool point = whole->has_point && want & FMB_WANT_POINT;
    return whole->verdict == part->verdict && part->has_contact == contact &&
           part->has_box == box && part->has_gap == gap && part->has_point == point &&
           same_bits(whole->contact, part->contact, sizeof whole->contact, contact) &&
           same_bits(whole->box, part->box, sizeof whole->box, box) &&
           same_bits(whole->point, part->point, sizeof whole->point, point) &&
           (!gap || gap_check_same(&whole->gap, &part->gap));
}

static bool same_swapped(const struct subject *subject, const struct fmb_answer *answer,
                         const struct fmb_answer *swapped)
{
    const bool symmetric = subject->question && question_is_symmetric(subject->question);
    struct fmb_answer turned = *swapped;
    turned.gap = answer->gap;
    return same_parts(answer, &turned, ALL) &&
           gap_check_swapped(symmetric, &answer->gap, &swapped->gap);
}

static bool answer_holds(const struct subject *subject, const struct fmb_answer *answer,
                         enum oracle_limit limit, char *why, size_t size)
{
    const enum fmb_verdict verdict = subject->truth->verdict;
    if (!oracle_agrees(subject->truth, subject->pair, answer, limit, why, size) ||
        !gap_check(subject->pair, verdict, &answer->gap, why, size))
        return false;
    if (answer->has_point != (verdict != FMB_SEPARATED))
        snprintf(why, size, "a point, or none");
    return answer->has_point == (verdict != FMB_SEPARATED);
}

/* Whether the answers of a certain method are right, the same in both orders, and the same whatever
 * else is wanted. */
static bool method_is_right(const struct subject *subject, const struct fmb_method *method)
{
    static unsigned turn; /* each third of what can be wanted, by turns */
    const struct pair swapped = {subject->pair->b, subject->pair->a, subject->pair->duration};
    const bool exact = strcmp(method->name, "exact") == 0;
    struct fmb_answer whole, other;
    char why[300] = "";
    memset(&whole, 0xa5, sizeof whole); /* what is not written shows */
    enum fmb_status status = pair_decide(method, subject->pair, ALL, &whole);
    if (status != FMB_OK)
        return fails_of(subject->question, fmb_status_text(status));
    if (!answer_holds(subject, &whole, exact ? ORACLE_TIGHTEST : ORACLE_DESIGN, why, sizeof why)) {
        print_message("# %s\n", method->name);
        return fails_of(subject->question, why);
    }
    if (pair_decide(method, &swapped, ALL, &other) != FMB_OK ||
        !same_swapped(subject, &whole, &other))
        return fails_of(subject->question, "differs the other way round");
    for (unsigned want = turn++ % 3; want < ALL; want += 3)
        if ((want & ~ALL) == 0 && (pair_decide(method, subject->pair, want, &other) != FMB_OK ||
                                   !same_parts(&whole, &other, want))) {
            print_message("# %s wants %u\n", method->name, want);
            return fails_of(subject->question, "differs by what is wanted");
        }
    return true;
}

static bool has_radius(const struct pair *pair)
{
    for (unsigned i = 0; i < pair->a.body->frame_count; i++)
        if (fmb_body_frame(pair->a.body, i)->radius != 0)
            return true;
    for (unsigned i = 0; i < pair->b.body->frame_count; i++)
        if (fmb_body_frame(pair->b.body, i)->radius != 0)
            return true;
    return false;
}

/* Returns whether all methods are right. */
static bool is_right(const struct subject *subject)
{
    const bool single =
        subject->pair->a.body->frame_count * subject->pair->b.body->frame_count == 1;
    for (size_t m = 0; fmb_method_at(m); m++) {
        const struct fmb_method *method = fmb_method_at(m);
        struct fmb_answer answer;
        if (method->certain && !method_is_right(subject, method))
            return false;
        if (!method->certain && single && has_radius(subject->pair) &&
            pair_decide(method, subject->pair, 0, &answer) != FMB_CANNOT_DECIDE)
            return fails_of(subject->question, "an inexact method decides");
    }
    return true;
}

/* A certificate of the verdict, and of no other. */
static bool certificate_is_right(const struct subject *subject, bool due)
{
    static char text[FMB_CERTIFICATE_MAX];
    char why[200];
    size_t length;
    const enum fmb_status status = pair_certificate(subject->pair, text, sizeof text, &length);
    if (status != FMB_OK)
        return fails_of(subject->question, fmb_status_text(status));
    if (length == 0)
        return !due || fails_of(subject->question, "no certificate");
    for (int verdict = FMB_SEPARATED; verdict <= FMB_OVERLAPPING; verdict++)
        if (pair_certificate_holds(subject->pair, (enum fmb_verdict) verdict, text, why,
                                   sizeof why) != (verdict == (int) subject->truth->verdict)) {
            print_message("# %s: %s\n", text, why);
            return fails_of(subject->question,
                            "a certificate that does not hold, or of two verdicts");
        }
    return true;
}

/* Returns whether all is right of the question; count[its verdict]++. */
static bool question_is_right(const struct question *question, int verdict, bool certificate,
                              long count[4])
{
    static struct trial trial;
    struct oracle_answer truth;
    trial_begin(question, &trial);
    oracle_init(&truth);
    oracle_decide(&trial.pair[0], FMB_WANT_BOX, &truth);
    count[truth.verdict]++;
    const struct subject subject = {&trial.pair[0], question, &truth};
    bool right = is_right(&subject);
    if (right && verdict != 0 && verdict != (int) truth.verdict)
        right = fails_of(question, "not the verdict that it was made for");
    if (right && solid_frames(&question->a) * solid_frames(&question->b) == 1)
        right = certificate_is_right(&subject, certificate);
    oracle_clear(&truth);
    trial_end(&trial);
    return right;
}

static void family_is_right(void **state)
{
    const struct family *family = *state;
    struct cell cells[CELL_OF_ALL_SHAPES];
    const int cell_count = family_cells(family, cells);
    const long draws = draw_sample(2);
    const bool small = family->verdict == FMB_TOUCHING && family->amount < 31;
    long bad = 0, count[4] = {0};
    for (int c = 0; c < cell_count; c += draw_step(3)) {
        struct draw draw = cell_draw(11, family->name, &cells[c], 0);
        for (long n = 0; n < draws; n++) {
            struct question question;
            family_draw(family, &cells[c], &draw, &question);
            bad += !question_is_right(&question, family->verdict, small, count);
        }
    }
    printf("# %s: %ld separated, %ld touching, %ld overlapping, %ld wrong\n", family->name,
           count[FMB_SEPARATED], count[FMB_TOUCHING], count[FMB_OVERLAPPING], bad);
    assert_int_equal(bad, 0);
    if (family->verdict == 0)
        assert_true(count[FMB_SEPARATED] && count[FMB_OVERLAPPING]);
}

static void cases_by_hand(void **state)
{
    long bad = 0, count[4] = {0};
    for (size_t i = 0; i < COUNT(rounded_cases); i++)
        for (int swap = 0; swap < 2; swap++) {
            const struct rounded_case *known = &rounded_cases[i];
            const struct question swapped = question_swapped(&known->question);
            if (question_is_right(swap ? &swapped : &known->question, (int) known->verdict, false,
                                  count))
                continue;
            print_message("# %s\n", known->what);
            bad++;
        }
    assert_int_equal(bad, 0);
}

/* ---- Closed forms ---- */

/* Whole numbers and the whole length of the first two, or of all three. */
static const int triples[][4] = {{3, 4, 0, 5}, {5, 12, 0, 13}, {8, 15, 0, 17}, {20, 21, 0, 29}};
static const int quadruples[][4] = {{1, 2, 2, 3}, {2, 3, 6, 7},  {1, 4, 8, 9},
                                    {4, 4, 7, 9}, {2, 6, 9, 11}, {6, 6, 7, 11}};

/* A ball, as one of the shapes that a point is; or a capsule along an axis of that length. */
static struct solid rounded_core(int dim, int how, int axis, double length)
{
    static const enum fmb_shape shapes[] = {FMB_HULL, FMB_BOX, FMB_CUBOID, FMB_TETRAHEDRON};
    struct solid solid = {.dim = dim, .shape = shapes[how % 4]};
    if (solid.shape == FMB_HULL) {
        solid.vertex_count = length == 0 ? 1 : 2;
        solid.vertex[1][axis] = length;
        return solid;
    }
    solid.component[solid.shape == FMB_TETRAHEDRON ? 0 : axis][axis] = length;
    if (solid.shape == FMB_BOX)
        solid.local[axis] = length / 2;
    return solid;
}

static void scale(double factor, struct solid *solid)
{
    solid->radius *= factor;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        solid->origin[axis] *= factor;
        solid->local[axis] *= factor;
        for (int i = 0; i < FMB_DIM_MAX; i++)
            solid->component[i][axis] *= factor;
        for (int v = 0; v < solid->vertex_count; v++)
            solid->vertex[v][axis] *= factor;
    }
}

/* Whether the certain methods give this verdict, and the gap of whole numbers that it has. */
static bool closed_form(const struct question *question, enum fmb_verdict verdict, double gap)
{
    static struct trial trial;
    bool right = true;
    trial_begin(question, &trial);
    for (int m = 0; m < 2 * trial_methods() && right; m++) {
        const struct fmb_method *method = fmb_method_at((size_t) m / 2);
        if (!method->certain)
            continue;
        const struct reply reply = trial_decide(&trial, method, m % 2, FMB_WANT_GAP);
        right = reply.status == FMB_OK && reply.answer.verdict == verdict &&
                (isnan(gap) ||
                 (reply.answer.gap.bounds[0] <= gap && gap <= reply.answer.gap.bounds[1]));
        if (!right)
            print_message("# %s: status %d, verdict %d of %d, gap %a to %a of %a\n", method->name,
                          (int) reply.status, (int) reply.answer.verdict, (int) verdict,
                          reply.answer.gap.bounds[0], reply.answer.gap.bounds[1], gap);
    }
    if (!right)
        question_print(question);
    trial_end(&trial);
    return right;
}

/* Two cores the way from a point of A to a point of B apart: the length is whole, and their
 * distance. Radii that sum to it, to the double before and after, to 1 less, and to 1 more. */
static bool closed_forms(struct draw *draw, const struct question *cores, double length)
{
    const int exponent = draw_coin(draw) ? 0 : draw_int(draw, -1000, 1000);
    const double unit = ldexp(1, exponent);
    for (int more = -2; more <= 2; more++) {
        struct question question = *cores;
        double part = draw_int(draw, 0, (int) length);
        double other = length - part;
        if (abs(more) == 1 && part > other) { /* whose last place is the sum's */
            part = other;
            other = length - part;
        }
        question.a.radius = part;
        question.b.radius = abs(more) == 2 ? other + more / 2
                            : more == 0    ? other
                                           : nextafter(other, more * HUGE_VAL);
        if (question.b.radius < 0)
            continue;
        const bool first = draw_coin(draw);
        const enum fmb_verdict verdict = more < 0    ? FMB_SEPARATED
                                         : more == 0 ? FMB_TOUCHING
                                                     : FMB_OVERLAPPING;
        scale(unit, &question.a);
        scale(unit, &question.b);
        const double gap = abs(more) == 1 ? NAN : -(more / 2) * unit;
        const struct question swapped = question_swapped(&question);
        if (!closed_form(first ? &question : &swapped, verdict, gap))
            return false;
    }
    return true;
}

/* The way: over a vertex all its numbers are not 0, over an edge two, over a face one. */
static double draw_way(struct draw *draw, int dim, int numbers, double *way)
{
    const int *known = numbers == 3 ? quadruples[draw_int(draw, 0, (int) COUNT(quadruples) - 1)]
                                    : triples[draw_int(draw, 0, (int) COUNT(triples) - 1)];
    const int times = draw_int(draw, 1, 9), first = draw_int(draw, 0, dim - 1);
    memset(way, 0, FMB_DIM_MAX * sizeof *way);
    for (int i = 0; i < numbers; i++)
        way[(first + i) % dim] = times * known[i] * (draw_coin(draw) ? 1 : -1);
    return times * (numbers == 1 ? known[0] : known[3]);
}

static void balls_and_balls(void **state)
{
    struct draw draw;
    draw_begin(&draw, "balls_and_balls");
    for (long n = draw_sample(60); n > 0; n--) {
        const int dim = draw_int(&draw, 2, 3);
        struct question question = {rounded_core(dim, draw_int(&draw, 0, 3), 0, 0),
                                    rounded_core(dim, draw_int(&draw, 0, 3), 0, 0), 1};
        double way[FMB_DIM_MAX];
        const double length = draw_way(&draw, dim, draw_int(&draw, 1, dim), way);
        draw_integers(&draw, dim, -9, 9, question.a.origin);
        if (draw_coin(&draw)) /* about the origin */
            memset(question.a.origin, 0, sizeof question.a.origin);
        for (int axis = 0; axis < dim; axis++)
            question.b.origin[axis] = question.a.origin[axis] + way[axis];
        assert_true(closed_forms(&draw, &question, length));
    }
}

/* The point of the box next to the ball is its corner along the numbers that are not 0. */
static void balls_and_boxes(void **state)
{
    static const enum fmb_shape shapes[] = {FMB_BOX, FMB_CUBOID};
    struct draw draw;
    draw_begin(&draw, "balls_and_boxes");
    for (long n = draw_sample(60); n > 0; n--) {
        const int dim = draw_int(&draw, 2, 3), shape = draw_int(&draw, 0, 1);
        struct question question = {
            {.dim = dim, .shape = shapes[shape], .as_hull = draw_int(&draw, 0, 3) == 0},
            rounded_core(dim, draw_int(&draw, 0, 3), 0, 0),
            1};
        double way[FMB_DIM_MAX];
        const double length = draw_way(&draw, dim, draw_int(&draw, 1, dim), way);
        draw_integers(&draw, dim, -9, 9, question.a.origin);
        for (int axis = 0; axis < dim; axis++) {
            const int half = draw_int(&draw, way[axis] == 0, 4);
            question.a.component[axis][axis] = 2 * half;
            if (shapes[shape] == FMB_CUBOID)
                question.a.local[axis] = -half;
            const double within =
                way[axis] == 0 ? draw_int(&draw, -half, half) : copysign(half, way[axis]);
            question.b.origin[axis] = question.a.origin[axis] + within + way[axis];
        }
        assert_true(closed_forms(&draw, &question, length));
    }
}

/* Beside a capsule the way is across its axis; before an end any that leads on. */
static void balls_and_capsules(void **state)
{
    struct draw draw;
    draw_begin(&draw, "balls_and_capsules");
    for (long n = draw_sample(60); n > 0; n--) {
        const int dim = draw_int(&draw, 2, 3), axis = draw_int(&draw, 0, dim - 1);
        const int long_side = draw_int(&draw, 1, 99);
        struct question question = {rounded_core(dim, draw_int(&draw, 0, 3), axis, long_side),
                                    rounded_core(dim, draw_int(&draw, 0, 3), 0, 0), 1};
        double way[FMB_DIM_MAX];
        double length;
        const bool beside = draw_coin(&draw);
        do
            length = draw_way(&draw, dim, draw_int(&draw, 1, beside ? dim - 1 : dim), way);
        while (beside && way[axis] != 0);
        const double along = beside ? draw_int(&draw, 0, long_side) : way[axis] > 0 ? long_side : 0;
        draw_integers(&draw, dim, -9, 9, question.a.origin);
        for (int i = 0; i < dim; i++)
            question.b.origin[i] = question.a.origin[i] + way[i] + (i == axis ? along : 0);
        assert_true(closed_forms(&draw, &question, length));
    }
}

/* Capsules whose axes are across each other, side by side, or end to end. */
static void capsules_and_capsules(void **state)
{
    struct draw draw;
    draw_begin(&draw, "capsules_and_capsules");
    for (long n = draw_sample(60); n > 0; n--) {
        const int one = draw_int(&draw, 0, 2), other = draw_int(&draw, 0, 2);
        struct question question = {rounded_core(3, draw_int(&draw, 0, 3), one, 8),
                                    rounded_core(3, draw_int(&draw, 0, 3), other, 6), 1};
        double way[FMB_DIM_MAX];
        double length;
        do
            length = draw_way(&draw, 3, draw_int(&draw, 1, 2), way);
        while (way[one] != 0 || way[other] != 0);
        for (int i = 0; i < 3; i++)
            question.b.origin[i] = way[i];
        question.b.origin[one] += draw_int(&draw, 0, 8);
        question.b.origin[other] -= draw_int(&draw, 0, 6);
        assert_true(closed_forms(&draw, &question, length));
    }
}

/* ---- Bodies of frames ---- */

/* Whole numbers, some frames with a radius. */
static void draw_frames(struct draw *draw, int dim, int count, double *memory,
                        struct fmb_frame *frames)
{
    for (int i = 0; i < count; i++) {
        struct solid solid = rounded_core(dim, draw_int(draw, 0, 3), draw_int(draw, 0, dim - 1),
                                          draw_int(draw, 0, 3));
        double number[SOLID_NUMBERS_MAX];
        for (int k = 0; k < dim && draw_coin(draw); k++)
            solid.component[k][k] = draw_int(draw, 0, 4);
        for (int axis = 0; axis < dim; axis++)
            solid.local[axis] += draw_int(draw, -6, 6);
        const size_t count_of = (size_t) solid_numbers(&solid, number);
        assert_int_equal(
            solid.shape == FMB_HULL
                ? fmb_frame_make_hull(dim, number, count_of,
                                      memory + (size_t) i * fmb_hull_doubles(dim, 2), &frames[i])
                : fmb_frame_make(dim, (int) solid.shape, number, count_of, &frames[i]),
            FMB_OK);
        if (draw_int(draw, 0, 2) > 0)
            assert_int_equal(fmb_frame_inflate(&frames[i], draw_int(draw, 0, 5)), FMB_OK);
    }
}

static void bodies_of_several_frames(void **state)
{
    enum { FRAMES = 3 };
    struct draw draw;
    long bad = 0, meet = 0;
    draw_begin(&draw, "bodies_of_several_frames");
    double *memory = malloc(2 * FRAMES * fmb_hull_doubles(3, 2) * sizeof *memory);
    assert_non_null(memory);
    for (long n = draw_sample(150); n > 0; n--) {
        struct fmb_frame frames[2][FRAMES];
        struct fmb_body body[2];
        struct pair pair = {.duration = draw_int(&draw, 1, 3)};
        struct fmb_placement *placed[2] = {&pair.a, &pair.b};
        struct oracle_answer truth;
        const int dim = draw_int(&draw, 2, 3);
        for (int side = 0; side < 2; side++) {
            const int count = draw_int(&draw, 1, FRAMES);
            draw_frames(&draw, dim, count, memory + (size_t) side * FRAMES * fmb_hull_doubles(3, 2),
                        frames[side]);
            assert_int_equal(fmb_body_make_frames(frames[side], (size_t) count, &body[side]),
                             FMB_OK);
            placed[side]->body = &body[side];
            draw_integers(&draw, dim, -9, 9, placed[side]->position);
            if (draw_coin(&draw))
                draw_integers(&draw, dim, -3, 3, placed[side]->velocity);
        }
        oracle_init(&truth);
        oracle_decide(&pair, FMB_WANT_BOX, &truth);
        const struct subject subject = {&pair, NULL, &truth};
        meet += truth.verdict != FMB_SEPARATED;
        if (!is_right(&subject)) {
            print_message("# draw %ld\n", n);
            bad++;
        }
        oracle_clear(&truth);
    }
    free(memory);
    printf("# %ld meet\n", meet);
    assert_int_equal(bad, 0);
}

/* ---- Frames and bodies ---- */

/* A radius of 0 changes no bit of a frame or body, and so of no answer. */
static void a_radius_of_0_is_none(void **state)
{
    static struct trial trial, other;
    for (size_t f = 0; family_any_at(f); f++) {
        struct cell cells[CELL_OF_ALL_SHAPES];
        const int count = family_cells(family_any_at(f), cells);
        for (int c = (int) f % 5; c < count; c += 5) {
            struct draw draw = cell_draw(13, family_any_at(f)->name, &cells[c], 0);
            struct question question;
            family_draw(family_any_at(f), &cells[c], &draw, &question);
            trial_begin(&question, &trial);
            trial_begin(&question, &other);
            for (int side = 0; side < 2; side++)
                for (unsigned i = 0; i < other.body[side].frame_count; i++)
                    assert_int_equal(fmb_frame_inflate(&other.frame[side][i], i % 2 ? -0.0 : 0),
                                     FMB_OK);
            for (int side = 0; side < 2; side++)
                assert_int_equal(
                    fmb_body_make_frames(other.frame[side], other.body[side].frame_count,
                                         &other.body[side]),
                    FMB_OK);
            for (int m = 0; m < trial_methods(); m++) {
                const struct fmb_method *method = fmb_method_at((size_t) m);
                const unsigned want = method->certain ? ALL : 0;
                const struct reply one = trial_decide(&trial, method, 0, want);
                const struct reply two = trial_decide(&other, method, 0, want);
                assert_true(one.status == two.status && same_parts(&one.answer, &two.answer, want));
            }
            trial_end(&trial);
            trial_end(&other);
        }
    }
}

/* Whether the box and the reach of a body contain its points. */
static bool contains_itself(const struct fmb_body *body)
{
    const struct fmb_placement placement = {.body = body};
    struct rational_solid solid;
    mpq_t none, end, other;
    bool contains = true;
    mpq_inits(none, end, other, NULL);
    rational_solid_init(fmb_body_frame(body, 0), &placement, &solid);
    for (int axis = 0; axis < body->dim; axis++)
        for (int sign = -1; sign <= 1; sign += 2) {
            const double of_body = sign * body->box[sign > 0][axis];
            rational_solid_farthest(&solid, none, axis, sign, end);
            if (isfinite(of_body)) {
                mpq_set_d(other, of_body);
                contains = contains && mpq_cmp(end, other) <= 0;
            }
            if (isfinite(body->reach)) {
                mpq_set_d(other, body->reach);
                contains = contains && mpq_cmp(end, other) <= 0;
            }
        }
    rational_solid_clear(&solid);
    mpq_clears(none, end, other, NULL);
    return contains;
}

static void boxes_and_reach_grow(void **state)
{
    static const double radii[] = {0, 0x1p-1074, 0x1p-60, 1e-3, 1, 7, 1e9, 0x1p1000};
    for (size_t f = 0; family_any_at(f); f++) {
        struct cell cell;
        struct cell cells[CELL_OF_ALL_SHAPES];
        const int count = family_cells(family_any_at(f), cells);
        struct draw draw = cell_draw(17, family_any_at(f)->name, &cells[f % (size_t) count], 0);
        struct question question;
        static struct trial trial;
        cell = cells[f % (size_t) count];
        family_draw(family_any_at(f), &cell, &draw, &question);
        question.a.frames = question.b.frames = 1;
        for (size_t r = 0; r < COUNT(radii); r++) {
            question.a.radius = radii[r];
            trial_begin(&question, &trial);
            assert_true(contains_itself(&trial.body[0]));
            trial_end(&trial);
        }
    }
}

/* Inflating a body of one frame is inflating its frame. */
static void a_body_of_one_frame_is_inflated(void **state)
{
    static struct trial trial;
    struct draw draw;
    draw_begin(&draw, "a_body_of_one_frame_is_inflated");
    for (long n = draw_sample(100); n > 0; n--) {
        const struct cell cell = {3, draw_coin(&draw), {FMB_BOX, FMB_CUBOID}};
        struct question question;
        struct ready ready;
        family_draw_posed(&draw, &cell, &question);
        question.a.radius = draw_uniform(&draw, 0, 50);
        question.b.radius = draw_uniform(&draw, 0, 50);
        trial_begin(&question, &trial);
        referee_ready(&question, &ready);
        assert_true(ready.body[0].one.radius == question.a.radius);
        assert_memory_equal(ready.body[0].box, trial.body[0].box, sizeof ready.body[0].box);
        assert_true(ready.body[0].reach == trial.body[0].reach);
        const struct reply reply = trial_decide(&trial, fmb_method_default(), 0, ALL);
        struct fmb_answer answer;
        assert_int_equal(pair_decide(fmb_method_default(), &ready.pair, ALL, &answer), FMB_OK);
        assert_true(same_parts(&reply.answer, &answer, ALL));
        trial_end(&trial);
    }
}

/* A refused radius leaves the frame as it is. */
static void bad_radii_are_refused(void **state)
{
    static const struct {
        double radius;
        enum fmb_status status;
    } bad[] = {{-1, FMB_BAD_SIZE},
               {-0x1p-1074, FMB_BAD_SIZE},
               {NAN, FMB_NOT_FINITE},
               {HUGE_VAL, FMB_NOT_FINITE},
               {-HUGE_VAL, FMB_NOT_FINITE}};
    static const double size[3] = {1, 1, 1};
    struct fmb_frame frame;
    struct fmb_body body, several;
    assert_int_equal(fmb_frame_make(3, FMB_BOX, size, 3, &frame), FMB_OK);
    assert_int_equal(fmb_body_make(3, FMB_BOX, size, 3, &body), FMB_OK);
    for (size_t i = 0; i < COUNT(bad); i++) {
        struct fmb_frame other = frame;
        struct fmb_body changed = body;
        assert_int_equal(fmb_frame_inflate(&other, bad[i].radius), bad[i].status);
        assert_int_equal(fmb_body_inflate(&changed, bad[i].radius), bad[i].status);
        assert_memory_equal(&other, &frame, sizeof frame);
        assert_memory_equal(&changed, &body, sizeof body);
    }
    const struct fmb_frame two[2] = {frame, frame};
    assert_int_equal(fmb_body_make_frames(two, 2, &several), FMB_OK);
    assert_int_equal(fmb_body_inflate(&several, 1), FMB_WRONG_COUNT);
}

/* The last radius is the one that a frame or a body has. */
static void a_radius_replaces_another(void **state)
{
    static const double radii[] = {0, 0x1p-60, 1, 1e9};
    static const double numbers[] = {3, -2, 7, 0.1, 0.2, 0.3};
    for (size_t i = 0; i < COUNT(radii); i++) {
        struct fmb_frame frame, once;
        struct fmb_body body, other;
        assert_int_equal(fmb_frame_make(3, FMB_BOX, numbers, 6, &frame), FMB_OK);
        assert_int_equal(fmb_body_make(3, FMB_BOX, numbers, 6, &body), FMB_OK);
        once = frame;
        other = body;
        assert_int_equal(fmb_frame_inflate(&frame, 5), FMB_OK);
        assert_int_equal(fmb_frame_inflate(&frame, radii[i]), FMB_OK);
        assert_int_equal(fmb_frame_inflate(&once, radii[i]), FMB_OK);
        assert_memory_equal(&frame, &once, sizeof frame);
        assert_int_equal(fmb_body_inflate(&body, 5), FMB_OK);
        assert_int_equal(fmb_body_inflate(&body, radii[i]), FMB_OK);
        assert_int_equal(fmb_body_inflate(&other, radii[i]), FMB_OK);
        assert_memory_equal(&body, &other, sizeof body);
    }
}

int main(void)
{
    static const struct CMUnitTest others[] = {
        cmocka_unit_test(cases_by_hand),
        cmocka_unit_test(balls_and_balls),
        cmocka_unit_test(balls_and_boxes),
        cmocka_unit_test(balls_and_capsules),
        cmocka_unit_test(capsules_and_capsules),
        cmocka_unit_test(bodies_of_several_frames),
        cmocka_unit_test(a_radius_of_0_is_none),
        cmocka_unit_test(boxes_and_reach_grow),
        cmocka_unit_test(a_body_of_one_frame_is_inflated),
        cmocka_unit_test(bad_radii_are_refused),
        cmocka_unit_test(a_radius_replaces_another),
    };
    enum { FAMILIES_MAX = 40 };
    static struct CMUnitTest tests[COUNT(others) + FAMILIES_MAX];
    size_t count = 0;
    for (; count < COUNT(others); count++)
        tests[count] = others[count];
    for (size_t f = 0; family_round_at(f); f++) {
        assert_true(f < FAMILIES_MAX);
        tests[count++] =
            (struct CMUnitTest){.name = family_round_at(f)->name,
                                .test_func = family_is_right,
                                .initial_state = (void *) (uintptr_t) family_round_at(f)};
    }
    return _cmocka_run_group_tests("engine_round", tests, count, NULL, NULL);
}
