/* Pairs by their vertices, in doubles. What the bounds do not prove is left open. Of frames with a
 * radius, verdicts, contacts and boxes are those of the cores. No shared state. */
#ifndef FMB_SUPPORT_SEARCH_H
#define FMB_SUPPORT_SEARCH_H

#include "support_pair.h"

/* A point of D in doubles. */
struct support_vertex {
    struct support_column column;
    double at[FMB_DIM_MAX];
};

struct support_simplex {
    unsigned count; /* of vertices, at most dim + 1 */
    struct support_vertex vertex[FMB_DIM_MAX + 1];
};

/* Copies the columns of the vertices. Returns how many there are. */
static inline unsigned support_columns(const struct support_simplex *simplex,
                                       struct support_column out[FMB_DIM_MAX + 1])
{
    for (unsigned i = 0; i < simplex->count; i++)
        out[i] = simplex->vertex[i].column;
    return simplex->count;
}

/* The result of a search for the point of D nearest to the origin. */
struct support_nearest {
    enum gap_outcome outcome; /* GAP_KNOWN: the weights and the direction are of that point */
    /* With dim + 1 vertices it contains the origin up to rounding, or is flat. GAP_FAR: empty. */
    struct support_simplex simplex;
    double weight[FMB_DIM_MAX + 1];
    double direction[FMB_DIM_MAX]; /* of unit length up to rounding */
    double least; /* the least n . x over D for the direction n: off by 4 error at most */
};

/* out := the vertex of D with the least n . x. In: n of any length. */
void support_lowest(const struct support_pair *pair, const double n[FMB_DIM_MAX],
                    struct support_vertex *out);

/* out := a point of D near its middle, rounded. */
void support_centre(const struct support_pair *pair, double out[FMB_DIM_MAX]);

/* out := a direction that is not 0, of a point near the middle of D if that is known. */
void support_toward(const struct support_pair *pair, double out[FMB_DIM_MAX]);

/* Searches for the point of D nearest to the origin; ends with GAP_FAR if it is surely farther away
 * than far - 4 error. Returns SEPARATED if a direction proves it, OVERLAPPING if a simplex proves
 * it, and 0 if doubles do not decide. In: a usable pair; far at least
 * support_separating_distance().
 */
enum fmb_verdict support_search(const struct support_pair *pair, double far,
                                struct support_nearest *out);

/* The same, beginning with the vertex farthest against a direction that is not 0. */
enum fmb_verdict support_search_from(const struct support_pair *pair,
                                     const double toward[FMB_DIM_MAX], double far,
                                     struct support_nearest *out);

/* The same with D translated by -at: the point of D nearest to the point at. Proves no verdict. */
void support_search_near(const struct support_pair *pair, const double at[FMB_DIM_MAX],
                         const double toward[FMB_DIM_MAX], struct support_nearest *out);

/* A computed distance above this proves that D does not contain the origin. The factor covers the
 * rounding of a comparison. */
static inline double support_separating_distance(const struct support_pair *pair)
{
    return 4 * (1 + 0x1p-40) * pair->error;
}

/* Returns whether the origin is certainly in the interior of the convex hull of dim + 1 points of
 * D. */
bool support_simplex_contains_origin(const struct support_pair *pair,
                                     const struct support_simplex *simplex);

/* Returns a lower bound of the distance from the origin to the facets of a simplex that certainly
 * contains it; 0 for any other simplex. */
double support_simplex_depth(const struct support_pair *pair,
                             const struct support_simplex *simplex);

/* Exchanges vertices of a simplex that contains the origin until all facets are at least depth from
 * the origin, or for a limited number of steps. Sets the deepest of these simplices and its
 * weights. Nothing is proven. */
void support_widen(const struct support_pair *pair, double depth, struct support_nearest *nearest);

/* Sets the contact, or the box, of a pair that a simplex proves to overlap. Returns false if
 * doubles do not give it within the limits of fmb.h. In: a pair in the order of support_order(). */
bool support_contact(const struct support_pair *pair, const struct support_simplex *simplex,
                     double contact[2]);
bool support_box(const struct support_pair *pair, const struct support_simplex *simplex,
                 double box[2][FMB_DIM_MAX]);

/* Guesses of optimal bases, for the start of the exact method. The origin is moved into D a little,
 * so that the simplex method does not stand on the boundary of D, where doubles cannot tell bases
 * apart. Points to itself: not to be copied. */
struct support_guess {
    struct support_pair pair; /* moved */
    struct support_simplex simplex;
};

/* Returns whether there will be guesses. In: a usable pair. */
bool support_guess_begin(const struct support_pair *pair, struct support_guess *out);

/* Guesses dim + 1 points of D that contain the origin in their simplex, and whose plane is highest
 * over it. axis: of the box, or -1: the contact. sign: of the height, 1 or -1. Returns false if
 * there is no guess. */
bool support_guess_basis(const struct support_guess *guess, int axis, double sign,
                         struct support_column out[FMB_DIM_MAX + 1]);

#endif
