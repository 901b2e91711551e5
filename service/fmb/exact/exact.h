/* The exact step: decisions in integers of any size.
 *
 * A pair is converted to integers (exact_pair). Its verdict, interval and box all come from one
 * line against one polytope. The polytope is a set of slabs (exact_slabs.c); the part of the line
 * inside it is a clipped_segment (exact_span.c).
 *
 * Everything is three-dimensional here: a 2D frame lies in the plane z = 0, where it is a flat
 * frame like any other and needs no case of its own.
 *
 * Time is measured in windows: tau = t / T in [0,1]. Motion is the displacement v T over the whole
 * window, so that T = 0 is no special case either: nothing moves. */
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
 * drift. All quantities of the exact step are linear in them: edges, vertices, and their
 * projections on normals. */
enum {
    EXACT_OF_B = 3,
    EXACT_OFFSET = 6,
    EXACT_DRIFT = 7,
    EXACT_VECTORS = 8,
    EXACT_TRIPLES = 56 /* of 8 */
};

/* A direction of edges: vector plus - vector minus, or vector plus if minus < 0. */
struct exact_edge {
    int plus, minus;
    mpz_t *vector; /* [axis] */
};

/* A frame at tau = 0. All numbers are integers, in units of 2^unit / scale of the pair. */
struct exact_frame {
    int count;             /* components: 2 or 3 */
    bool simplex;          /* tetrahedron or face; else cuboid */
    mpz_t component[3][3]; /* [component][axis]; 0 beyond count */
    mpz_t origin[3];
    mpz_t displacement[3]; /* v T */
    /* The distinct directions of edges: the components; for a simplex also the differences c_j -
     * c_i, i < j, stored in difference. */
    int edges;
    struct exact_edge edge[EXACT_EDGES_MAX];
    mpz_t difference[3][3];
};

struct exact_pair {
    long unit;   /* every length is an integer times 2^unit / scale */
    mpz_t scale; /* > 0; 1 if nothing is rotated */
    bool moving;
    struct exact_frame frame[2];
    mpz_t offset[3]; /* origin of frame[1] - origin of frame[0] */
    mpz_t drift[3];  /* displacement of frame[1] - displacement of frame[0]; 0 if not moving */
    /* (u x v) . w for all vectors numbered u < v < w, in the order of triple_at(). */
    mpz_t triple[EXACT_TRIPLES];
    mpz_t scratch[EXACT_SCRATCH];
};

/* The orientation of a placement. For the smallest integers q proportional to it, n = |q|^2 and n
 * R(q) is a matrix of integers. */
struct exact_turn {
    bool turned;
    mpz_t row[3][3], norm; /* n R(q) and n; if not turned, norm is 1 and row is not used */
};

/* Calls one of mpz_init and mpz_clear for every number. */
void exact_turn_each(struct exact_turn *turn, void (*call)(mpz_ptr));

/* Sets the matrix of a placement. In: all numbers of turn are 0. */
void exact_turn_set(const struct fmb_placement *placement, struct exact_turn *turn);

/* v := n R(q) v times factor. */
void exact_turn_vector(const struct exact_turn *turn, const mpz_t factor, mpz_t v[3]);

/* Returns the largest exponent u such that all lengths of the pair are multiples of 2^u:
 * components, origins, vertices, positions, and displacements v T. */
long exact_pair_unit(const struct frame_pair *pair);

/* Calls one of mpz_init and mpz_clear for every number of a frame. */
void exact_frame_each(struct exact_frame *frame, void (*call)(mpz_ptr));

/* Sets components and origin in body coordinates, in units of 2^unit. Changes displacement. In: not
 * a hull; all numbers are 0. */
void exact_frame_set(struct exact_frame *out, const struct fmb_frame *frame, long unit);

/* Converts a checked pair. difference: the slabs of the difference are needed.
 * exact_pair_clear() frees what exact_pair_init() allocates. */
void exact_pair_init(struct exact_pair *out, const struct frame_pair *pair, bool difference);
void exact_pair_clear(struct exact_pair *pair);

/* Sets edges, offset and drift of a pair from its components, origins and displacements. */
void exact_pair_complete(struct exact_pair *pair);

/* Returns the vector of this number: [axis]. */
mpz_t *exact_vector(struct exact_pair *pair, int number);

/* out := normal . vector number k of the pair. */
void exact_dot(struct exact_pair *pair, mpz_t out, mpz_t normal[3], int k);

/* value[k] := (u x v) . vector k, for all vectors k of the pair. */
void exact_cross_values(struct exact_pair *pair, const struct exact_edge *u,
                        const struct exact_edge *v, mpz_t value[EXACT_VECTORS]);

/* [low, high] := the interval of normal . x over frame f with its origin at 0. value: of the
 * normal. */
void exact_extent(const struct exact_pair *pair, int f, mpz_t value[EXACT_VECTORS], mpz_t low,
                  mpz_t high);

/* The interval of a normal over a set of points. */
struct exact_range {
    mpz_t low, high;
};

