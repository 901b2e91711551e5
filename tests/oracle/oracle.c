/* Method. A point that both frames have at time t is a solution of
 *
 *     oA + t vA + sum_i x_i a_i = oB + t vB + sum_i y_i b_i       (an equation an axis)
 *
 * within the bounds of the parameters. Three devices put all variables between 0 and 1 and
 * leave no other inequality:
 *   - the time is t = T tau;
 *   - the sum of a tetrahedron (a face) is made equal: sum x_i + s = 1, with a rest s >= 0;
 *   - what is said of the bounds of a tetrahedron then follows from all of its parameters and
 *     its rest being >= 0, and they are <= 1 of themselves.
 *
 * Contact: the programme has a solution.
 *
 * Overlap: it has one in which no parameter and no rest is at a bound, that is, each is > 0
 * and < 1 (time may be at its ends). The image of the open parameter set is the relative
 * interior of the frame, flat or not: linear maps take relative interiors to relative interiors.
 * The solutions are a convex set, so if for each such strict inequality some solution meets it,
 * the mean of these solutions meets them all. Hence: note which inequalities the solutions seen
 * so far meet, minimise the way to those not yet met, all at once, until all are met or the
 * best solution meets no new one; those left are then equations on all solutions.
 *
 * Interval and box: the least and greatest t, and coordinate of A's point, over all solutions.
 * The box of the union over the window needs no more than that, as t is one of the variables. */
#include "oracle.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "lp.h"

enum { NONE = -1 };

/* Which variable of the programme is what. */
struct model {
    const struct fmb_pair *pair;
    struct lp lp;
    int first[2]; /* parameter 0 of A, of B */
    int rest[2];  /* of A, of B; NONE for a cuboid */
    int tau;      /* NONE for a static pair */
    int variables;
    mpq_t row[LP_VARIABLES_MAX]; /* of coefficients, or costs */
    mpq_t right;                 /* right hand side, or value of a cost */
    mpq_t scratch[2];
};

static const struct fmb_frame *frame_of(const struct fmb_pair *pair, int side)
{
    return side == 0 ? &pair->a : &pair->b;
}

static bool is_moving(const struct fmb_pair *pair)
{
    return pair->a.moving || pair->b.moving;
}

/* A frame without a velocity stands still. */
static double velocity_of(const struct fmb_frame *frame, int axis)
{
    return frame->moving ? frame->velocity[axis] : 0;
}

static void model_init(struct model *model, const struct fmb_pair *pair)
{
    int next = 0;
    model->pair = pair;
    for (int side = 0; side < 2; side++) {
        const struct fmb_body *body = frame_of(pair, side)->body;
        model->first[side] = next;
        next += body->count;
        model->rest[side] = body->shape == FMB_CUBOID ? NONE : next++;
    }
    model->tau = is_moving(pair) ? next++ : NONE;
    model->variables = next;
    lp_init(&model->lp, next);
    for (int v = 0; v < next; v++)
        mpq_init(model->row[v]);
    mpq_init(model->right);
    mpq_inits(model->scratch[0], model->scratch[1], NULL);
}

static void model_clear(struct model *model)
{
    lp_clear(&model->lp);
    for (int v = 0; v < model->variables; v++)
        mpq_clear(model->row[v]);
    mpq_clear(model->right);
    mpq_clears(model->scratch[0], model->scratch[1], NULL);
}

static void zero_row(struct model *model)
{
    for (int v = 0; v < model->variables; v++)
        mpq_set_ui(model->row[v], 0, 1);
}

/* Adds to row the coefficients of sign * (T tau v + sum x_i c_i) along the axis. */
static void add_frame(struct model *model, int side, int axis, int sign)
{
    const struct fmb_frame *frame = frame_of(model->pair, side);
    for (int i = 0; i < frame->body->count; i++)
        mpq_set_d(model->row[model->first[side] + i], sign * frame->body->component[i][axis]);
    if (model->tau == NONE)
        return;
    mpq_t *tau = &model->row[model->tau], *way = &model->scratch[0];
    mpq_set_d(*way, sign * velocity_of(frame, axis));
    mpq_set_d(model->scratch[1], model->pair->duration);
    mpq_mul(*way, *way, model->scratch[1]);
    mpq_add(*tau, *tau, *way);
}

