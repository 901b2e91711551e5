#include "support_integers.h"

#include "integer.h"
#include "motion.h"

void support_integers_each(struct support_integers *integers, void (*call)(mpz_ptr))
{
    for (int f = 0; f < 2; f++) {
        INTEGER_EACH_FROM(row, &integers->side[f].turn, call);
        INTEGER_EACH_FROM(factor, &integers->side[f], call);
    }
    INTEGER_EACH_FROM(scale, integers, call);
}

/* ---- Orientations ----
 *
 * For a quaternion q of integers, n R(q) is a matrix of integers, n = |q|^2. All lengths of a pair
 * are multiplied by scale: n_a n_b, or n_a if n_a = n_b. This changes no sign, no time and no
 * direction. Points are divided by scale at the end. */

static void set_given(const struct fmb_placement *placement, mpz_t q[4])
{
    struct limbs_quaternion quaternion;
    limbs_quaternion_set(placement, &quaternion);
    mpz_set_ui(q[0], 1);
    for (int i = 0; i < 4 && quaternion.turned; i++)
        integer_set(q[i], quaternion.at[i], quaternion.unit);
}

/* q := the orientation at a fraction of the window, a multiple of 2^-53, times a factor. */
static void set_between(const struct fmb_placement *placement, double at, mpz_t q[4])
{
    const struct dyadic late = dyadic_of(at), early = dyadic_of(1 - at);
    double end[2][4];
    mpz_t other;
    struct dyadic_span span = dyadic_span_begin();
    mpz_init(other);
    motion_quaternions(placement, end[0], end[1]);
    for (int i = 0; i < 4; i++) {
        dyadic_span_add(&span, dyadic_of(end[0][i]));
        dyadic_span_add(&span, dyadic_of(end[1][i]));
    }
    const long unit = span.unit + (late.exponent < early.exponent ? late.exponent : early.exponent);
    for (int i = 0; i < 4; i++) {
        integer_set_product(q[i], dyadic_of(end[0][i]), early, unit);
        integer_set_product(other, dyadic_of(end[1][i]), late, unit);
        mpz_add(q[i], q[i], other);
    }
    mpz_set_ui(other, 0);
    for (int i = 0; i < 4; i++)
        mpz_gcd(other, other, q[i]);
    for (int i = 0; i < 4; i++)
        mpz_divexact(q[i], q[i], other);
    mpz_clear(other);
}

void support_integers_polar(mpz_t x[4], mpz_t y[4], unsigned factor, mpz_t out[3][3], mpz_t norm,
                            mpz_t scratch)
{
    mpz_set_ui(norm, 0);
    for (int k = 0; k < 4; k++) {
        mpz_mul(scratch, x[k], y[k]);
        mpz_mul_ui(scratch, scratch, factor);
        mpz_add(norm, norm, scratch);
        for (int i = 0; i < 3; i++)
            (k == 0 || k == 1 + i ? mpz_add : mpz_sub)(out[i][i], out[i][i], scratch);
    }
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        mpz_mul(out[i][j], x[1 + i], y[1 + j]);
        mpz_addmul(out[i][j], x[1 + j], y[1 + i]);
        mpz_set(out[j][i], out[i][j]);
        mpz_mul(scratch, x[0], y[1 + k]);
        mpz_addmul(scratch, x[1 + k], y[0]);
        mpz_sub(out[i][j], out[i][j], scratch);
        mpz_add(out[j][i], out[j][i], scratch);
        mpz_mul_ui(out[i][j], out[i][j], factor);
        mpz_mul_ui(out[j][i], out[j][i], factor);
    }
}

static void set_turn(const struct fmb_placement *placement, bool posed, double at,
                     struct support_turn *turn)
{
    mpz_t q[4], product;
    mpz_inits(q[0], q[1], q[2], q[3], product, NULL);
    if (posed)
        set_between(placement, at, q);
    else
        set_given(placement, q);
    turn->turned = mpz_sgn(q[1]) != 0 || mpz_sgn(q[2]) != 0 || mpz_sgn(q[3]) != 0;
    if (turn->turned)
        support_integers_polar(q, q, 1, turn->row, turn->norm, product);
    else
        mpz_set_ui(turn->norm, 1);
    mpz_clears(q[0], q[1], q[2], q[3], product, NULL);
}

static void turn_vector(const struct support_turn *turn, const mpz_t factor, mpz_t v[3])
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

/* ---- Vertices ---- */

/* Sets the vertices of a frame that is not a hull, from its origin and components. The origin of a
 * box is its centre less half of each component. */
static void set_small(struct support_side *side, long unit)
{
    const struct fmb_frame *frame = side->frame;
    const bool box = frame->shape == FMB_BOX;
    const unsigned count = frame_vertex_count(frame);
    const double *origin = box ? frame->centre : frame->origin;
    mpz_t component;
    mpz_init(component);
    for (int axis = 0; axis < frame->dim; axis++) {
        for (unsigned k = 0; k < count; k++)
            integer_set(side->small[k][axis], dyadic_of(origin[axis]), unit);
        for (int i = 0; i < frame->count; i++) {
            integer_set_sum(component, frame->component[i][axis], frame->remainder[i][axis], unit);
            if (box)
                mpz_fdiv_q_2exp(component, component, 1); /* exact: it is even */
            for (unsigned k = 0; k < count; k++) {
                mpz_ptr x = side->small[k][axis];
                if (frame_vertex_has(frame, k, i))
                    mpz_add(x, x, component);
                else if (box)
                    mpz_sub(x, x, component);
            }
        }
    }
    mpz_clear(component);
}

