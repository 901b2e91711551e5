/* Method. The vertices of a placed frame are those of rational numbers: its origin is
 * p + R(q) o, its components R(q) c, with R(q) as fmb.h gives it. A point that both frames have at
 * time t is a solution of
 *
 *     oA + t vA + sum_i x_i a_i = oB + t vB + sum_i y_i b_i       (an equation an axis)
 *
 * within the bounds of the parameters: 0 <= x_i <= 1, and for a hull, a tetrahedron and a face,
 * whose a_i are all of their vertices, sum x_i = 1. The time is t = T tau, 0 <= tau <= 1.
 *
 * Contact: the programme has a solution.
 *
 * Overlap: it has one in which no x_i of a cuboid is at a bound, and no x_i of a hull is 0 (time
 * may be at its ends). The image of the open parameter set is the relative interior of the frame,
 * flat or not: linear maps take relative interiors to relative interiors. For the hull of n
 * vertices x_i = s + z_i, with z_i >= 0 and one s >= 0 for all: sum z_i + n s = 1, and s > 0 for
 * some solution if and only if all x_i > 0 for one. The solutions are a convex set, so if for each
 * strict inequality some solution meets it, the mean of these solutions meets them all. Hence: note
 * which inequalities the solutions seen so far meet, minimise the way to those not yet met, all at
 * once, until all are met or the best solution meets no new one; those left are then equations on
 * all solutions.
 *
 * Interval and box: the least and greatest t, and coordinate of A's point, over all solutions.
 * The box of the union over the window needs no more than that, as t is one of the variables.
 *
 * Bodies of several frames: every frame of one with every frame of the other; the strongest verdict
 * and the hulls.
 *
 * Radius: the sum of a frame and a ball has an interior, whatever the frame is. So frames with
 * radii overlap, touch or are apart as the distance of their cores over the window is less than the
 * sum of the radii, equal or greater. The squares of both are rational. */
#include "oracle.h"

#include "frames.h"
#include "lp.h"
#include "memory.h"
#include "world.h"

enum { NONE = -1, GOALS_MAX = 4 * FMB_DIM_MAX };

/* A strict inequality: that the variable is not at this place. */
struct goal {
    int variable;
    enum lp_place not ;
};

/* ---- The programme ---- */