/* The equation of an axis: A's point - B's point = 0. */
static void add_axis(struct model *model, int axis)
{
    zero_row(model);
    add_frame(model, 0, axis, +1);
    add_frame(model, 1, axis, -1);
    mpq_set_d(model->right, model->pair->b.origin[axis]);
    mpq_set_d(model->scratch[0], model->pair->a.origin[axis]);
    mpq_sub(model->right, model->right, model->scratch[0]);
    lp_add_row(&model->lp, model->row, model->right);
}

/* The equation of a tetrahedron or a face: parameters + rest = 1. */
static void add_sum(struct model *model, int side)
{
    if (model->rest[side] == NONE)
        return;
    zero_row(model);
    for (int v = model->first[side]; v <= model->rest[side]; v++)
        mpq_set_ui(model->row[v], 1, 1);
    mpq_set_ui(model->right, 1, 1);
    lp_add_row(&model->lp, model->row, model->right);
}

/* The strict inequalities that some solution has met: of variable v, bit 2v is z_v > 0 and bit
 * 2v+1 is z_v < 1. */
typedef unsigned met_t;
static met_t above_zero(int variable)
{
    return 1U << (2 * variable);
}
static met_t below_one(int variable)
{
    return 2U << (2 * variable);
}

static met_t met_here(const struct model *model)
{
    met_t met = 0;
    for (int v = 0; v < model->variables; v++) {
        enum lp_place place = lp_place(&model->lp, v);
        if (place != LP_AT_ZERO)
            met |= above_zero(v);
        if (place != LP_AT_ONE)
            met |= below_one(v);
    }
    return met;
}

static met_t met_by_all_parameters(const struct model *model)
{
    int parameters = model->tau == NONE ? model->variables : model->tau;
    return (1U << (2 * parameters)) - 1;
}

/* Moves as far into the inequalities of missing as these together allow. */
static void minimise_way_to(struct model *model, met_t missing)
{
    for (int v = 0; v < model->variables; v++) {
        int toward_one = (missing & above_zero(v)) != 0,
            toward_zero = (missing & below_one(v)) != 0;
        mpq_set_si(model->row[v], toward_zero - toward_one, 1);
    }
    lp_minimise(&model->lp, model->row, model->right);
}

static bool relative_interiors_meet(struct model *model)
{
    const met_t all = met_by_all_parameters(model);
    met_t met = met_here(model) & all;
    while (met != all) {
        minimise_way_to(model, all & ~met);
        met_t now = met | (met_here(model) & all);
        if (now == met)
            return false;
        met = now;
    }
    return true;
}

/* The least value of sign * (what row says), times sign: least for +1, greatest for -1. */
static void extreme(struct model *model, int sign, mpq_t out)
{
    if (sign < 0)
        for (int v = 0; v < model->variables; v++)
            mpq_neg(model->row[v], model->row[v]);
    lp_minimise(&model->lp, model->row, out);
    if (sign < 0)
        mpq_neg(out, out);
}

static void find_contact(struct model *model, mpq_t contact[2])
{
    for (int end = 0; end < 2; end++) {
        zero_row(model);
        mpq_set_d(model->row[model->tau], model->pair->duration);
        extreme(model, end == 0 ? +1 : -1, contact[end]);
    }
}

static void find_box(struct model *model, mpq_t box[2][FMB_DIM_MAX])
{
    for (int axis = 0; axis < model->pair->a.body->dim; axis++)
        for (int end = 0; end < 2; end++) {
            zero_row(model);
            add_frame(model, 0, axis, +1);
            extreme(model, end == 0 ? +1 : -1, box[end][axis]);
            mpq_set_d(model->scratch[0], model->pair->a.origin[axis]);
            mpq_add(box[end][axis], box[end][axis], model->scratch[0]);
        }
}

void oracle_init(struct oracle_answer *truth)
{
    for (int end = 0; end < 2; end++) {
        mpq_init(truth->contact[end]);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            mpq_init(truth->box[end][axis]);
    }
}