void support_integers_path(const struct fmb_placement *placement, double duration, long unit,
                           mpz_t out[3])
{
    const struct dyadic window = dyadic_of(duration);
    for (int axis = 0; axis < placement->body->dim; axis++)
        if (placement->end_count)
            integer_set_sum(out[axis], placement->end_position[axis], -placement->position[axis],
                            unit);
        else
            integer_set_product(out[axis], dyadic_of(placement->velocity[axis]), window, unit);
}

/* Sets a frame, as support_integers_set() does. All lengths of the pair are multiples of
 * 2^integers->unit. */
static void set_side(const struct fmb_placement *placement, double duration, bool posed, double at,
                     const struct support_integers *integers, struct support_side *side)
{
    const struct dyadic late = dyadic_of(at);
    if (posed || placement->end_count == 0)
        support_integers_path(placement, duration, integers->unit, side->displacement);
    for (int axis = 0; axis < side->frame->dim; axis++) {
        mpz_ptr position = side->position[axis], way = side->displacement[axis];
        integer_set(position, dyadic_of(placement->position[axis]), integers->unit);
        if (posed) {
            mpz_mul_si(way, way, late.mantissa);
            if (late.mantissa)
                mpz_fdiv_q_2exp(way, way, (mp_bitcnt_t) -late.exponent);
            mpz_add(position, position, way);
            mpz_set_ui(way, 0);
        }
        mpz_mul(position, position, integers->scale);
        mpz_mul(way, way, integers->scale);
    }
}

long support_integers_unit(const struct frame_pair *frames)
{
    const struct fmb_placement *placed[2] = {frames->a.placement, frames->b.placement};
    struct dyadic_span span = limbs_span_of(frames);
    for (int f = 0; f < 2; f++)
        for (int axis = 0; axis < placed[f]->body->dim && placed[f]->end_count; axis++)
            dyadic_span_add(&span, dyadic_of(placed[f]->end_position[axis]));
    return span.unit;
}

void support_integers_bodies(const struct frame_pair *frames, long unit,
                             struct support_integers *out)
{
    out->unit = unit;
    for (int f = 0; f < 2; f++) {
        out->side[f].frame = f == 0 ? frames->a.frame : frames->b.frame;
        if (out->side[f].frame->shape != FMB_HULL)
            set_small(&out->side[f], unit);
    }
}

void support_integers_set(const struct frame_pair *frames, bool posed, double at,
                          struct support_integers *out)
{
    const struct placed_frame *placed[2] = {&frames->a, &frames->b};
    const struct dyadic late = dyadic_of(at);
    struct support_side *side = out->side;
    const long unit = posed ? support_integers_unit(frames) : limbs_span_of(frames).unit;
    support_integers_bodies(frames, posed && late.exponent < 0 ? unit + late.exponent : unit, out);
    for (int f = 0; f < 2; f++)
        set_turn(placed[f]->placement, posed, at, &side[f].turn);
    const bool same = mpz_cmp(side[0].turn.norm, side[1].turn.norm) == 0;
    mpz_set(out->scale, side[0].turn.norm);
    if (!same)
        mpz_mul(out->scale, out->scale, side[1].turn.norm);
    for (int f = 0; f < 2; f++) {
        if (same)
            mpz_set_ui(side[f].factor, 1);
        else
            mpz_set(side[f].factor, side[!f].turn.norm);
        set_side(placed[f]->placement, frames->duration, posed, at, out, &side[f]);
    }
    integer_set_sum(out->radius, frames->a.frame->radius, frames->b.frame->radius, out->unit);
    mpz_mul(out->radius, out->radius, out->scale);
    for (int axis = 0; axis < 3; axis++)
        mpz_sub(out->drift[axis], side[1].displacement[axis], side[0].displacement[axis]);
}

void support_integers_vertex(const struct support_integers *integers, int f, unsigned i,
                             mpz_t out[3])
{
    const struct support_side *side = &integers->side[f];
    const struct fmb_frame *frame = side->frame;
    for (int axis = 0; axis < 3; axis++) {
        if (frame->shape != FMB_HULL)
            mpz_set(out[axis], side->small[i][axis]);
        else if (axis >= frame->dim)
            mpz_set_ui(out[axis], 0);
        else
            integer_set(out[axis],
                        dyadic_of(frame->vertices[(size_t) axis * frame->vertex_stride + i]),
                        integers->unit);
    }
}

void support_integers_place(const struct support_integers *integers, int f, unsigned i,
                            mpz_t out[3])
{
    const struct support_side *side = &integers->side[f];
    support_integers_vertex(integers, f, i, out);
    turn_vector(&side->turn, side->factor, out);
    for (int axis = 0; axis < 3; axis++)
        mpz_add(out[axis], out[axis], side->position[axis]);
}
