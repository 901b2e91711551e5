/* Frame i of a and frame j of b over the window of their pair, or a part of it, in rational
 * numbers; and the swept difference of their cores. */
#ifndef WORLD_H
#define WORLD_H

#include "difference.h"
#include "placed_pair.h"
#include "rational_solid.h"

/* All lengths are multiplied by scale, which makes those at the start of the window integers:
 * rational numbers without denominators are fast. */
struct world {
    int dim;
    mpq_t scale;
    struct rational_solid solid[2];
    mpq_t duration, radius; /* the sum of both radii */
    /* Of b against a: at the start of the part, and over it. */
    rational_vector offset, drift;
    struct difference difference;
};

/* The part is the whole window. */
void world_init(struct world *world, const struct pair *pair, unsigned i, unsigned j);
void world_clear(struct world *world);

/* The part is the times from first to last. */
void world_set_part(struct world *world, const mpq_t first, const mpq_t last);

/* out := a length, or a coordinate, of finite doubles, times the scale. */
void world_length(const struct world *world, double length, mpq_t out);

/* The sign of the distance of the frames over the part where their cores are apart, and of that of
 * the cores minus the sum of the radii otherwise: -1 they overlap, if a radius is not 0; 0 they
 * touch, or the cores do or overlap and no frame has a radius. nearest := the nearest b - a, times
 * the scale. */
int world_compare(struct world *world, rational_vector nearest);

/* square := the square of the distance of a point from the core of that side at a time, all times
 * the scale; way := that from the point to the nearest one, may be NULL. */
void world_from_core(struct world *world, int side, const mpq_t time, rational_vector point,
                     mpq_t square, mpq_t *way);

/* out := the largest absolute coordinate of any vertex of either body over the window, plus the
 * radius of its frame. */
void world_size(const struct pair *pair, mpq_t out);

/* The limit on the error of lengths, not scaled: 1e-12 of that, and 32 of the least doubles. */
void world_limit(const struct pair *pair, mpq_t out);

#endif
