/* The method exact, without gaps; and pairs in integers of GMP, for exact points.
 *
 * Everything is three-dimensional here: a 2D frame lies in the plane z = 0.
 *
 * Time is measured in windows: tau = t / T in [0,1]. Motion is the displacement v T over the whole
 * window, so that T = 0 is no special case: nothing moves. */
#ifndef FMB_EXACT_H
#define FMB_EXACT_H

#include "limbs.h"

#include <gmp.h>

/* A frame at tau = 0. All numbers are integers, in units of 2^unit / scale of the pair. */
struct exact_frame {
    int count;             /* components: 2 or 3 */
    bool simplex;          /* tetrahedron or face; else cuboid */
    mpz_t component[3][3]; /* [component][axis]; 0 beyond count */
    mpz_t origin[3];
    mpz_t displacement[3]; /* v T */
};

struct exact_pair {
    struct limbs_question question; /* the same pair */
    long unit;                      /* every length is an integer times 2^unit / scale */
    struct exact_frame frame[2];
    mpz_t scale; /* > 0; 1 if nothing is rotated */
    mpz_t scratch;
};

/* The orientation of a placement. For the smallest integers q proportional to it, n = |q|^2 and n
 * R(q) is a matrix of integers. */
struct exact_turn {
    bool turned;
    mpz_t row[3][3], norm; /* n R(q) and n; if not turned, norm is 1 and row is not used */
};

/* Sets the matrix of a placement. In: all numbers of turn are 0. */
void exact_turn_set(const struct fmb_placement *placement, struct exact_turn *turn);

/* v := n R(q) v times factor. */
void exact_turn_vector(const struct exact_turn *turn, const mpz_t factor, mpz_t v[3]);

/* Sets components and origin in body coordinates, in units of 2^unit. Changes displacement. In: not
 * a hull; all numbers are 0. */
void exact_frame_set(struct exact_frame *out, const struct fmb_frame *frame, long unit);

/* Converts a checked pair, which must outlive it. exact_pair_clear() frees what exact_pair_init()
 * allocates. */
void exact_pair_init(struct exact_pair *out, const struct frame_pair *pair);
void exact_pair_clear(struct exact_pair *pair);

/* Coordinates of a point in space and time: [0] tau, in windows; [1] to [3] the place, in units
 * of 2^unit of the pair. */
enum { EXACT_COORDINATES = 4 };

/* A point in the world and a time of the window, as fractions. */
struct exact_point {
    mpz_t at[EXACT_COORDINATES]; /* numerators */
    mpz_t den;                   /* > 0 */
};

/* Called for each point, which is valid during the call only. */
typedef void (*point_visit)(void *context, const struct exact_point *point);

/* Calls visit for points whose convex hull, in space and time, is the closed intersection of the
 * frames over the window: all its vertices, and other points, some more than once; none if the
 * frames never meet. The tau of a static pair is 0. */
void points_walk(struct exact_pair *pair, point_visit visit, void *context);

/* Computes the box of the intersection of a pair in contact over the window, with ends rounded
 * outward. */
void exact_box(const struct frame_pair *pair, double box[2][FMB_DIM_MAX]);

/* Returns the verdict; 0 if quick is set and the pair needs integers wider than LIMBS_NARROW. If
 * contact is not NULL and the pair is in contact, it is set to [first, last], in seconds, rounded
 * outward. */
enum fmb_verdict exact_verdict(const struct frame_pair *pair, bool quick, double contact[2]);

/* The method exact, without the gap. */
enum fmb_status exact_decide(const struct frame_pair *pair, unsigned want,
                             struct fmb_answer *answer);

#endif
