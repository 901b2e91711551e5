/* Pairs with a hull in doubles. What their bounds do not prove stays open. No shared state. */
#ifndef FMB_HULL_SEARCH_H
#define FMB_HULL_SEARCH_H

#include "hull.h"

/* A point of D, or near the centre of D, in doubles. */
struct hull_vertex {
    struct hull_column column;
    bool is_centre; /* the mean of the centres of A and B and of the window; no column */
    double at[FMB_DIM_MAX];
};

/* The end of a search. */
struct hull_simplex {
    unsigned count; /* of vertices, at most dim + 1 */
    struct hull_vertex vertex[FMB_DIM_MAX + 1];
};

/* Sets the centre of D: a point of it, rounded. */
void hull_centre(const struct hull_pair *pair, struct hull_vertex *out);

/* Returns SEPARATED if a direction proves it, OVERLAPPING if a simplex of points of D proves it,
 * which is then *out, and 0 if doubles do not decide. *out then holds points of D near which the
 * origin is expected, none of them a centre. In: a usable pair. */
enum fmb_verdict hull_search(const struct hull_pair *pair, struct hull_simplex *out);

/* Returns whether the origin is certainly in the interior of the convex hull of dim + 1 points of D
 * or its centre. */
bool hull_simplex_contains_origin(const struct hull_pair *pair, const struct hull_simplex *simplex);

/* Bounds the distance of each point of a simplex from an exact point of D. */
static inline double hull_point_error(const struct hull_pair *pair)
{
    return 3 * pair->error;
}

/* Sets the contact, or the box, of a pair that a simplex proves to overlap. Returns false if
 * doubles do not give it within the limits of fmb.h. In: a pair in the order of hull_order(). */
bool hull_contact(const struct hull_pair *pair, const struct hull_simplex *simplex,
                  double contact[2]);
bool hull_box(const struct hull_pair *pair, const struct hull_simplex *simplex,
              double box[2][FMB_DIM_MAX]);

/* Guesses of optimal bases, for the start of the exact method. The origin is moved into D a little,
 * so that the simplex method does not stand on the boundary of D, where doubles cannot tell bases
 * apart. Points to itself: not to be copied. */
struct hull_guess {
    struct hull_pair pair; /* moved */
    struct hull_simplex simplex;
};

/* Returns whether there will be guesses. In: a usable pair. */
bool hull_guess_begin(const struct hull_pair *pair, struct hull_guess *out);

/* Guesses dim + 1 points of D that contain the origin in their simplex, and whose plane is highest
 * over it. axis: of the box, or -1: the contact. sign: of the height, 1 or -1. Returns false if
 * there is no guess. */
bool hull_guess_basis(const struct hull_guess *guess, int axis, double sign,
                      struct hull_column out[FMB_DIM_MAX + 1]);

#endif
