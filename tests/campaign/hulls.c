/* Families of hulls that have no counterpart among other shapes. */
#include <math.h>
#include <string.h>

#include "posed.h"

static struct solid *solid_of(struct question *question, int side)
{
    return question_solid(question, side);
}

/* ---- By the vertices of another shape ---- */

static const struct family *any_family(struct draw *draw)
{
    int all = 0;
    while (family_any_at((size_t) all))
        all++;
    return family_any_at((size_t) draw_int(draw, 0, all - 1));
}

void hull_of_shape(struct draw *draw, const struct family *family, const struct cell *cell,
                   struct question *out)
{
    (void) family;
    const struct family *other;
    struct cell all[CELL_OF_ALL_SHAPES], chosen = *cell;
    bool has = false;
    do {
        other = any_family(draw);
        if (other->cells & FAMILY_A_HULL)
            continue;
        const int count = family_cells(other, all);
        for (int side = 0; side < 2; side++)
            if (cell->shape[side] == FMB_HULL)
                chosen.shape[side] = (enum fmb_shape) draw_int(draw, FMB_CUBOID, FMB_BOX);
        for (int i = 0; i < count; i++)
            has = has || (all[i].dim == chosen.dim && all[i].moving == chosen.moving &&
                          all[i].shape[0] == chosen.shape[0] && all[i].shape[1] == chosen.shape[1]);
    } while (!has);
    family_draw(other, &chosen, draw, out);
    for (int side = 0; side < 2; side++)
        solid_of(out, side)->as_hull = cell->shape[side] == FMB_HULL;
}

/* ---- Equal ---- */

/* The hull of a pair is drawn; the other solid is its copy, or any other shape. */
void hull_equal(struct draw *draw, const struct family *family, const struct cell *cell,
                struct question *out)
{
    (void) family;
    posed_begin(cell, out);
    const bool whole = draw_coin(draw);
    for (int side = 0; side < 2; side++)
        if (whole)
            posed_draw_whole_shape(draw, 9, 1, solid_of(out, side));
        else
            posed_draw_shape(draw, 100, solid_of(out, side));
    posed_draw_any(draw, &out->a);
    posed_draw_velocities(draw, whole, out);
    if (cell->shape[0] == cell->shape[1])
        out->b = out->a;
    struct solid *b = &out->b;
    memcpy(b->orientation, out->a.orientation, sizeof b->orientation);
    memcpy(b->local, out->a.local, sizeof b->local);
    b->orientation_count = out->a.orientation_count;
    double *number = b->origin;
    if (b->vertex_count > 0 && draw_coin(draw))
        number = b->vertex[draw_int(draw, 0, b->vertex_count - 1)];
    number += draw_int(draw, 0, b->dim - 1);
    if (draw_int(draw, 0, 3) > 0)
        *number = nextafter(*number, draw_coin(draw) ? HUGE_VAL : -HUGE_VAL);
}

/* ---- Flat ---- */

/* Whole numbers, all in one plane: a number on one axis is a multiple of another one. */
static int draw_in_plane(struct draw *draw, const struct cell *cell, struct question *out)
{
    const int axis = draw_int(draw, 0, cell->dim - 1), from = (axis + 1) % cell->dim;
    const int lean = draw_int(draw, -2, 2);
    posed_begin(cell, out);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = solid_of(out, side);
        const int most = draw_coin(draw) ? 2 : 5;
        posed_draw_whole_shape(draw, most, 1, solid);
        draw_integers(draw, cell->dim, -most, most, solid->origin);
        if (solid->shape == FMB_BOX) /* is in no other plane */
            solid->component[axis][axis] = 0;
        const int times = solid->shape == FMB_BOX ? 0 : lean;
        solid->origin[axis] = lean * solid->origin[from];
        solid->local[axis] = lean * solid->local[from];
        for (int i = 0; i < solid_count(solid) && solid->shape != FMB_BOX; i++)
            solid->component[i][axis] = times * solid->component[i][from];
        for (int v = 0; v < solid->vertex_count; v++)
            solid->vertex[v][axis] = lean * solid->vertex[v][from];
    }
    posed_draw_velocities(draw, true, out);
    return axis;
}