/* Calls one of mpz_init and mpz_clear for both numbers. */
void exact_range_each(struct exact_range *range, void (*call)(mpz_ptr));

/* frame[f] := the interval over frame f with its origin at 0; all := that of all b - a over the
 * window, for points a of frame 0 and b of frame 1. value: of the normal. */
void exact_ranges(const struct exact_pair *pair, mpz_t value[EXACT_VECTORS],
                  struct exact_range frame[2], struct exact_range *all);

/* A slab: { w : low <= normal . w <= high }. A slab that pins has low = high: the whole polytope
 * lies in its plane, and such planes define the affine hull of the polytope. */
struct slab {
    mpz_t value[EXACT_VECTORS]; /* normal . each vector of the pair */
    mpz_t low, high;
    bool pins;
    const struct exact_edge *u, *v; /* the normal is u x v; if u is NULL, it is normal */
    mpz_t normal[3];
};

/* Called for each slab; returns false to stop. The slab is valid during the call only. */
typedef bool (*slab_visit)(void *context, struct slab *slab);

/* Calls one of mpz_init and mpz_clear for every number. */
void slab_each(struct slab *slab, void (*call)(mpz_ptr));

/* Computes slab->normal if it is not set yet. */
void slab_set_normal(struct slab *slab, mpz_t scratch);

/* Whose slabs are enumerated. */
enum slabs_of { SLABS_OF_A, SLABS_OF_B, SLABS_OF_DIFFERENCE, SLABS_OF_SWEPT };

/* Returns whether the difference of the frames, a - b, has a volume. */
bool slabs_solid(const struct exact_pair *pair);

/* Calls visit for each slab of a set whose intersection is one frame with its origin at 0, or the
 * Minkowski difference a - b of both with their origins at 0. Returns false if visit stopped it.
 *
 * The frames have a point in common if and only if the offset w = origin of b - origin of a lies in
 * all slabs of the difference. Their relative interiors have one if and only if w also lies
 * strictly between the bounds of all slabs that do not pin.
 *
 * SLABS_OF_SWEPT: only the slabs that a solid difference gets, besides its own, when it is swept
 * along the drift. The drift is constant in them, and the bounds are those of the difference. */
bool slabs_walk(struct exact_pair *pair, enum slabs_of of, slab_visit visit, void *context);

/* num / den, den > 0. */
struct ratio {
    mpz_t num, den;
};

/* Calls one of mpz_init and mpz_clear for both numbers. */
void ratio_each(struct ratio *r, void (*call)(mpz_ptr));

/* Sign of x - y. */
int ratio_compare(const struct ratio *x, const struct ratio *y, mpz_t scratch[2]);

/* out := (bound - f0) / (f1 - f0), where a segment from f0 to f1, which differ, crosses the
 * bound. */
void ratio_cross(struct ratio *out, const mpz_t f0, const mpz_t f1, const mpz_t bound);

/* Raises (side 0) or lowers (side 1) an end to at, if that is tighter or there was no bound. */
void ratio_tighten(struct ratio *end, bool bounded, int side, const struct ratio *at,
                   mpz_t scratch[2]);

/* The part of the line segment s -> w(s), s in [0,1], that lies in the slabs applied so far. */
struct clipped_segment {
    /* The part within the slabs that pin, and [0,1]: closed. */
    struct ratio window[2];
    /* The part strictly within the others: open. An end that is not bounded is that of [0,1], which
     * is inside. */
    struct ratio open[2];
    bool bounded[2];
    bool interior; /* false: all of the segment lies on a bound of a slab that does not pin */
    struct ratio at;
    mpz_t scratch[2];
};

void clipped_segment_init(struct clipped_segment *span);
void clipped_segment_clear(struct clipped_segment *span);

/* Clips a segment along which normal . w goes from f0 (s = 0) to f1 (s = 1). Returns false if
 * nothing is left of it; the functions below must then not be called. */
bool clipped_segment_apply(struct clipped_segment *span, const mpz_t f0, const mpz_t f1,
                           const mpz_t low, const mpz_t high, bool pins);

/* Returns an end of the closed part, within all slabs and their bounds: the lower one (side 0)
 * or the upper one (side 1), which is not below it. The pointer is into the segment. */
const struct ratio *clipped_segment_end(struct clipped_segment *span, int side);

/* Returns whether some s of the window lies strictly within all slabs that do not pin. */
bool clipped_segment_has_interior(struct clipped_segment *span);

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

/* Compute the box of the intersection of a pair in contact over the window, with ends rounded
 * outward. */
void exact_pair_box(struct exact_pair *pair, double box[2][FMB_DIM_MAX]);
void exact_box(const struct frame_pair *pair, double box[2][FMB_DIM_MAX]);

/* Returns the verdict. If contact is not NULL and the pair is in contact and moves, it is set to
 * [first, last], in seconds, rounded outward. */
enum fmb_verdict exact_verdict(struct exact_pair *exact, double duration, double contact[2]);

/* The method exact, without the gap. */
enum fmb_status exact_decide(const struct frame_pair *pair, unsigned want,
                             struct fmb_answer *answer);

#endif