/* Which variable of the programme is what. */
struct model {
    int dim;
    struct rational_solid solid[2];
    mpq_t duration;
    struct lp lp;
    int first[2]; /* parameter 0 of A, of B */
    int least[2]; /* s of A, of B; NONE for a cuboid */
    int tau;      /* NONE for a pair at rest */
    int near;     /* where within its box A's point is, in x; NONE without one */
    int variables;
    struct goal goal[GOALS_MAX]; /* of an overlap */
    int goals;
    mpq_t *row;  /* [variables]: coefficients, or costs */
    mpq_t right; /* right hand side, or value of a cost */
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

static void add_goals(struct model *model, int side)
{
    if (model->least[side] != NONE) {
        model->goal[model->goals++] = (struct goal){model->least[side], LP_AT_ZERO};
        return;
    }
    for (int i = 0; i < model->solid[side].count; i++)
        for (int end = 0; end < 2; end++)
            model->goal[model->goals++] =
                (struct goal){model->first[side] + i, end == 0 ? LP_AT_ZERO : LP_AT_ONE};
}

/* The window of a part near a point: the cores as they are at its first time. */
static void begin_at(struct model *model, const mpq_t time[2])
{
    for (int side = 0; side < 2; side++)
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            rational_add_product(model->solid[side].origin[axis], 1, time[0],
                                 model->solid[side].velocity[axis]);
    mpq_sub(model->duration, time[1], time[0]);
}

/* Frame i of a, and frame j of b. */
static void model_init(struct model *model, const struct pair *pair, unsigned i, unsigned j,
                       struct frames_part *part)
{
    int next = 0;
    model->goals = 0;
    model->dim = pair->a.body->dim;
    rational_solid_init_at(fmb_body_frame(pair->a.body, i), &pair->a, pair->at, pair->duration,
                           &model->solid[0]);
    rational_solid_init_at(fmb_body_frame(pair->b.body, j), &pair->b, pair->at, pair->duration,
                           &model->solid[1]);
    for (int side = 0; side < 2; side++) {
        for (int axis = 0; axis < model->dim; axis++)
            mpq_add(model->solid[side].origin[axis], model->solid[side].origin[axis],
                    part->shift[side][axis]);
        model->first[side] = next;
        next += model->solid[side].count;
        model->least[side] = model->solid[side].hull ? next++ : NONE;
        add_goals(model, side);
    }
    model->tau = is_moving(model->solid) ? next++ : NONE;
    model->near = part->near ? next : NONE;
    next += part->near ? model->dim : 0;
    model->variables = next;
    lp_init(&model->lp, next);
    model->row = memory_get((size_t) next * sizeof *model->row);
    for (int v = 0; v < next; v++)
        mpq_init(model->row[v]);
    mpq_inits(model->duration, model->right, model->scratch, NULL);
    mpq_set_d(model->duration, pair->duration);
    if (part->near)
        begin_at(model, part->time);
}

static void model_clear(struct model *model)
{
    lp_clear(&model->lp);
    for (int side = 0; side < 2; side++)
        rational_solid_clear(&model->solid[side]);
    for (int v = 0; v < model->variables; v++)
        mpq_clear(model->row[v]);
    free(model->row);
    mpq_clears(model->duration, model->right, model->scratch, NULL);
}

static void zero_row(struct model *model)
{
    for (int v = 0; v < model->variables; v++)
        mpq_set_ui(model->row[v], 0, 1);
}

/* Sets in row the coefficients of sign * (t v + sum x_i c_i) along the axis, except those of the
 * other frame; of the time it adds. */
static void add_frame(struct model *model, int side, int axis, int sign)
{
    struct rational_solid *solid = &model->solid[side];
    const int least = model->least[side];
    mpq_set_si(model->scratch, sign, 1);
    for (int i = 0; i < solid->count; i++) {
        mpq_t *at = &model->row[model->first[side] + i];
        mpq_mul(*at, solid->column[i][axis], model->scratch);
        if (least != NONE)
            mpq_add(model->row[least], model->row[least], *at);
    }
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

/* The equation of an axis near a point: A's point is the lower end of the box and x times its size.
 */
static void add_near(struct model *model, int axis, struct frames_part *part)
{
    zero_row(model);
    add_frame(model, 0, axis, +1);
    mpq_sub(model->row[model->near + axis], part->box[0][axis], part->box[1][axis]);
    mpq_sub(model->right, part->box[0][axis], model->solid[0].origin[axis]);
    lp_add_row(&model->lp, model->row, model->right);
}

/* The equation of a hull: sum z_i + n s = 1. */
static void add_sum(struct model *model, int side)
{
    const int count = model->solid[side].count;
    if (model->least[side] == NONE)
        return;
    zero_row(model);
    for (int i = 0; i < count; i++)
        mpq_set_ui(model->row[model->first[side] + i], 1, 1);
    mpq_set_si(model->row[model->least[side]], count, 1);
    mpq_set_ui(model->right, 1, 1);
    lp_add_row(&model->lp, model->row, model->right);
}

/* Bit i is goal i: those that the solution meets. */
static unsigned met_here(const struct model *model)
{
    unsigned met = 0;
    for (int i = 0; i < model->goals; i++)
        if (lp_place(&model->lp, model->goal[i].variable) != model->goal[i].not )
            met |= 1U << i;
    return met;
}

/* Moves as far into the inequalities of missing as these together allow. */
static void minimise_way_to(struct model *model, unsigned missing)
{
    zero_row(model);
    for (int i = 0; i < model->goals; i++) {
        const int way = missing >> i & 1 ? model->goal[i].not == LP_AT_ZERO ? -1 : +1 : 0;
        mpq_set_si(model->scratch, way, 1);
        mpq_add(model->row[model->goal[i].variable], model->row[model->goal[i].variable],
                model->scratch);
    }
    lp_minimise(&model->lp, model->row, model->right);
}

static bool relative_interiors_meet(struct model *model)
{
    const unsigned all = (1U << model->goals) - 1;
    unsigned met = met_here(model);
    while (met != all) {
        minimise_way_to(model, all & ~met);
        const unsigned now = met | met_here(model);
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

/* Begins, and returns whether the cores meet. */
static bool model_meets(struct model *model, const struct pair *pair, unsigned i, unsigned j,
                        struct frames_part *part)
{
    model_init(model, pair, i, j, part);
    for (int axis = 0; axis < model->dim; axis++) {
        add_axis(model, axis);
        if (part->near)
            add_near(model, axis, part);
    }
    for (int side = 0; side < 2; side++)
        add_sum(model, side);
    return lp_make_feasible(&model->lp);
}

void frames_part_init(struct frames_part *part)
{
    part->near = false;
    for (int side = 0; side < 2; side++) {
        rational_vector_init(part->shift[side]);
        rational_vector_init(part->box[side]);
        mpq_init(part->time[side]);
    }
}

void frames_part_clear(struct frames_part *part)
{
    for (int side = 0; side < 2; side++) {
        rational_vector_clear(part->shift[side]);
        rational_vector_clear(part->box[side]);
        mpq_clear(part->time[side]);
    }
}

bool frames_meet(const struct pair *pair, unsigned i, unsigned j, struct frames_part *part,
                 mpq_t contact[2], mpq_t box[2][FMB_DIM_MAX])
{
    struct model model;
    const bool meet = model_meets(&model, pair, i, j, part);
    if (meet && contact)
        find_contact(&model, contact);
    if (meet && box)
        find_box(&model, box);
    model_clear(&model);
    return meet;
}

static bool has_radius(const struct pair *pair, unsigned i, unsigned j)
{
    return fmb_body_frame(pair->a.body, i)->radius != 0 ||
           fmb_body_frame(pair->b.body, j)->radius != 0;
}

static enum fmb_verdict rounded_verdict(const struct pair *pair, unsigned i, unsigned j)
{
    struct world world;
    world_init(&world, pair, i, j);
    const int order = world_compare(&world, NULL);
    world_clear(&world);
    return order > 0 ? FMB_SEPARATED : order == 0 ? FMB_TOUCHING : FMB_OVERLAPPING;
}

static void decide_frames(const struct pair *pair, unsigned i, unsigned j, unsigned want,
                          struct oracle_answer *truth)
{
    struct model model;
    struct frames_part whole;
    truth->rounded = has_radius(pair, i, j);
    if (truth->rounded) {
        truth->verdict = rounded_verdict(pair, i, j);
        truth->has_contact = truth->verdict != FMB_SEPARATED;
        truth->has_box = truth->has_contact && (want & FMB_WANT_BOX) != 0;
        return;
    }
    frames_part_init(&whole);
    const bool in_contact = model_meets(&model, pair, i, j, &whole);
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
    frames_part_clear(&whole);
}

enum fmb_verdict frames_verdict(const struct pair *pair, unsigned i, unsigned j)
{
    struct oracle_answer one;
    oracle_init(&one);
    decide_frames(pair, i, j, 0, &one);
    oracle_clear(&one);
    return one.verdict;
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
    sum->rounded = sum->rounded || one->rounded;
    sum->has_box = one->has_box;
}

void oracle_decide(const struct pair *pair, unsigned want, struct oracle_answer *truth)
{
    struct oracle_answer one;
    oracle_init(&one);
    truth->verdict = FMB_SEPARATED;
    truth->has_contact = truth->has_box = truth->rounded = false;
    for (unsigned i = 0; i < pair->a.body->frame_count; i++)
        for (unsigned j = 0; j < pair->b.body->frame_count; j++) {
            decide_frames(pair, i, j, want, &one);
            add_answer(truth, &one);
        }
    oracle_clear(&one);
}
