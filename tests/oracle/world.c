#include "world.h"

/* Multiplies the denominators of the numbers into the scale, so far as it lacks them. */
static void include_denominators(const mpq_t number[FMB_DIM_MAX], mpq_t scale)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        mpz_lcm(mpq_numref(scale), mpq_numref(scale), mpq_denref(number[axis]));
}

static void multiply(rational_vector v, const mpq_t factor)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        mpq_mul(v[axis], v[axis], factor);
}

static void set_scale(struct world *world)
{
    mpq_set_ui(world->scale, 1, 1);
    for (int s = 0; s < 2; s++) {
        include_denominators(world->solid[s].origin, world->scale);
        include_denominators(world->solid[s].velocity, world->scale);
        for (int i = 0; i < world->solid[s].count; i++)
            include_denominators(world->solid[s].column[i], world->scale);
    }
    for (int s = 0; s < 2; s++) {
        multiply(world->solid[s].origin, world->scale);
        multiply(world->solid[s].velocity, world->scale);
        mpq_mul(world->solid[s].radius, world->solid[s].radius, world->scale);
        for (int i = 0; i < world->solid[s].count; i++)
            multiply(world->solid[s].column[i], world->scale);
    }
}

void world_set_part(struct world *world, const mpq_t first, const mpq_t last)
{
    mpq_t length;
    mpq_init(length);
    mpq_sub(length, last, first);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        mpq_t *const offset = &world->offset[axis], *const drift = &world->drift[axis];
        mpq_sub(*offset, world->solid[1].origin[axis], world->solid[0].origin[axis]);
        mpq_sub(*drift, world->solid[1].velocity[axis], world->solid[0].velocity[axis]);
        rational_add_product(*offset, 1, *drift, first);
        mpq_mul(*drift, *drift, length);
    }
    mpq_clear(length);
}

void world_init(struct world *world, const struct pair *pair, unsigned i, unsigned j)
{
    world->dim = pair->a.body->dim;
    rational_solid_init_at(fmb_body_frame(pair->a.body, i), &pair->a, pair->at, pair->duration,
                           &world->solid[0]);
    rational_solid_init_at(fmb_body_frame(pair->b.body, j), &pair->b, pair->at, pair->duration,
                           &world->solid[1]);
    mpq_inits(world->duration, world->radius, world->scale, NULL);
    rational_vector_init(world->offset);
    rational_vector_init(world->drift);
    set_scale(world);
    mpq_set_d(world->duration, pair->duration);
    world_set_part(world, world->radius, world->duration);
    mpq_add(world->radius, world->solid[0].radius, world->solid[1].radius);
    world->difference = (struct difference){world->dim, &world->solid[0], &world->solid[1],
                                            world->offset, world->drift};
}

void world_clear(struct world *world)
{
    for (int side = 0; side < 2; side++)
        rational_solid_clear(&world->solid[side]);
    mpq_clears(world->duration, world->radius, world->scale, NULL);
    rational_vector_clear(world->offset);
    rational_vector_clear(world->drift);
}

void world_length(const struct world *world, double length, mpq_t out)
{
    mpq_set_d(out, length);
    mpq_mul(out, out, world->scale);
}

int world_compare(struct world *world, rational_vector nearest)
{
    mpq_t square, limit;
    mpq_inits(square, limit, NULL);
    difference_nearest(&world->difference, square, nearest);
    mpq_mul(limit, world->radius, world->radius);
    const int order = mpq_cmp(square, limit);
    mpq_clears(square, limit, NULL);
    return (order > 0) - (order < 0);
}

void world_from_core(struct world *world, int side, const mpq_t time, rational_vector point,
                     mpq_t square, mpq_t *way)
{
    struct rational_solid *solid = &world->solid[side];
    rational_vector offset;
    rational_vector_init(offset);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        mpq_sub(offset[axis], solid->origin[axis], point[axis]);
        rational_add_product(offset[axis], 1, time, solid->velocity[axis]);
    }
    difference_nearest(&(struct difference){.second = solid, .offset = offset}, square, way);
    rational_vector_clear(offset);
}

/* Raises out to the largest absolute coordinate of the body. */
static void raise_to_size(const struct fmb_placement *placement, mpq_srcptr at, double duration,
                          mpq_t out)
{
    struct rational_solid solid;
    mpq_t one, window;
    mpq_inits(one, window, NULL);
    mpq_set_d(window, duration);
    for (unsigned i = 0; i < placement->body->frame_count; i++) {
        rational_solid_init_at(fmb_body_frame(placement->body, i), placement, at, duration, &solid);
        for (int axis = 0; axis < placement->body->dim; axis++)
            for (int sign = -1; sign <= 1; sign += 2) {
                rational_solid_farthest(&solid, window, axis, sign, one);
                if (mpq_cmp(one, out) > 0)
                    mpq_set(out, one);
            }
        rational_solid_clear(&solid);
    }
    mpq_clears(one, window, NULL);
}

void world_size(const struct pair *pair, mpq_t out)
{
    mpq_set_ui(out, 0, 1);
    raise_to_size(&pair->a, pair->at, pair->duration, out);
    raise_to_size(&pair->b, pair->at, pair->duration, out);
}

void world_limit(const struct pair *pair, mpq_t out)
{
    mpq_t part;
    mpq_init(part);
    world_size(pair, out);
    mpq_set_ui(part, 1, 1000000000000);
    mpq_mul(out, out, part);
    mpq_set_d(part, 32 * 0x1p-1074);
    mpq_add(out, out, part);
    mpq_clear(part);
}
