/* Method. With weights x_i of the vertices p_i of the one, y_i of the vertices q_i of the other:
 *
 *     sum x_i p_i + t v = sum y_i q_i + t w,   sum x_i = sum y_i = 1,   x_i, y_i >= 0
 *
 * The least of all weights, e, is a variable, and x_i = e + z_i: triangles have a point in common
 * just if this has a solution, and their relative interiors do just if it has one with e > 0 (a
 * point of the relative interior is a mean with weights that are all positive, whatever the rank
 * of the triangle is: Rockafellar, Convex Analysis, theorem 6.4). All variables are within [0, 1],
 * with t = T tau. */
#include "triangles.h"

#include <string.h>

#include "lp.h"

enum { WEIGHTS = 6, LEAST = 6, TAU = 7, VARIABLES = 8 };

struct programme {
    const struct triangle *pair;
    double duration;
    struct lp lp;
    mpq_t row[VARIABLES], value, term;
};

static void each(struct programme *p, void (*call)(mpq_ptr))
{
    for (int v = 0; v < VARIABLES; v++)
        call(p->row[v]);
    call(p->value);
    call(p->term);
}

static void clear_row(struct programme *p)
{
    for (int v = 0; v < VARIABLES; v++)
        mpq_set_ui(p->row[v], 0, 1);
}

/* Adds sign times the coordinate of a triangle's point to the row. */
static void add_coordinate(struct programme *p, int which, int axis, int sign)
{
    const struct triangle *triangle = &p->pair[which];
    for (int i = 0; i < 3; i++) {
        mpq_set_d(p->term, sign * triangle->vertex[i][axis]);
        mpq_add(p->row[3 * which + i], p->row[3 * which + i], p->term);
        mpq_add(p->row[LEAST], p->row[LEAST], p->term);
    }
    if (!triangle->moving)
        return;
    mpq_set_d(p->term, sign * triangle->velocity[axis]);
    mpq_set_d(p->value, p->duration);
    mpq_mul(p->term, p->term, p->value);
    mpq_add(p->row[TAU], p->row[TAU], p->term);
}

static void add_sum(struct programme *p, int which)
{
    clear_row(p);
    for (int i = 0; i < 3; i++)
        mpq_set_ui(p->row[3 * which + i], 1, 1);
    mpq_set_ui(p->row[LEAST], 3, 1);
    mpq_set_ui(p->value, 1, 1);
    lp_add_row(&p->lp, p->row, p->value);
}

/* Returns whether there is a point in common. */
static bool open(struct programme *p, const struct triangle pair[2], double duration)
{
    p->pair = pair;
    p->duration = duration;
    each(p, mpq_init);
    lp_init(&p->lp, pair[0].moving || pair[1].moving ? VARIABLES : TAU);
    for (int axis = 0; axis < 3; axis++) {
        clear_row(p);
        add_coordinate(p, 0, axis, 1);
        add_coordinate(p, 1, axis, -1);
        mpq_set_ui(p->value, 0, 1);
        lp_add_row(&p->lp, p->row, p->value);
    }
    add_sum(p, 0);
    add_sum(p, 1);
    return lp_make_feasible(&p->lp);
}

static void close_programme(struct programme *p)
{
    lp_clear(&p->lp);
    each(p, mpq_clear);
}

/* Minimises sign times what the row says; the row is no more then. */
static void extreme(struct programme *p, int sign, mpq_t out)
{
    if (sign < 0)
        for (int v = 0; v < VARIABLES; v++)
            mpq_neg(p->row[v], p->row[v]);
    lp_minimise(&p->lp, p->row, out);
    if (sign < 0)
        mpq_neg(out, out);
}

static bool interiors_meet(struct programme *p)
{
    clear_row(p);
    mpq_set_ui(p->row[LEAST], 1, 1);
    extreme(p, -1, p->value);
    return mpq_sgn(p->value) > 0;
}

static void find_ends(struct programme *p, struct triangles_answer *truth)
{
    const bool moving = p->pair[0].moving || p->pair[1].moving;
    for (int end = 0; end < 2; end++) {
        clear_row(p);
        mpq_set_d(p->row[TAU], p->duration);
        if (moving)
            extreme(p, end ? -1 : 1, truth->contact[end]);
        for (int axis = 0; axis < 3; axis++) {
            clear_row(p);
            add_coordinate(p, 0, axis, 1);
            extreme(p, end ? -1 : 1, truth->box[end][axis]);
        }
    }
}

void triangles_decide(const struct triangle pair[2], double duration, bool ends,
                      struct triangles_answer *truth)
{
    struct programme p;
    for (int end = 0; end < 2; end++)
        mpq_set_ui(truth->contact[end], 0, 1);
    truth->verdict = FMB_SEPARATED;
    if (open(&p, pair, duration)) {
        truth->verdict = interiors_meet(&p) ? FMB_OVERLAPPING : FMB_TOUCHING;
        if (ends)
            find_ends(&p, truth);
    }
    close_programme(&p);
}

static void each_of_answer(struct triangles_answer *truth, void (*call)(mpq_ptr))
{
    for (int end = 0; end < 2; end++) {
        call(truth->contact[end]);
        for (int axis = 0; axis < 3; axis++)
            call(truth->box[end][axis]);
    }
}

void triangles_init(struct triangles_answer *truth)
{
    each_of_answer(truth, mpq_init);
}

void triangles_clear(struct triangles_answer *truth)
{
    each_of_answer(truth, mpq_clear);
}
