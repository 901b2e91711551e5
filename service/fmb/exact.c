#include "exact.h"
#include "integer.h"

/* The largest power of two of which every length of the pair is a multiple. */
static long pair_unit(const struct fmb_pair *pair)
{
    const struct fmb_frame *frames[2] = {&pair->a, &pair->b};
    long unit = INTEGER_NO_EXPONENT;
    for (int f = 0; f < 2; f++) {
        const struct fmb_frame *frame = frames[f];
        int dim = frame->body->dim;
        unit = integer_vector_unit(unit, frame->origin, dim);
        for (int i = 0; i < frame->body->count; i++)
            unit = integer_vector_unit(unit, frame->body->component[i], dim);
        for (int i = 0; i < 2 && frame->body->rounded; i++)
            unit = integer_vector_unit(unit, frame->body->rest[i], dim);
        long speed = frame->moving ? integer_vector_unit(INTEGER_NO_EXPONENT, frame->velocity, dim)
                                   : INTEGER_NO_EXPONENT;
        if (speed < INTEGER_NO_EXPONENT)
            unit = integer_lower_unit(unit, speed + dyadic_of(pair->duration).exponent);
    }
    return unit;
}

static void set_edges(struct exact_frame *frame)
{
    for (int i = 0; i < frame->count; i++)
        frame->edge[i] = frame->component[i];
    frame->edges = frame->count;
    if (!frame->simplex)
        return;
    for (int i = 0; i < frame->count; i++) {
        for (int j = i + 1; j < frame->count; j++) {
            mpz_t *difference = frame->difference[frame->edges - frame->count];
            for (int axis = 0; axis < 3; axis++)
                mpz_sub(difference[axis], frame->component[j][axis], frame->component[i][axis]);
            frame->edge[frame->edges++] = difference;
        }
    }
}

/* component + rest */
static void add_rest(struct exact_frame *out, const struct fmb_body *body, long unit)
{
    mpz_t rest;
    mpz_init(rest);
    for (int i = 0; i < 2; i++)
        for (int axis = 0; axis < 3; axis++) {
            integer_set(rest, dyadic_of(body->rest[i][axis]), unit);
            mpz_add(out->component[i][axis], out->component[i][axis], rest);
        }
    mpz_clear(rest);
}

static void frame_set(struct exact_frame *out, const struct fmb_frame *frame, double duration,
                      long unit)
{
    const struct fmb_body *body = frame->body;
    struct dyadic window = dyadic_of(duration);
    out->count = body->count;
    out->simplex = body->shape != FMB_CUBOID;
    for (int axis = 0; axis < body->dim; axis++) {
        integer_set(out->origin[axis], dyadic_of(frame->origin[axis]), unit);
        if (frame->moving)
            integer_set_product(out->displacement[axis], dyadic_of(frame->velocity[axis]), window,
                                unit);
        for (int i = 0; i < body->count; i++)
            integer_set(out->component[i][axis], dyadic_of(body->component[i][axis]), unit);
    }
    if (body->rounded)
        add_rest(out, body, unit);
    set_edges(out);
}

/* Calls one of mpz_init and mpz_clear for every number of the frame. */
static void frame_each(struct exact_frame *frame, void (*call)(mpz_ptr))
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

static void pair_each(struct exact_pair *pair, void (*call)(mpz_ptr))
{
    for (int f = 0; f < 2; f++)
        frame_each(&pair->frame[f], call);
    for (int axis = 0; axis < 3; axis++) {
        call(pair->offset[axis]);
        call(pair->drift[axis]);
    }
    for (int i = 0; i < EXACT_SCRATCH; i++)
        call(pair->scratch[i]);
}

void exact_pair_init(struct exact_pair *out, const struct fmb_pair *pair)
{
    pair_each(out, mpz_init);
    out->unit = pair_unit(pair);
    out->moving = pair->a.moving || pair->b.moving;
    frame_set(&out->frame[0], &pair->a, pair->duration, out->unit);
    frame_set(&out->frame[1], &pair->b, pair->duration, out->unit);
    for (int axis = 0; axis < 3; axis++) {
        mpz_sub(out->offset[axis], out->frame[1].origin[axis], out->frame[0].origin[axis]);
        mpz_sub(out->drift[axis], out->frame[1].displacement[axis],
                out->frame[0].displacement[axis]);
    }
}

void exact_pair_clear(struct exact_pair *pair)
{
    pair_each(pair, mpz_clear);
}

struct offset_walk {
    struct exact_pair *pair;
    struct span span;
    mpz_t f0, f1;
};

/* The offset of the frames moves along a segment, offset + tau drift. */
static bool apply_to_offset(void *context, struct slab *slab)
{
    struct offset_walk *walk = context;
    struct exact_pair *pair = walk->pair;
    integer_dot(walk->f0, slab->normal, pair->offset);
    if (!pair->moving)
        return span_apply(&walk->span, walk->f0, walk->f0, slab->low, slab->high, slab->pins);
    integer_dot(walk->f1, slab->normal, pair->drift);
    mpz_add(walk->f1, walk->f1, walk->f0);
    return span_apply(&walk->span, walk->f0, walk->f1, slab->low, slab->high, slab->pins);
}

/* tau in windows, as seconds. */
static double seconds(const struct ratio *tau, double duration, enum round_direction direction,
                      mpz_t scratch[EXACT_SCRATCH])
{
    struct dyadic window = dyadic_of(duration);
    if (window.mantissa == 0)
        return 0.0;
    mpz_mul_si(scratch[2], tau->num, window.mantissa);
    return integer_ratio_round(scratch[2], tau->den, window.exponent, direction, scratch);
}

static void answer_contact(struct offset_walk *walk, double duration, struct fmb_answer *answer)
{
    mpz_t *scratch = walk->pair->scratch;
    answer->has_contact = true;
    answer->contact[0] = seconds(span_lower(&walk->span), duration, ROUND_DOWN, scratch);
    answer->contact[1] = seconds(span_upper(&walk->span), duration, ROUND_UP, scratch);
}

/* Bound on the work, for any input: at most 44 slabs, whose normals are of degree 2 and bounds
 * of degree 3 in the numbers of the pair, and less than 1,000 points for the box
 * (exact_box.c), each compared with a few others by products of degree 7. All numbers of a
 * pair share a unit of at least 2^-2148, the lowest of v T, and a coordinate lies below 2^1024:
 * at most 3,172 bits. A displacement has fewer: T is common to all, and where it is large the
 * unit is no lower than 2^-1074. */
enum fmb_status exact_decide(const struct fmb_pair *pair, unsigned want, struct fmb_answer *answer)
{
    struct exact_pair exact;
    exact_pair_init(&exact, pair);
    struct offset_walk walk = {.pair = &exact};
    span_init(&walk.span);
    mpz_inits(walk.f0, walk.f1, NULL);

    if (!slabs_walk(&exact.frame[0], &exact.frame[1], apply_to_offset, &walk, exact.scratch)) {
        answer->verdict = FMB_SEPARATED;
    } else {
        answer->verdict = span_has_interior(&walk.span) ? FMB_OVERLAPPING : FMB_TOUCHING;
        if (exact.moving)
            answer_contact(&walk, pair->duration, answer);
        answer->has_box = want & FMB_WANT_BOX;
        if (answer->has_box)
            exact_box(&exact, answer->box);
    }

    mpz_clears(walk.f0, walk.f1, NULL);
    span_clear(&walk.span);
    exact_pair_clear(&exact);
    return FMB_OK;
}
