/* Frame i of body a and frame j of body b over the window of their pair, or a part of the window,
 * in rational numbers; and the swept difference of their cores. */
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
    /* Of b relative to a: at the start of the part, and the change over it. */
    rational_vector offset, drift;
    struct difference difference;
};

/* Sets a world whose part is the whole window. */
void world_init(struct world *world, const struct pair *pair, unsigned i, unsigned j);
void world_clear(struct world *world);

/* Sets the part to the times from first to last, in seconds. */
void world_set_part(struct world *world, const mpq_t first, const mpq_t last);

/* out := a length, or a coordinate, of finite doubles, times the scale. */
void world_length(const struct world *world, double length, mpq_t out);

/* Returns the sign of d - R, where d is the least distance of the cores over the part, and R the
 * sum of the radii: 1 the frames are separated; 0 they touch, or R = 0 and the cores meet; -1 they
 * overlap. nearest := the shortest b - a of the cores, times the scale; may be NULL. */
int world_compare(struct world *world, rational_vector nearest);

/* square := the squared distance of a point from the core of that side at a time; way := the vector
 * from the point to the nearest point of the core; may be NULL. All lengths are times the scale. */
void world_from_core(struct world *world, int side, const mpq_t time, rational_vector point,
                     mpq_t square, mpq_t *way);

/* out := the largest absolute coordinate of any vertex of either body over the window, plus the
 * radius of its frame. */
void world_size(const struct pair *pair, mpq_t out);

/* out := the limit on the error of lengths, not scaled: 1e-12 of world_size(), plus 32 times the
 * least double. */
void world_limit(const struct pair *pair, mpq_t out);

#endif
