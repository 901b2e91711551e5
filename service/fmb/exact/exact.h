/* The exact step: what the engine decides with integers of any size.
 *
 * A pair becomes integers (exact_pair). Its verdict and interval come from one line against
 * one polytope, and so does its box; the polytope is a set of slabs (exact_slabs.c), the
 * line's part inside it a span (exact_span.c).
 *
 * Everything is three-dimensional here: a 2D frame lies in the plane z = 0, where it is a
 * flat frame among flat frames, and those need no case of their own.
 *
 * Time is measured in windows: tau = t / T in [0,1], and motion as the displacement v T over
 * the whole window, so that T = 0 is no special case either (nothing moves). */
#ifndef FMB_EXACT_H
#define FMB_EXACT_H

#include "pair.h"

#include <gmp.h>

enum {
    EXACT_EDGES_MAX = 6,    /* directions of edges: 3 of a cuboid, 6 of a tetrahedron */
    EXACT_VERTICES_MAX = 8, /* of a cuboid */
    EXACT_SCRATCH = 4
};

/* The vectors of a pair, by number: the components of frame 0 and of frame 1, the offset, the
 * drift. All that the exact step needs is linear in them: edges, vertices, normals, what is along
 * these. */
enum {
    EXACT_OF_B = 3,
    EXACT_OFFSET = 6,
    EXACT_DRIFT = 7,
    EXACT_VECTORS = 8,
    EXACT_TRIPLES = 56 /* of 8 */
};

/* A direction of edges: vector plus - vector minus, or vector plus where minus < 0. */
struct exact_edge {
    int plus, minus;
    mpz_t *vector; /* [axis] */
};

/* A frame at tau = 0. Integers, times 2^unit / scale of the pair; vectors are [axis]. */
struct exact_frame {
    int count;             /* components: 2 or 3 */
    bool simplex;          /* tetrahedron or face; else cuboid */
    mpz_t component[3][3]; /* [component][axis]; 0 beyond count */
    mpz_t origin[3];
    mpz_t displacement[3]; /* v T */
    /* The distinct directions of edges: the components; of a simplex also the differences
     * c_j - c_i, i < j, which are held in difference. */
    int edges;
    struct exact_edge edge[EXACT_EDGES_MAX];
    mpz_t difference[3][3];
};

struct exact_pair {
    long unit;   /* every length is an integer times 2^unit / scale */
    mpz_t scale; /* > 0; 1 where nothing is turned */
    bool moving;
    struct exact_frame frame[2];
    mpz_t offset[3]; /* origin of frame[1] - origin of frame[0] */
    mpz_t drift[3];  /* displacement of frame[1] - displacement of frame[0]; 0 if not moving */
    /* (u x v) . w of all vectors u < v < w, in the order of exact_triple(). */
    mpz_t triple[EXACT_TRIPLES];
    mpz_t scratch[EXACT_SCRATCH];
};

/* pair must be checked. exact_pair_clear() frees what exact_pair_init() took. */
void exact_pair_init(struct exact_pair *out, const struct frame_pair *pair);
void exact_pair_clear(struct exact_pair *pair);

/* Sets the inverse of a frame that has dim components, the rest of them included; every entry is
 * the largest double that is not above the exact one, infinite beyond the doubles. False if there
 * is none: the frame is exactly flat. */
bool exact_inverse(struct fmb_frame *frame);

/* By the number of a vector. [axis] */
mpz_t *exact_vector(struct exact_pair *pair, int number);

/* out := normal . vector number k of the pair. */
void exact_dot(struct exact_pair *pair, mpz_t out, mpz_t normal[3], int k);

/* value[k] := (u x v) . vector k, for all vectors k of the pair. */
void exact_cross_values(struct exact_pair *pair, const struct exact_edge *u,
                        const struct exact_edge *v, mpz_t value[EXACT_VECTORS]);

/* [low, high] := the values of a normal over frame f with its origin at 0. */
void exact_extent(const struct exact_pair *pair, int f, mpz_t value[EXACT_VECTORS], mpz_t low,
                  mpz_t high);

/* One slab: { w : low <= normal . w <= high }. A slab that pins has low = high: it belongs to
 * the affine hull of the polytope, every point of which lies on it. */
