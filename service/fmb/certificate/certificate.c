/* Writes certificates, in steps: proofs of a verdict that do not rely on the engine. A direction in
 * doubles proves most separated pairs; programs.c proves the others, and certificate_weights.c
 * shortens the weights of the common point. */
#include "certificate_text.h"
#include "certificate_weights.h"
#include "integer.h"
#include "memory.h"
#include "support_search.h"
#include "turn_decision.h"

#include <math.h>
#include <string.h>

struct fmb_certificate_state {
    struct frame_pair frames;
    struct support_pair pair;
    struct programs *programs; /* NULL: none, or complete */
    struct certificate_weights weights;
    enum { TURNING, COVERING, DECIDING, WEIGHING, WRITING, COMPLETE } stage; /* the next stage */
    int side; /* whose weights are written next */
    bool turns;
    struct turn_decision turn; /* of a pair that turns */
    struct turn_proof proof;
    struct fmb_answer answer;
    unsigned part; /* whose interval is written next */
    struct certificate_writer writer;
};

/* ---- Text ---- */

/* Divides n by the greatest common divisor of its coordinates. */
static void write_vector(struct certificate_writer *writer, const char *word, int dim, mpz_t n[3])
{
    mpq_t number;
    mpz_t divisor;
    mpq_init(number);
    mpz_init(divisor);
    mpz_gcd(divisor, n[0], n[1]);
    mpz_gcd(divisor, divisor, n[2]);
    for (int axis = 0; axis < dim; axis++) {
        mpz_divexact(mpq_numref(number), n[axis], divisor);
        certificate_write_text(writer, axis == 0 ? "%s(" : " ", word);
        certificate_write_number(writer, number);
    }
    certificate_write_text(writer, ")");
    mpq_clear(number);
    mpz_clear(divisor);
}

static void write_number(struct certificate_writer *writer, const char *word, double x, double y)
{
    mpq_t number, factor;
    mpq_inits(number, factor, NULL);
    mpq_set_d(number, x);
    mpq_set_d(factor, y);
    mpq_mul(number, number, factor);
    certificate_write_text(writer, "%s", word);
    certificate_write_number(writer, number);
    mpq_clears(number, factor, NULL);
}

/* Returns the weight of the first vertex of frame f from vertex on; NULL: there is none. */
static const struct certificate_weight *next_weight(const struct certificate_weights *weights,
                                                    int f, unsigned vertex)
{
    const struct certificate_weight *next = NULL;
    for (unsigned k = 0; k < weights->count; k++) {
        const struct certificate_weight *of = &weights->weight[k];
        if (of->f == f && of->vertex >= vertex && (!next || of->vertex < next->vertex))
            next = of;
    }
    return next;
}

static void write_weights(struct certificate_writer *writer,
                          const struct certificate_weights *weights, int f, const char *word)
{
    const struct certificate_weight *of;
    mpq_t number;
    mpq_init(number);
    certificate_write_text(writer, "%s", word);
    for (unsigned v = 0; (of = next_weight(weights, f, v)) != NULL; v = of->vertex + 1) {
        certificate_write_text(writer, " %u", of->vertex);
        if (of->row >= 0)
            continue;
        if (weights->unrounded) {
            mpz_set(mpq_numref(number), of->proven);
            mpz_set(mpq_denref(number), weights->proof->total);
            mpq_canonicalize(number);
        } else {
            mpq_set_z(number, of->stated);
            mpq_div_2exp(number, number, weights->bits);
        }
        certificate_write_text(writer, ":");
        certificate_write_number(writer, number);
    }
    mpq_clear(number);
}

/* ---- Separated by doubles ---- */

/* Writes a normal of few bits, near the direction of the point of D nearest to the origin, if its
 * values in doubles prove that the frames are separated. Returns whether they do. */
static bool write_separated(struct certificate_writer *writer, const struct support_pair *pair,
                            const double direction[FMB_DIM_MAX])
{
    for (int bits = 3; bits <= 48; bits *= 2) {
        double outward[FMB_DIM_MAX];
        struct support_column column;
        mpz_t n[3];
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            outward[axis] = -ldexp(trunc(ldexp(direction[axis], bits)), -bits);
        const double length = sqrt(vec3_dot(outward, outward)) * (1 + 0x1p-50); /* < 1.01 */
        const double apart = 1.01 * pair->error + length * pair->radius[1] * (1 + 0x1p-50);
        if (!(support_farthest(pair, outward, &column) < -apart))
            continue;
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            mpz_init_set_d(n[axis], -ldexp(outward[axis], bits));
        certificate_write_text(writer, fmb_verdict_name(FMB_SEPARATED));
        write_vector(writer, " normal ", pair->dim, n);
        mpz_clears(n[0], n[1], n[2], NULL);
        return true;
    }
    return false;
}

/* ---- Intervals of pairs that turn ---- */

