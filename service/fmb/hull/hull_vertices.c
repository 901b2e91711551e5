#include "hull_vertices.h"

#include "integer.h"

void hull_integers_each(struct hull_integers *integers, void (*call)(mpz_ptr))
{
    call(integers->scale);
    for (int f = 0; f < 2; f++) {
        struct hull_side *side = &integers->side[f];
        INTEGER_EACH_FROM(row, &side->turn, call);
        call(side->factor);
        for (int axis = 0; axis < 3; axis++) {
            call(side->position[axis]);
            call(side->displacement[axis]);
            for (int i = 0; i < HULL_SMALL; i++)
                call(side->small[i][axis]);
        }
    }
    for (int axis = 0; axis < 3; axis++)
        call(integers->drift[axis]);
}

static unsigned vertex_count_of(const struct fmb_frame *frame)
{
    if (frame->shape == FMB_HULL)
        return frame->vertex_count;
    return frame_is_simplex(frame) ? (unsigned) frame->count + 1 : 1U << frame->count;
}

/* Sets the vertices of a frame that is not a hull. */
static void set_small(struct hull_side *side, long unit)
{
    struct exact_frame frame;
    const unsigned count = vertex_count_of(side->frame);
    INTEGER_EACH_FROM(component, &frame, mpz_init);
    exact_frame_set(&frame, side->frame, unit);
    for (unsigned k = 0; k < count; k++)
        for (int axis = 0; axis < 3; axis++) {
            mpz_set(side->small[k][axis], frame.origin[axis]);
            for (unsigned i = 0; i < (unsigned) frame.count; i++)
                if (frame.simplex ? k == i + 1 : k >> i & 1)
                    mpz_add(side->small[k][axis], side->small[k][axis], frame.component[i][axis]);
        }
    INTEGER_EACH_FROM(component, &frame, mpz_clear);
}

static void set_side(const struct fmb_placement *placement, const struct dyadic window,
                     const struct hull_integers *integers, struct hull_side *side)
{
    for (int axis = 0; axis < side->frame->dim; axis++) {
        integer_set(side->position[axis], dyadic_of(placement->position[axis]), integers->unit);
        mpz_mul(side->position[axis], side->position[axis], integers->scale);
        integer_set_product(side->displacement[axis], dyadic_of(placement->velocity[axis]), window,
                            integers->unit);
        mpz_mul(side->displacement[axis], side->displacement[axis], integers->scale);
    }
    if (side->frame->shape != FMB_HULL)
        set_small(side, integers->unit);
}

void hull_integers_set(const struct frame_pair *frames, struct hull_integers *out)
{
    const struct placed_frame *placed[2] = {&frames->a, &frames->b};
    struct hull_side *side = out->side;
    out->unit = limbs_span_of(frames).unit;
    for (int f = 0; f < 2; f++) {
        side[f].frame = placed[f]->frame;
        exact_turn_set(placed[f]->placement, &side[f].turn);
    }
    const bool same = mpz_cmp(side[0].turn.norm, side[1].turn.norm) == 0;
    mpz_set(out->scale, side[0].turn.norm);
    if (!same)
        mpz_mul(out->scale, out->scale, side[1].turn.norm);
    for (int f = 0; f < 2; f++) {
        if (same)
            mpz_set_ui(side[f].factor, 1);
        else
            mpz_set(side[f].factor, side[!f].turn.norm);
        set_side(placed[f]->placement, dyadic_of(frames->duration), out, &side[f]);
    }
    for (int axis = 0; axis < 3; axis++)
        mpz_sub(out->drift[axis], side[1].displacement[axis], side[0].displacement[axis]);
}

void hull_integers_place(const struct hull_integers *integers, int f, unsigned i, mpz_t out[3])
{
    const struct hull_side *side = &integers->side[f];
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
    exact_turn_vector(&side->turn, side->factor, out);
    for (int axis = 0; axis < 3; axis++)
        mpz_add(out[axis], out[axis], side->position[axis]);
}
