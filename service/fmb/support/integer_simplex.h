/* The point of a polytope P nearest to the origin, in integers. P is given by a function that
 * returns its vertex with the least n . p for any n.
 *
 * Method. The algorithm of Gilbert, Johnson and Keerthi. It holds a simplex of at most 4 vertices
 * of P and the point of this simplex nearest to the origin. A step adds the vertex that is farthest
 * from this point in the direction of the origin. The distance decreases strictly with each vertex
 * added, so the search ends. The next simplex is found by Johnson's conditions: it is the affinely
 * independent subset of the vertices whose affine hull has its nearest point strictly inside the
 * subset, with no other vertex nearer along that direction. */
#ifndef FMB_INTEGER_SIMPLEX_H
#define FMB_INTEGER_SIMPLEX_H

#include "support_pair.h"

#include <gmp.h>

enum { INTEGER_CORNERS = 4 };

/* A vertex of P. */
struct integer_corner {
    struct support_column column; /* which one */
    mpz_t at[3];
};

struct integer_simplex {
    int count;
    unsigned subset; /* bits: the subset of the corners to be tried next */
    bool zero;       /* the point is the origin */
    struct integer_corner pool[INTEGER_CORNERS + 1];
    struct integer_corner *corner[INTEGER_CORNERS + 1]; /* the first count: the simplex */
    mpz_t normal[3];                                    /* a positive multiple of the point */
    mpz_t edge[3][3], other[3];
    mpz_t weight[INTEGER_CORNERS], total, t[2]; /* the weights of the point are over total */
};

/* Calls one of mpz_init and mpz_clear for every number. */
void integer_simplex_each(struct integer_simplex *simplex, void (*call)(mpz_ptr));

/* Sets *out to the corner of P with the least n . p. */
typedef void integer_support(void *context, mpz_t n[3], struct integer_corner *out);

/* Begin a search for the point of P nearest to the origin, and perform a step of it. Each calls
 * support at most once. integer_simplex_step() returns whether the point is found.
 *
 * In:  toward   any direction: the search starts from the corner with the least toward . p
 *      context  passed to support
 *      count    at least 1: vertices of P at the beginning of simplex->pool; the nearest point is
 *               expected inside their convex hull */
void integer_simplex_begin(struct integer_simplex *simplex, mpz_t toward[3],
                           integer_support *support, void *context);
void integer_simplex_begin_near(struct integer_simplex *simplex, int count);
bool integer_simplex_step(struct integer_simplex *simplex, integer_support *support, void *context);

/* out := n / |n|, rounded; numbers 2^100 times smaller than the largest become 0. In: not 0. */
void integer_direction(mpz_t n[3], double out[3]);

#endif
