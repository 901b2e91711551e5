/* The vertices of a pair in integers: every length is an integer times 2^unit / scale. */
#ifndef FMB_SUPPORT_INTEGERS_H
#define FMB_SUPPORT_INTEGERS_H

#include "limbs.h"
#include "support_pair.h"

#include <gmp.h>

/* The orientation of a placement. For the smallest integers q proportional to it, n = |q|^2 and n
 * R(q) is a matrix of integers. */
struct support_turn {
    bool turned;
    mpz_t row[3][3], norm; /* n R(q) and n; if not turned, norm is 1 and row is not used */
};

/* A placed frame. */
struct support_side {
    const struct fmb_frame *frame;
    struct support_turn turn;
    mpz_t factor; /* of vectors that are turned */
    mpz_t position[3];
    mpz_t displacement[3]; /* v T */
    /* Vertices in body coordinates, over 2^unit, unless it is a hull. */
    mpz_t small[SUPPORT_SMALL][3];
};

struct support_integers {
    long unit;
    struct support_side side[2];
    mpz_t scale;
    mpz_t drift[3]; /* over the window */
    mpz_t radius;   /* the sum of both radii */
};

/* Calls one of mpz_init and mpz_clear for every number. */
void support_integers_each(struct support_integers *integers, void (*call)(mpz_ptr));

/* Sets the integers of a checked pair, whose frames must outlive them. posed: in the pose at a
 * fraction `at` of the window, without displacement; otherwise in the pose at its beginning, and
 * the ends of the placements are not read. In: all numbers are 0. */
void support_integers_set(const struct frame_pair *frames, bool posed, double at,
                          struct support_integers *out);

/* Sets only the unit, the frames and their vertices in body coordinates. In: all numbers are 0; all
 * coordinates of the frames are multiples of 2^unit. */
void support_integers_bodies(const struct frame_pair *frames, long unit,
                             struct support_integers *out);

/* out := factor N(x, y), and norm := x . y, for quaternions x and y (motion.h). In: out is 0. */
void support_integers_polar(mpz_t x[4], mpz_t y[4], unsigned factor, mpz_t out[3][3], mpz_t norm,
                            mpz_t scratch);

/* Returns the exponent of a power of two that divides all lengths of a pair that turns. */
long support_integers_unit(const struct frame_pair *frames);

/* out := the displacement of a placement over the window, to its end or v T, divided by 2^unit. */
void support_integers_path(const struct fmb_placement *placement, double duration, long unit,
                           mpz_t out[3]);

/* out := vertex i of frame f in body coordinates. */
void support_integers_vertex(const struct support_integers *integers, int f, unsigned i,
                             mpz_t out[3]);

/* out := vertex i of frame f in the world at time 0. */
void support_integers_place(const struct support_integers *integers, int f, unsigned i,
                            mpz_t out[3]);

#endif
