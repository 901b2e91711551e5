#include "exact.h"

#include "integer.h"

#include <string.h>

/* ---- Orientations ----
 *
 * For a quaternion q of integers, n R(q) is a matrix of integers, n = |q|^2. All lengths of a pair
 * are multiplied by scale: n_a n_b, or n_a if n_a = n_b. This changes no sign, no time and no
 * direction. Points are divided by scale at the end. */

void exact_turn_set(const struct fmb_placement *placement, struct exact_turn *turn)
{
    struct limbs_quaternion quaternion;
    limbs_quaternion_set(placement, &quaternion);
    turn->turned = quaternion.turned;
    mpz_set_ui(turn->norm, 1);
    if (!turn->turned)
        return;
    mpz_t q[4], product;
    mpz_inits(q[0], q[1], q[2], q[3], product, NULL);
    for (int i = 0; i < 4; i++)
        if (quaternion.at[i].mantissa)
            integer_set(q[i], quaternion.at[i], quaternion.unit);
    mpz_set_ui(turn->norm, 0);
    for (int k = 0; k < 4; k++) {
        mpz_mul(product, q[k], q[k]);
        mpz_add(turn->norm, turn->norm, product);
        for (int i = 0; i < 3; i++) { /* ww is added; v_k v_k in row k too, else subtracted */
            (k == 0 || k == 1 + i ? mpz_add : mpz_sub)(turn->row[i][i], turn->row[i][i], product);
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

void exact_frame_set(struct exact_frame *out, const struct fmb_frame *frame, long unit)
{
    out->count = frame->count;
    out->simplex = frame_is_simplex(frame);
    for (int axis = 0; axis < frame->dim; axis++) {
        for (int i = 0; i < frame->count; i++)
            integer_set_sum(out->component[i][axis], frame->component[i][axis],
                            frame->remainder[i][axis], unit);
        if (frame->shape != FMB_BOX) {
            integer_set(out->origin[axis], dyadic_of(frame->origin[axis]), unit);
            continue;
        }
        integer_set(out->displacement[axis], dyadic_of(frame->centre[axis]), unit);
        mpz_fdiv_q_2exp(out->origin[axis], out->component[axis][axis], 1); /* exact: it is even */
        mpz_sub(out->origin[axis], out->displacement[axis], out->origin[axis]);
    }
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

static void set_frames(struct exact_pair *out)
{
    const struct frame_pair *pair = out->question.pair;
    const struct placed_frame *placed[2] = {&pair->a, &pair->b};
    struct exact_turn turn[2];
    mpz_t one;
    mpz_init_set_ui(one, 1);
    for (int f = 0; f < 2; f++) {
        INTEGER_EACH_FROM(row, &turn[f], mpz_init);
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
        INTEGER_EACH_FROM(row, &turn[f], mpz_clear);
    mpz_clear(one);
}

/* Calls one of mpz_init and mpz_clear for every number of a pair. */
static void pair_each(struct exact_pair *pair, void (*call)(mpz_ptr))
{
    INTEGER_EACH_FROM(component, &pair->frame[0], call);
    INTEGER_EACH_FROM(component, &pair->frame[1], call);
    INTEGER_EACH_FROM(scale, pair, call);
}

static void set_question(const struct frame_pair *pair, struct limbs_question *out)
{
    limbs_question_set(pair, limbs_span_of(pair), LIMBS_FLAT, out);
}

void exact_pair_init(struct exact_pair *out, const struct frame_pair *pair)
{
    pair_each(out, mpz_init);
    set_question(pair, &out->question);
    out->unit = out->question.span.unit;
    set_frames(out);
}

void exact_pair_clear(struct exact_pair *pair)
{
    pair_each(pair, mpz_clear);
}

/* ---- The method ---- */

enum fmb_verdict exact_verdict(const struct frame_pair *pair, bool quick, double contact[2])
{
    struct limbs_question question;
    set_question(pair, &question);
    if (quick && question.limbs > LIMBS_NARROW)
        return 0;
    return limbs_functions_of(&question)->verdict(&question, contact);
}

enum fmb_status exact_decide(const struct frame_pair *pair, unsigned want,
                             struct fmb_answer *answer)
{
    double contact[2];
    answer->verdict = exact_verdict(pair, false, contact);
    answer->has_contact = answer->verdict != FMB_SEPARATED;
    answer->has_box = answer->has_contact && want & FMB_WANT_BOX;
    if (answer->has_contact)
        memcpy(answer->contact, contact, sizeof contact);
    if (answer->has_box)
        exact_box(pair, answer->box);
    return FMB_OK;
}
