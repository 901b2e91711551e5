/* Method. The vertices of a placed frame are those of rational numbers: its origin is
 * p + R(q) o, its components R(q) c, with R(q) as fmb.h gives it. A point that both frames have at
 * time t is a solution of
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
 * The box of the union over the window needs no more than that, as t is one of the variables.
 *
 * Bodies of several frames: every frame of one with every frame of the other; the strongest verdict
 * and the hulls. */
#include "oracle.h"

#include "lp.h"
#include "rational_solid.h"

enum { NONE = -1 };

/* ---- The programme ---- */

/* Which variable of the programme is what. */
struct model {
    int dim;
    struct rational_solid solid[2];
    mpq_t duration;
    struct lp lp;
    int first[2]; /* parameter 0 of A, of B */
    int rest[2];  /* of A, of B; NONE for a cuboid */
    int tau;      /* NONE for a pair at rest */
    int variables;
    mpq_t row[LP_VARIABLES_MAX]; /* of coefficients, or costs */
    mpq_t right;                 /* right hand side, or value of a cost */
    mpq_t scratch;
};

static bool is_moving(const struct rational_solid solid[2])
{
    for (int side = 0; side < 2; side++)
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            if (mpq_sgn(solid[side].velocity[axis]) != 0)
                return true;
    return false;
}

/* Frame i of a, and frame j of b. */
static void model_init(struct model *model, const struct pair *pair, unsigned i, unsigned j)
{
    int next = 0;
    model->dim = pair->a.body->dim;
    rational_solid_init(fmb_body_frame(pair->a.body, i), &pair->a, &model->solid[0]);
    rational_solid_init(fmb_body_frame(pair->b.body, j), &pair->b, &model->solid[1]);
    for (int side = 0; side < 2; side++) {
        model->first[side] = next;
        next += model->solid[side].count;
        model->rest[side] = model->solid[side].simplex ? next++ : NONE;
    }
    model->tau = is_moving(model->solid) ? next++ : NONE;
    model->variables = next;
    lp_init(&model->lp, next);
    for (int v = 0; v < next; v++)
        mpq_init(model->row[v]);
    mpq_inits(model->duration, model->right, model->scratch, NULL);
    mpq_set_d(model->duration, pair->duration);
}

static void model_clear(struct model *model)
{
    lp_clear(&model->lp);
    for (int side = 0; side < 2; side++)
        rational_solid_clear(&model->solid[side]);
    for (int v = 0; v < model->variables; v++)
        mpq_clear(model->row[v]);
    mpq_clears(model->duration, model->right, model->scratch, NULL);
}

static void zero_row(struct model *model)
{
    for (int v = 0; v < model->variables; v++)
        mpq_set_ui(model->row[v], 0, 1);
}

/* Adds to row the coefficients of sign * (T tau v + sum x_i c_i) along the axis. */
static void add_frame(struct model *model, int side, int axis, int sign)
{
    struct rational_solid *solid = &model->solid[side];
    mpq_set_si(model->scratch, sign, 1);
    for (int i = 0; i < solid->count; i++)
        mpq_mul(model->row[model->first[side] + i], solid->component[i][axis], model->scratch);
    if (model->tau != NONE)
        rational_add_product(model->row[model->tau], sign, solid->velocity[axis], model->duration);
}

/* The equation of an axis: A's point - B's point = 0. */
static void add_axis(struct model *model, int axis)
{
    zero_row(model);
    add_frame(model, 0, axis, +1);
    add_frame(model, 1, axis, -1);
    mpq_sub(model->right, model->solid[1].origin[axis], model->solid[0].origin[axis]);
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
    mpq_set_ui(contact[0], 0, 1);
    mpq_set(contact[1], model->duration);
    for (int end = 0; end < 2 && model->tau != NONE; end++) {
        zero_row(model);
        mpq_set(model->row[model->tau], model->duration);
        extreme(model, end == 0 ? +1 : -1, contact[end]);
    }
}

static void find_box(struct model *model, mpq_t box[2][FMB_DIM_MAX])
{
    for (int axis = 0; axis < model->dim; axis++)
        for (int end = 0; end < 2; end++) {
            zero_row(model);
            add_frame(model, 0, axis, +1);
            extreme(model, end == 0 ? +1 : -1, box[end][axis]);
            mpq_add(box[end][axis], box[end][axis], model->solid[0].origin[axis]);
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

static void decide_frames(const struct pair *pair, unsigned i, unsigned j, unsigned want,
                          struct oracle_answer *truth)
{
    struct model model;
    model_init(&model, pair, i, j);
    for (int axis = 0; axis < model.dim; axis++)
        add_axis(&model, axis);
    for (int side = 0; side < 2; side++)
        add_sum(&model, side);

    const bool in_contact = lp_make_feasible(&model.lp);
    truth->has_contact = in_contact;
    truth->has_box = in_contact && (want & FMB_WANT_BOX) != 0;
    truth->verdict = FMB_SEPARATED;
    if (in_contact) {
        truth->verdict = relative_interiors_meet(&model) ? FMB_OVERLAPPING : FMB_TOUCHING;
        find_contact(&model, truth->contact);
    }
    if (truth->has_box)
        find_box(&model, truth->box);
    model_clear(&model);
}

/* Makes end the hull of both: sign -1 the lower one, +1 the upper one. */
static void widen(mpq_t end, int sign, const mpq_t other)
{
    if (sign * mpq_cmp(other, end) > 0)
        mpq_set(end, other);
}

static void add_answer(struct oracle_answer *sum, const struct oracle_answer *one)
{
    if (!one->has_contact)
        return;
    sum->verdict = one->verdict > sum->verdict ? one->verdict : sum->verdict;
    for (int end = 0; end < 2; end++) {
        const int sign = end == 0 ? -1 : +1;
        if (!sum->has_contact)
            mpq_set(sum->contact[end], one->contact[end]);
        widen(sum->contact[end], sign, one->contact[end]);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            if (!sum->has_box)
                mpq_set(sum->box[end][axis], one->box[end][axis]);
            widen(sum->box[end][axis], sign, one->box[end][axis]);
        }
    }
    sum->has_contact = true;
    sum->has_box = one->has_box;
}

void oracle_decide(const struct pair *pair, unsigned want, struct oracle_answer *truth)
{
    struct oracle_answer one;
    oracle_init(&one);
    truth->verdict = FMB_SEPARATED;
    truth->has_contact = truth->has_box = false;
    for (unsigned i = 0; i < pair->a.body->frame_count; i++)
        for (unsigned j = 0; j < pair->b.body->frame_count; j++) {
            decide_frames(pair, i, j, want, &one);
            add_answer(truth, &one);
        }
    oracle_clear(&one);
}