/* The same whole orientation about the origin for both, or none. */
static void turn_both(struct draw *draw, struct question *out)
{
    if (draw_coin(draw))
        return;
    /* The positions are in the plane of the unturned ones: only a shared one stays in it. */
    memcpy(out->b.origin, out->a.origin, sizeof out->b.origin);
    posed_draw_whole(draw, 3, &out->a);
    memcpy(out->b.orientation, out->a.orientation, sizeof out->b.orientation);
    out->b.orientation_count = out->a.orientation_count;
}

void hull_in_plane(struct draw *draw, const struct family *family, const struct cell *cell,
                   struct question *out)
{
    (void) family;
    const int axis = draw_in_plane(draw, cell, out);
    turn_both(draw, out);
    if (draw_coin(draw))
        out->b.velocity[axis] = out->a.velocity[axis];
}

/* In one plane at the start, in the middle or at the end of the window only. */
void hull_parting(struct draw *draw, const struct family *family, const struct cell *cell,
                  struct question *out)
{
    (void) family;
    const double when = draw_int(draw, 0, 2) / 2.0;
    const int axis = draw_in_plane(draw, cell, out);
    turn_both(draw, out);
    out->b.velocity[axis] = out->a.velocity[axis] + (draw_coin(draw) ? 1 : -1);
    for (int i = 0; i < cell->dim; i++)
        out->b.origin[i] -= when * out->duration * (out->b.velocity[i] - out->a.velocity[i]);
}

/* ---- Many vertices, thin ---- */

/* features.one: so many powers of two thinner is the ellipsoid along one or two of its axes. */
void hull_cloud(struct draw *draw, const struct family *family, const struct cell *cell,
                struct question *out)
{
    double size = 0;
    posed_begin(cell, out);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = solid_of(out, side);
        posed_draw_any(draw, solid);
        posed_draw_shape(draw, 100, solid);
        if (solid->shape == FMB_HULL) {
            const int thin = draw_int(draw, 1, cell->dim - 1);
            solid->vertex_count = 0;
            solid->cloud = (int) (13 * exp2(draw_uniform(draw, 0, log2(family->amount / 13))));
            solid->cloud_seed = draw_bits(draw);
            for (int i = 0; i < cell->dim; i++)
                for (int axis = 0; axis < cell->dim; axis++)
                    solid->component[i][axis] =
                        ldexp(draw_uniform(draw, -100, 100), i < thin ? -family->features.one : 0);
        }
        for (int axis = 0; axis < cell->dim; axis++)
            size = fmax(size, fabs(solid->component[0][axis]));
    }
    posed_draw_velocities(draw, false, out);
    posed_meet_nearly(draw, size, out);
}

/* ---- Numbers of every size ---- */

void hull_exponents(struct draw *draw, const struct family *family, const struct cell *cell,
                    struct question *out)
{
    const int most = (int) family->amount;
    posed_begin(cell, out);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = solid_of(out, side);
        posed_draw_shape(draw, 1, solid);
        if (draw_coin(draw))
            posed_draw_any(draw, solid);
        for (int axis = 0; axis < cell->dim; axis++) {
            solid->local[axis] = draw_coin(draw) ? 0 : draw_log(draw, -most, most);
            solid->origin[axis] = draw_log(draw, -most, most);
            solid->velocity[axis] = cell->moving ? draw_log(draw, -most, most) : 0;
            for (int v = 0; v < solid->vertex_count; v++)
                solid->vertex[v][axis] = draw_log(draw, -most, most);
            for (int i = 0; i < solid_count(solid); i++)
                if (solid->shape != FMB_BOX || i == axis)
                    solid->component[i][axis] = draw_log(draw, -most, most);
            if (solid->shape == FMB_BOX)
                solid->component[axis][axis] = fabs(solid->component[axis][axis]);
        }
    }
    if (cell->moving && draw_coin(draw))
        out->duration = fabs(draw_log(draw, -most, most));
    if (draw_coin(draw))
        posed_meet_nearly(draw, 1, out);
}