/* out := a direction rounded to a number of bits. */
static void round_direction(const struct turn_direction *direction, int bits,
                            struct turn_direction *out)
{
    *out = *direction;
    for (int i = 0; i < 2; i++) {
        int exponent;
        frexp(vec3_largest(direction->m[i]), &exponent);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            out->m[i][axis] = ldexp(rint(ldexp(direction->m[i][axis], bits - exponent)), -bits);
    }
}

/* m := a multiple of each vector. */
static void set_multiples(const struct turn_direction *direction, mpz_t m[2][3])
{
    for (int i = 0; i < 2; i++) {
        struct dyadic_span span = dyadic_span_begin();
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            dyadic_span_add(&span, dyadic_of(direction->m[i][axis]));
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            integer_set(m[i][axis], dyadic_of(direction->m[i][axis]), span.unit);
    }
}

/* Sets the vectors of a part of the proof, rounded to as few bits as doubles can still prove. If
 * they prove no rounded direction, a direction given by vertices is set exactly. */
static void set_part(const struct turn_path *path, const struct turn_part *part, mpz_t m[2][3])
{
    struct turn_direction rounded;
    bool proven = false;
    for (int bits = 3; bits <= 48 && !proven && path->pair.usable; bits *= 2) {
        round_direction(&part->direction, bits, &rounded);
        proven = turn_distance(path, &rounded, part->interval.lo, part->interval.hi) > 0;
    }
    if (proven || part->sign == 0) {
        set_multiples(proven ? &rounded : &part->direction, m);
        return;
    }
    struct turn_exact exact;
    turn_exact_begin(path, &exact);
    turn_exact_direction(&exact, &part->corners, part->sign, m);
    turn_exact_end(&exact);
}

/* Writes an interval with its direction. If the frames are swapped, n is negated; a product is
 * written with its factors exchanged, since e x f = -(f x e). */
static void write_part(struct certificate_writer *writer, const struct turn_decision *turn,
                       const struct turn_part *part)
{
    static const char *const word[3] = {" normal a ", " normal b ", " product "};
    const int dim = turn->path.pair.dim, swapped = turn->swapped, of = part->direction.of;
    mpz_t m[2][3];
    integer_each(m, sizeof m, mpz_init);
    set_part(&turn->path, part, m);
    write_number(writer, " from ", part->interval.lo, 1);
    write_number(writer, " to ", part->interval.hi, 1);
    for (int axis = 0; axis < FMB_DIM_MAX && swapped && of < 2; axis++)
        mpz_neg(m[0][axis], m[0][axis]);
    write_vector(writer, word[of < 2 ? of ^ swapped : 2], dim, m[of < 2 ? 0 : swapped]);
    if (of == 2)
        write_vector(writer, " ", dim, m[!swapped]);
    integer_each(m, sizeof m, mpz_clear);
}

/* ---- Steps ---- */

/* The span that fmb.h defines, in bits. Reducing a fraction of more bits would take milliseconds.
 */
enum { SPAN_MAX = 512, SPAN_TURNING = 1024 };

static bool is_wide(const struct frame_pair *frames, const struct support_integers *integers)
{
    const struct dyadic_span span = limbs_span_of(frames);
    return span.top - span.unit + (long) mpz_sizeinbase(integers->scale, 2) > SPAN_MAX;
}

static enum fmb_status check(const struct fmb_placement *a, const struct fmb_placement *b,
                             double duration)
{
    const enum fmb_status status = placements_check(a, b, duration);
    if (status == FMB_OK && (a->body->frame_count > 1 || b->body->frame_count > 1))
        return FMB_CANNOT_DECIDE;
    return status;
}

/* Abandons or ends all work. */
static void end(struct fmb_certificate_state *state)
{
    if (state->stage == WEIGHING || state->stage == WRITING)
        certificate_weights_end(&state->weights);
    if (state->stage == TURNING)
        turn_end(&state->turn);
    if (state->programs)
        programs_end(state->programs, NULL);
    state->programs = NULL;
    state->stage = COMPLETE;
}

/* Takes the verdict of a pair that turns. An overlap is proven at one time, as for a pair at rest.
 */
static void turned(struct fmb_certificate_state *state)
{
    struct support_pair *pair = &state->turn.path.pair;
    int exponent = 0;
    state->stage = COMPLETE;
    if (state->answer.verdict == FMB_SEPARATED && state->proof.count <= TURN_PROOF) {
        certificate_write_text(&state->writer, fmb_verdict_name(FMB_SEPARATED));
        state->stage = COVERING;
        state->part = 0;
    }
    if (state->answer.verdict != FMB_OVERLAPPING)
        return;
    turn_path_pose(&state->turn.path, state->turn.overlap);
    state->programs = pair->rounded ? programs_begin_nearest(pair, false, NULL, 0)
                                    : programs_begin(pair, FMB_WANT_CERTIFICATE, NULL, 0);
    state->stage = DECIDING;
    const struct support_integers *integers = programs_proof(state->programs)->integers;
    frexp(pair->reach, &exponent);
    if (!isfinite(pair->reach) ||
        exponent - integers->unit + (long) mpz_sizeinbase(integers->scale, 2) > SPAN_TURNING)
        end(state);
}