void oracle_clear(struct oracle_answer *truth)
{
    for (int end = 0; end < 2; end++) {
        mpq_clear(truth->contact[end]);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            mpq_clear(truth->box[end][axis]);
    }
}

void oracle_decide(const struct fmb_pair *pair, unsigned want, struct oracle_answer *truth)
{
    struct model model;
    model_init(&model, pair);
    for (int axis = 0; axis < pair->a.body->dim; axis++)
        add_axis(&model, axis);
    for (int side = 0; side < 2; side++)
        add_sum(&model, side);

    bool in_contact = lp_make_feasible(&model.lp);
    truth->has_contact = in_contact && is_moving(pair);
    truth->has_box = in_contact && (want & FMB_WANT_BOX) != 0;
    truth->verdict = FMB_SEPARATED;
    if (in_contact)
        truth->verdict = relative_interiors_meet(&model) ? FMB_OVERLAPPING : FMB_TOUCHING;
    if (truth->has_contact)
        find_contact(&model, truth->contact);
    if (truth->has_box)
        find_box(&model, truth->box);
    model_clear(&model);
}

/* ---- Is an answer right? ---- */

/* Always false, so that a check can end with it. */
__attribute__((format(printf, 3, 4))) static bool wrong(char *why, size_t size, const char *format,
                                                        ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(why, size, format, arguments);
    va_end(arguments);
    return false;
}

/* The sign of a double minus a rational; the double may be infinite. */
static int compare(double number, const mpq_t exact)
{
    if (isinf(number))
        return number > 0 ? 1 : -1;
    mpq_t rational;
    mpq_init(rational);
    mpq_set_d(rational, number);
    int order = mpq_cmp(rational, exact);
    mpq_clear(rational);
    return order;
}

/* An end goes out by its sign: -1 for the lower one, +1 for the upper one. Contains: the true
 * end is not beyond it. */
static bool contains(double end, int sign, const mpq_t exact)
{
    return sign * compare(end, exact) >= 0;
}

/* The next double inwards would cut the true end off (or is no double of this world). */
static bool is_tightest(double end, int sign, const mpq_t exact)
{
    return !contains(nextafter(end, -sign * HUGE_VAL), sign, exact);
}

/* |end - exact| <= 1e-12 size. */
static bool is_close(double end, const mpq_t exact, const mpq_t size)
{
    mpq_t way, most;
    mpq_inits(way, most, NULL);
    mpq_set_d(way, end);
    mpq_sub(way, way, exact);
    mpq_abs(way, way);
    mpq_set_ui(most, 1, 1000000000000);
    mpq_mul(most, most, size);
    bool close = mpq_cmp(way, most) <= 0;
    mpq_clears(way, most, NULL);
    return close;
}

/* The greatest of sign * (coordinate of a vertex of the frame over the window): a cuboid's sums
 * all components that add, a tetrahedron's takes the one that adds most. */
static void farthest(const struct fmb_pair *pair, int side, int axis, int sign, mpq_t out)
{
    const struct fmb_frame *frame = frame_of(pair, side);
    mpq_t term, duration, most;
    mpq_inits(term, duration, most, NULL);
    mpq_set_d(out, sign * frame->origin[axis]);
    mpq_set_d(term, sign * velocity_of(frame, axis));
    mpq_set_d(duration, is_moving(pair) ? pair->duration : 0);
    mpq_mul(term, term, duration);
    if (mpq_sgn(term) > 0)
        mpq_add(out, out, term);
    for (int i = 0; i < frame->body->count; i++) {
        mpq_set_d(term, sign * frame->body->component[i][axis]);
        if (mpq_sgn(term) <= 0)
            continue;
        if (frame->body->shape == FMB_CUBOID)
            mpq_add(most, most, term);
        else if (mpq_cmp(term, most) > 0)
            mpq_set(most, term);
    }
    mpq_add(out, out, most);
    mpq_clears(term, duration, most, NULL);
}

