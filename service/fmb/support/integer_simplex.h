/* The point of a polytope P next to the origin, in integers, for a P that is given by its vertex
 * with the least n . p for any n.
 *
 * Method. The algorithm of Gilbert, Johnson and Keerthi. It holds a simplex of at most 4 vertices
 * of P, the point of P next to the origin being that of the simplex so far, and adds the vertex
 * that lies farthest in the direction of the origin. The distance decreases strictly with each, so
 * that it ends. The next simplex is found by Johnson's conditions: of all subsets of the vertices
 * at hand the one, affinely independent, whose affine hull has its point next to the origin
 * strictly inside of the subset, with no other vertex nearer along that direction. */
#ifndef FMB_INTEGER_SIMPLEX_H
#define FMB_INTEGER_SIMPLEX_H

#include <gmp.h>
#include <stdbool.h>

enum { INTEGER_CORNERS = 4 };

/* A vertex of P. */
struct integer_corner {
    unsigned bits[2]; /* which one: defined by the caller */
    bool late;        /* at the end of the window */
    mpz_t at[3];
};

struct integer_simplex {
    int count;
    unsigned subset; /* of the corners, that is tried next */
    bool zero;       /* the point is the origin */
    struct integer_corner pool[INTEGER_CORNERS + 1];
    struct integer_corner *corner[INTEGER_CORNERS + 1]; /* the first are those of the simplex */
    mpz_t normal[3];                                    /* a multiple of the point */
    mpz_t edge[3][3], other[3];
    mpz_t weight[INTEGER_CORNERS], total, t[2]; /* the weights of the point are over total */
};

/* Calls one of mpz_init and mpz_clear for every number. */
void integer_simplex_each(struct integer_simplex *simplex, void (*call)(mpz_ptr));

/* Sets the corner of P with the least n . p. */
typedef void integer_support(void *context, mpz_t n[3], struct integer_corner *out);

/* Begin a search for the point of P next to the origin, and perform a step of it, with one call of
 * support at most. toward: any direction: the vertex in it is the first. Returns whether the point
 * is found. */
void integer_simplex_begin(struct integer_simplex *simplex, mpz_t toward[3],
                           integer_support *support, void *context);
bool integer_simplex_step(struct integer_simplex *simplex, integer_support *support, void *context);

/* out := n / |n|, rounded; numbers 2^100 times smaller than the largest become 0. In: not 0. */
void integer_direction(mpz_t n[3], double out[3]);

#endif