enum fmb_status fmb_certificate_begin(const struct fmb_placement *a, const struct fmb_placement *b,
                                      double duration, struct fmb_certificate_state **state)
{
    const enum fmb_status status = check(a, b, duration);
    *state = NULL;
    if (status != FMB_OK)
        return status;
    struct fmb_certificate_state *begun = memory_allocate(sizeof *begun);
    struct support_nearest nearest = {.simplex = {.count = 0}};
    struct support_column first[FMB_DIM_MAX + 1];
    enum fmb_verdict verdict = 0;
    begun->frames = (struct frame_pair){
        {fmb_body_frame(a->body, 0), a}, {fmb_body_frame(b->body, 0), b}, duration};
    begun->stage = DECIDING;
    begun->programs = NULL;
    begun->writer.length = 0;
    begun->turns = pair_turns(&begun->frames);
    *state = begun;
    if (begun->turns) {
        memset(&begun->answer, 0, sizeof begun->answer);
        begun->stage = TURNING;
        if (turn_begin(&begun->frames, 0, INFINITY, false, &begun->turn, &begun->proof,
                       &begun->answer))
            turned(begun);
        return FMB_OK;
    }
    support_pair_set(&begun->frames, &begun->pair);
    if (begun->pair.usable)
        verdict = support_search(&begun->pair, INFINITY, &nearest);
    const unsigned count = support_columns(&nearest.simplex, first);
    begun->programs = begun->pair.rounded
                          ? programs_begin_nearest(&begun->pair, false, first, count)
                          : programs_begin(&begun->pair, FMB_WANT_CERTIFICATE, first, count);
    if (is_wide(&begun->frames, programs_proof(begun->programs)->integers) ||
        (verdict == FMB_SEPARATED &&
         write_separated(&begun->writer, &begun->pair, nearest.direction)))
        end(begun);
    return FMB_OK;
}

/* Writes verdict and normal of a proof. */
static void decided(struct fmb_certificate_state *state)
{
    struct programs_proof *proof = programs_proof(state->programs);
    const int dim = state->frames.a.placement->body->dim;
    certificate_write_text(&state->writer, fmb_verdict_name(proof->verdict));
    if (proof->verdict != FMB_OVERLAPPING)
        write_vector(&state->writer, " normal ", dim, proof->normal);
    if (proof->verdict == FMB_SEPARATED) {
        end(state);
        return;
    }
    certificate_weights_begin(proof, dim, state->frames.duration, &state->weights);
    state->stage = WEIGHING;
}

const char *fmb_certificate_step(struct fmb_certificate_state *state)
{
    struct certificate_writer *writer = &state->writer;
    const bool swapped = state->turns && state->turn.swapped;
    switch (state->stage) {
    case TURNING:
        if (turn_step(&state->turn, &state->answer))
            turned(state);
        break;
    case COVERING:
        write_part(writer, &state->turn, &state->proof.part[state->part++]);
        if (state->part == state->proof.count || writer->length >= FMB_CERTIFICATE_MAX)
            end(state);
        break;
    case DECIDING:
        if (programs_step(state->programs))
            decided(state);
        break;
    case WEIGHING:
        if (!certificate_weights_step(&state->weights))
            break;
        if (state->turns) {
            write_number(writer, " at ", state->turn.overlap, state->frames.duration);
        } else {
            certificate_write_text(writer, " at ");
            certificate_write_number(writer, state->weights.time);
        }
        state->stage = WRITING;
        state->side = 0;
        break;
    case WRITING:
        write_weights(writer, &state->weights, state->side ^ swapped, state->side ? " b" : " a");
        state->side++;
        if (state->side == 2)
            end(state);
        break;
    case COMPLETE: break;
    }
    if (state->stage != COMPLETE)
        return NULL;
    if (writer->length == 0 || writer->length >= FMB_CERTIFICATE_MAX)
        writer->text[0] = '\0';
    return writer->text;
}

void fmb_certificate_end(struct fmb_certificate_state *state)
{
    if (!state)
        return;
    end(state);
    memory_release(state, sizeof *state);
}

enum fmb_status fmb_certificate(const struct fmb_placement *a, const struct fmb_placement *b,
                                double duration, char *text, size_t size, size_t *length)
{
    struct fmb_certificate_state *state;
    enum fmb_status status = fmb_certificate_begin(a, b, duration, &state);
    const char *written = status == FMB_OK ? NULL : "";
    while (!written)
        written = fmb_certificate_step(state);
    if (status == FMB_OK && state->turns && !state->answer.verdict)
        status = FMB_CANNOT_DECIDE;
    *length = strlen(written);
    if (*length >= size)
        status = status == FMB_OK ? FMB_OVER_LIMIT : status;
    else
        memcpy(text, written, *length);
    if (size > 0)
        text[*length < size ? *length : 0] = '\0';
    fmb_certificate_end(state);
    return status;
}