/* The largest absolute coordinate of any vertex of either frame over the window. */
static void size_of_pair(const struct fmb_pair *pair, mpq_t out)
{
    mpq_t one;
    mpq_init(one);
    mpq_set_ui(out, 0, 1);
    for (int side = 0; side < 2; side++)
        for (int axis = 0; axis < pair->a.body->dim; axis++)
            for (int sign = -1; sign <= 1; sign += 2) {
                farthest(pair, side, axis, sign, one);
                if (mpq_cmp(one, out) > 0)
                    mpq_set(out, one);
            }
    mpq_clear(one);
}

/* +1, -1: beyond the largest double, on that side; 0: not beyond. */
static int beyond_doubles(const mpq_t exact)
{
    if (compare(DBL_MAX, exact) < 0)
        return 1;
    return compare(-DBL_MAX, exact) > 0 ? -1 : 0;
}

/* What all ends have in common. sign as above. */
static bool end_agrees(const char *name, double end, int sign, const mpq_t exact, char *why,
                       size_t size)
{
    if (isnan(end))
        return wrong(why, size, "%s: not a number", name);
    if (end == 0 && signbit(end))
        return wrong(why, size, "%s: -0", name);
    if (!contains(end, sign, exact))
        return wrong(why, size, "%s: %a cuts the true %.17g off", name, end, mpq_get_d(exact));
    return true;
}

static bool contact_agrees(const struct oracle_answer *truth, const struct fmb_pair *pair,
                           const struct fmb_answer *answer, enum oracle_limit limit, char *why,
                           size_t size)
{
    static const char *const names[2] = {"first contact", "last contact"};
    mpq_t duration;
    mpq_init(duration);
    mpq_set_d(duration, pair->duration);
    bool good = true;
    for (int e = 0; e < 2 && good; e++) {
        const double end = answer->contact[e];
        const int sign = e == 0 ? -1 : +1;
        good = end_agrees(names[e], end, sign, truth->contact[e], why, size);
        if (good && !(end >= 0 && end <= pair->duration))
            good = wrong(why, size, "%s: %a is out of the window", names[e], end);
        if (good && !is_tightest(end, sign, truth->contact[e]) &&
            (limit == ORACLE_TIGHTEST || !is_close(end, truth->contact[e], duration)))
            good = wrong(why, size, "%s: %a is too far out from %.17g", names[e], end,
                         mpq_get_d(truth->contact[e]));
    }
    mpq_clear(duration);
    return good;
}

/* scale: the size of the pair. */
static bool box_end_agrees(const char *name, double end, int sign, const mpq_t exact,
                           const mpq_t scale, enum oracle_limit limit, char *why, size_t size)
{
    const int beyond = beyond_doubles(exact);
    if (beyond != 0)
        return end == beyond * HUGE_VAL ||
               wrong(why, size, "%s: %a, and the true one is beyond the doubles", name, end);
    if (!end_agrees(name, end, sign, exact, why, size))
        return false;
    if (isinf(end))
        return wrong(why, size, "%s: infinite, and the true one is not", name);
    return is_tightest(end, sign, exact) ||
           (limit == ORACLE_DESIGN && is_close(end, exact, scale)) ||
           wrong(why, size, "%s: %a is too far out from %.17g", name, end, mpq_get_d(exact));
}

static bool box_agrees(const struct oracle_answer *truth, const struct fmb_pair *pair,
                       const struct fmb_answer *answer, enum oracle_limit limit, char *why,
                       size_t size)
{
    static const char *const names[2][FMB_DIM_MAX] = {{"lower x", "lower y", "lower z"},
                                                      {"upper x", "upper y", "upper z"}};
    const int dim = pair->a.body->dim;
    mpq_t scale;
    mpq_init(scale);
    size_of_pair(pair, scale);
    bool good = true;
    for (int e = 0; e < 2 && good; e++)
        for (int axis = 0; axis < FMB_DIM_MAX && good; axis++) {
            const double end = answer->box[e][axis];
            const char *name = names[e][axis];
            if (axis < dim)
                good = box_end_agrees(name, end, e == 0 ? -1 : +1, truth->box[e][axis], scale,
                                      limit, why, size);
            else if (end != 0 || signbit(end))
                good = wrong(why, size, "%s: %a, and there is no such axis", name, end);
        }
    mpq_clear(scale);
    return good;
}