struct slab {
    mpz_t value[EXACT_VECTORS]; /* normal . each vector of the pair */
    mpz_t low, high;
    bool pins;
    const struct exact_edge *u, *v; /* the normal is u x v; where u is NULL it is normal */
    mpz_t normal[3];
};

/* Called for each slab in turn; false ends the walk. The slab is the walker's. */
typedef bool (*slab_visit)(void *context, struct slab *slab);

/* Calls one of mpz_init and mpz_clear for every number. */
void slab_each(struct slab *slab, void (*call)(mpz_ptr));

/* Sets slab->normal where it is not yet. */
void slab_set_normal(struct slab *slab, mpz_t scratch);

/* Whose slabs are walked. */
enum slabs_of { SLABS_OF_A, SLABS_OF_B, SLABS_OF_DIFFERENCE, SLABS_OF_SWEPT };

/* Whether the difference of the frames, a - b, has a volume. */
bool slabs_solid(const struct exact_pair *pair);

/* Walks the slabs whose intersection is one frame with its origin at 0, or the Minkowski difference
 * a - b of both with their origins at 0; false if the visitor ended the walk. So the frames have a
 * point in common where the offset w = origin of b - origin of a lies in all slabs of the
 * difference, and their relative interiors have one where w lies strictly between the bounds of all
 * that do not pin.
 * SLABS_OF_SWEPT: only those that a solid difference gets when it is swept along the drift, besides
 * its own; the drift is constant in them, and the bounds are those of the difference. */
bool slabs_walk(struct exact_pair *pair, enum slabs_of of, slab_visit visit, void *context);

/* num / den, den > 0. */
struct ratio {
    mpz_t num, den;
};

void ratio_init(struct ratio *r);
void ratio_clear(struct ratio *r);
void ratio_copy(struct ratio *out, const struct ratio *r);
/* Sign of x - y. */
int ratio_compare(const struct ratio *x, const struct ratio *y, mpz_t scratch[2]);

/* The part of the line segment s -> w(s), s in [0,1], that lies in the slabs applied so far. */
struct span {
    /* Within the slabs that pin, and [0,1]: closed. */
    struct ratio window[2];
    /* Strictly within the others: open; where not bounded, all of [0,1] is inside. */
    struct ratio open[2];
    bool bounded[2];
    bool interior; /* false: all of the segment lies on a bound of a slab that does not pin */
    struct ratio at;
    mpz_t scratch[2];
};

void span_init(struct span *span);
void span_clear(struct span *span);

/* Applies a slab to a segment along which normal . w goes from f0 (s = 0) to f1 (s = 1).
 * Returns false if nothing is left of the segment; the span must then not be asked. */
bool span_apply(struct span *span, const mpz_t f0, const mpz_t f1, const mpz_t low,
                const mpz_t high, bool pins);

/* The closed part: within all slabs, bounds included. lower <= upper. Pointers into the span. */
const struct ratio *span_lower(struct span *span);
const struct ratio *span_upper(struct span *span);

/* Whether some s of the window lies strictly within all slabs that do not pin. */
bool span_has_interior(struct span *span);

/* A place in the world and a time of the window, as fractions. */
struct exact_point {
    mpz_t at[3], tau; /* numerators; the place times 2^unit of the pair, tau in windows */
    mpz_t den;        /* > 0 */
};

/* Called for each point in turn. The point is the walker's. */
typedef void (*point_visit)(void *context, const struct exact_point *point);

/* Walks points whose convex hull, in space and time, is the closed intersection of the frames
 * over the window: all its vertices, and others, some more than once. Not one if they never
 * meet. The tau of a static pair is 0. */
void points_walk(struct exact_pair *pair, point_visit visit, void *context);

/* The box of the intersection of a pair in contact, over the window, ends rounded outward. */
void exact_pair_box(struct exact_pair *pair, double box[2][FMB_DIM_MAX]);
void exact_box(const struct frame_pair *pair, double box[2][FMB_DIM_MAX]);

/* The verdict; of a pair in contact that moves also the times, where contact is not NULL: [first,
 * last], in seconds, rounded outward. */
enum fmb_verdict exact_verdict(struct exact_pair *exact, double duration, double contact[2]);

/* The method `exact`, but for the gap. */
enum fmb_status exact_decide(const struct frame_pair *pair, unsigned want,
                             struct fmb_answer *answer);

#endif