bool oracle_agrees(const struct oracle_answer *truth, const struct fmb_pair *pair,
                   const struct fmb_answer *answer, enum oracle_limit limit, char *why, size_t size)
{
    if (answer->verdict != truth->verdict)
        return wrong(why, size, "verdict: %d, the true one is %d", answer->verdict, truth->verdict);
    if (answer->has_contact != truth->has_contact)
        return wrong(why, size, "contact interval: there should be %s",
                     truth->has_contact ? "one" : "none");
    if (answer->has_box != truth->has_box)
        return wrong(why, size, "box: there should be %s", truth->has_box ? "one" : "none");
    if (truth->has_contact && !contact_agrees(truth, pair, answer, limit, why, size))
        return false;
    return !truth->has_box || box_agrees(truth, pair, answer, limit, why, size);
}

static bool check(const struct fmb_pair *pair, unsigned want, const struct fmb_answer *answer,
                  enum oracle_limit limit, char *why, size_t size)
{
    struct oracle_answer truth;
    oracle_init(&truth);
    oracle_decide(pair, want, &truth);
    bool good = oracle_agrees(&truth, pair, answer, limit, why, size);
    oracle_clear(&truth);
    return good;
}

bool oracle_check(const struct fmb_pair *pair, unsigned want, const struct fmb_answer *answer,
                  char *why, size_t size)
{
    return check(pair, want, answer, ORACLE_DESIGN, why, size);
}

bool oracle_check_tightest(const struct fmb_pair *pair, unsigned want,
                           const struct fmb_answer *answer, char *why, size_t size)
{
    return check(pair, want, answer, ORACLE_TIGHTEST, why, size);
}

/* ---- How far off is an answer? ---- */

/* (end - exact) / scale, rounded; 0/0 is 0. An end that is infinite is right where the true one is
 * beyond the doubles. */
static double relative_error(double end, const mpq_t exact, const mpq_t scale)
{
    const int beyond = beyond_doubles(exact);
    if (beyond != 0)
        return end == beyond * HUGE_VAL ? 0 : -beyond * HUGE_VAL;
    if (isinf(end))
        return end;
    mpq_t error;
    mpq_init(error);
    mpq_set_d(error, end);
    mpq_sub(error, error, exact);
    double relative = mpq_sgn(error) == 0 ? 0 : mpq_sgn(error) * HUGE_VAL;
    if (mpq_sgn(scale) != 0) {
        mpq_div(error, error, scale);
        relative = mpq_get_d(error);
    }
    mpq_clear(error);
    return relative;
}

/* sign as for contains(). */
static void measure_end(double end, int sign, const mpq_t exact, const mpq_t scale,
                        struct oracle_excess *excess)
{
    excess->has = true;
    if (isnan(end) || !contains(end, sign, exact))
        excess->misses = true;
    if (isnan(end)) {
        excess->in = HUGE_VAL;
        return;
    }
    double out = sign * relative_error(end, exact, scale);
    excess->out = fmax(excess->out, out);
    excess->in = fmax(excess->in, -out);
}

void oracle_measure(const struct oracle_answer *truth, const struct fmb_pair *pair,
                    const struct fmb_answer *answer, struct oracle_excess *contact,
                    struct oracle_excess *box)
{
    mpq_t scale;
    mpq_init(scale);
    *contact = *box = (struct oracle_excess){0};
    if (truth->has_contact && answer->has_contact) {
        mpq_set_d(scale, pair->duration);
        for (int e = 0; e < 2; e++)
            measure_end(answer->contact[e], e == 0 ? -1 : +1, truth->contact[e], scale, contact);
    }
    if (truth->has_box && answer->has_box) {
        size_of_pair(pair, scale);
        for (int e = 0; e < 2; e++)
            for (int axis = 0; axis < pair->a.body->dim; axis++)
                measure_end(answer->box[e][axis], e == 0 ? -1 : +1, truth->box[e][axis], scale,
                            box);
    }
    mpq_clear(scale);
}
