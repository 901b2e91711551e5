/* Method. M(s) = B - A is a polytope. Finitely many directions n decide its verdict:
 *
 *     n . m > 0 for all vertices m of M, for some n:                        separated
 *     otherwise, n . m >= 0 for all m, and > 0 for some m, for some n:      touching
 *     otherwise:                                                            overlapping
 *
 * if they include the normals of all facets of M within the plane, the line or the space that M
 * spans, and a basis of the orthogonal complement of this span. Proof: the relative interiors meet
 * if and only if 0 is in the relative interior of M. If 0 is not in the affine hull of M, some n of
 * the basis has the same n . m for all m, and it is not 0. Otherwise 0 is outside M, or on its
 * boundary, if and only if n . m > 0 for all m, or n . m >= 0 for all m, for the normal n of a
 * facet; and n . m is not 0 for all m, as n lies in the span of M.
 *
 * The directions. Each facet of a solid M comes from a face of A, a face of B, or an edge of each.
 * A flat M lies in a plane parallel to A or to B, if one of these is flat, or is a parallelogram of
 * two segments. The lists of faces and edges therefore also contain, for
 *
 *     a polygon     its normal, as a face and as an edge, and the normals of its edges within its
 *                   plane, as faces;
 *     a segment     itself, and two vectors perpendicular to it, as faces; in 2D one of these is in
 *                   the plane;
 *     a point       the axes, as faces.
 *
 * Two segments e and f in 3D also have the directions e x (e x f) and f x (e x f). Unneeded
 * directions do no harm. In 2D everything lies in the plane z = 0 of space.
 *
 * The polynomials. The entries of N(s) = |q(s)|^2 R(q(s)) are polynomials of degree 2. So
 * F(s) = n(s) . m(s), times |q_A|^2 |q_B|^2, is a polynomial for each direction and each pair of
 * vertices; positive factors are divided out. The verdict is constant between the roots of these
 * polynomials. Consider an interval on which they have no roots, or only one root, common to all of
 * them that have any (their greatest common divisor has it, too). The signs at both ends, on both
 * sides of the root, and at the root, where the polynomials that have it are 0, decide this
 * interval. Other intervals are halved. Sturm's theorem counts roots. A polynomial with one sign on
 * a whole interval is not examined again within it; nor is a direction if two of its polynomials
 * have different signs there. */
#include "turning.h"

#include <string.h>

#include "memory.h"
#include "oracle.h"
#include "polynomial.h"
#include "rational_solid.h"

enum {
    FACES_MAX = 130,
    EDGES_MAX = 60,
    HALVINGS_MAX = 700,
    FEW = 40, /* up to so many open polynomials, roots are counted at once */
    WIDE = 6, /* after so many halvings, roots are counted anyway */
    BITS = 64 /* halvings, at least, that enclose a time of contact */
};

typedef mpz_t vector[3];
typedef struct polynomial polynomial_vector[3];

static void vector_init(vector v)
{
    mpz_inits(v[0], v[1], v[2], NULL);
}

static void vector_clear(vector v)
{
    mpz_clears(v[0], v[1], v[2], NULL);
}

static bool is_zero(vector v)
{
    return !mpz_sgn(v[0]) && !mpz_sgn(v[1]) && !mpz_sgn(v[2]);
}

static void cross(vector x, vector y, vector out)
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        mpz_mul(out[i], x[j], y[k]);
        mpz_submul(out[i], x[k], y[j]);
    }
}

static void subtract(vector x, vector y, vector out)
{
    for (int i = 0; i < 3; i++)
        mpz_sub(out[i], x[i], y[i]);
}

static int sign_of_dot(vector x, vector y)
{
    mpz_t sum;
    mpz_init(sum);
    for (int i = 0; i < 3; i++)
        mpz_addmul(sum, x[i], y[i]);
    const int sign = mpz_sgn(sum);
    mpz_clear(sum);
    return sign;
}

static void polynomial_vector_init(polynomial_vector v)
{
    for (int i = 0; i < 3; i++)
        polynomial_init(&v[i]);
}

static void polynomial_vector_clear(polynomial_vector v)
{
    for (int i = 0; i < 3; i++)
        polynomial_clear(&v[i]);
}

static void polynomial_dot(struct polynomial *out, polynomial_vector x, polynomial_vector y)
{
    for (int i = 0; i < 3; i++)
        polynomial_add(out, 1, &x[i], &y[i]);
}

static void polynomial_cross(polynomial_vector x, polynomial_vector y, polynomial_vector out)
{
    for (int i = 0; i < 3; i++) {
        polynomial_add(&out[i], 1, &x[(i + 1) % 3], &y[(i + 2) % 3]);
        polynomial_add(&out[i], -1, &x[(i + 2) % 3], &y[(i + 1) % 3]);
    }
}

/* ---- A frame that moves ---- */

/* In body coordinates. Lengths are multiplied by a scale that both frames share. */
struct motion {
    int vertices, spanned; /* 0: a point; 1: a segment; 2: a polygon; 3 */
    vector vertex[TURNING_VERTICES_MAX];
    int faces, edges;
    vector face[FACES_MAX], edge[EDGES_MAX];
    unsigned facets[FACES_MAX]; /* of a solid: bits, the vertices of each facet */
    polynomial_vector position;
    struct polynomial norm, matrix[3][3];
};

/* Appends a vector unless it is 0 or parallel to one in the list. */
static void take(vector *list, int *count, int most, vector v)
{
    vector across;
    bool known = is_zero(v);
    vector_init(across);
    for (int i = 0; i < *count && !known; i++) {
        cross(list[i], v, across);
        known = is_zero(across);
    }
    vector_clear(across);
    if (known)
        return;
    if (*count == most) {
        fprintf(stderr, "a polytope with too many faces\n");
        exit(EXIT_FAILURE);
    }
    for (int i = 0; i < 3; i++)
        mpz_set(list[*count][i], v[i]);
    (*count)++;
}

/* Whether all vertices are on one side of the plane through vertex i with normal n. on := the
 * vertices in this plane. */
static bool supports(struct motion *motion, int i, vector n, unsigned *on)
{
    vector way;
    bool side[2] = {false, false};
    *on = 0;
    vector_init(way);
    for (int v = 0; v < motion->vertices; v++) {
        subtract(motion->vertex[v], motion->vertex[i], way);
        const int sign = sign_of_dot(way, n);
        *on |= sign == 0 ? 1U << v : 0;
        side[0] = side[0] || sign < 0;
        side[1] = side[1] || sign > 0;
    }
    vector_clear(way);
    return !(side[0] && side[1]);
}

static void list_solid(struct motion *motion)
{
    vector one, other, n;
    unsigned on;
    int facets = 0;
    vector_init(one), vector_init(other), vector_init(n);
    for (int i = 0; i < motion->vertices; i++)
        for (int j = 0; j < i; j++)
            for (int k = 0; k < j; k++) {
                subtract(motion->vertex[j], motion->vertex[i], one);
                subtract(motion->vertex[k], motion->vertex[i], other);
                cross(one, other, n);
                bool is_new = !is_zero(n) && supports(motion, i, n, &on);
                for (int f = 0; f < facets && is_new; f++)
                    is_new = motion->facets[f] != on;
                if (!is_new)
                    continue;
                motion->facets[facets++] = on;
                take(motion->face, &motion->faces, FACES_MAX, n);
            }
    for (int i = 0; i < motion->vertices; i++)
        for (int j = 0; j < i; j++) {
            int shared = 0;
            for (int f = 0; f < facets; f++)
                shared += motion->facets[f] >> i & motion->facets[f] >> j & 1;
            subtract(motion->vertex[i], motion->vertex[j], one);
            if (shared >= 2)
                take(motion->edge, &motion->edges, EDGES_MAX, one);
        }
    vector_clear(one), vector_clear(other), vector_clear(n);
}

static void list_polygon(struct motion *motion, vector normal)
{
    vector edge, n;
    unsigned on;
    vector_init(edge), vector_init(n);
    take(motion->face, &motion->faces, FACES_MAX, normal);
    take(motion->edge, &motion->edges, EDGES_MAX, normal);
    for (int i = 0; i < motion->vertices; i++)
        for (int j = 0; j < i; j++) {
            subtract(motion->vertex[j], motion->vertex[i], edge);
            cross(normal, edge, n);
            if (is_zero(edge) || !supports(motion, i, n, &on))
                continue;
            take(motion->face, &motion->faces, FACES_MAX, n);
            take(motion->edge, &motion->edges, EDGES_MAX, edge);
        }
    vector_clear(edge), vector_clear(n);
}

static void list_segment(struct motion *motion, vector edge)
{
    vector axis, n, other;
    int zero = 2;
    vector_init(axis), vector_init(n), vector_init(other);
    for (int i = 0; i < 3; i++)
        if (mpz_sgn(edge[i]) == 0)
            zero = i; /* the last: in 2D always 2 */
    mpz_set_ui(axis[zero], 1);
    cross(axis, edge, n);
    if (is_zero(n)) {
        mpz_set_ui(axis[zero], 0);
        mpz_set_ui(axis[(zero + 1) % 3], 1);
        cross(axis, edge, n);
    }
    cross(n, edge, other);
    take(motion->face, &motion->faces, FACES_MAX, edge);
    take(motion->face, &motion->faces, FACES_MAX, n);
    take(motion->face, &motion->faces, FACES_MAX, other);
    take(motion->edge, &motion->edges, EDGES_MAX, edge);
    vector_clear(axis), vector_clear(n), vector_clear(other);
}

static void list_features(struct motion *motion)
{
    vector way, edge, normal, n;
    vector_init(way), vector_init(edge), vector_init(normal), vector_init(n);
    motion->spanned = 0;
    for (int v = 1; v < motion->vertices; v++) {
        subtract(motion->vertex[v], motion->vertex[0], way);
        cross(edge, way, n);
        if (motion->spanned == 0 && !is_zero(way)) {
            motion->spanned = 1;
            subtract(way, normal, edge); /* normal is 0 */
        } else if (motion->spanned == 1 && !is_zero(n)) {
            motion->spanned = 2;
            cross(edge, way, normal);
        } else if (motion->spanned == 2 && sign_of_dot(normal, way) != 0) {
            motion->spanned = 3;
        }
    }
    if (motion->spanned == 3)
        list_solid(motion);
    else if (motion->spanned == 2)
        list_polygon(motion, normal);
    else if (motion->spanned == 1)
        list_segment(motion, edge);
    for (int i = 0; i < 3 && motion->spanned == 0; i++) {
        mpz_set_ui(normal[i], 1);
        take(motion->face, &motion->faces, FACES_MAX, normal);
        mpz_set_ui(normal[i], 0);
    }
    vector_clear(way), vector_clear(edge), vector_clear(normal), vector_clear(n);
}

static void set_scaled(mpz_t out, const mpq_t x, const mpz_t scale)
{
    mpz_mul(out, mpq_numref(x), scale);
    mpz_divexact(out, out, mpq_denref(x));
}

/* The vertices of a cuboid are sums of columns. */
static int count_vertices(const struct rational_solid *solid)
{
    return solid->hull ? solid->count : 1 << solid->count;
}

static void set_vertices(struct motion *motion, struct rational_solid *solid, const mpz_t scale)
{
    mpz_t length;
    mpz_init(length);
    motion->vertices = count_vertices(solid);
    for (int v = 0; v < motion->vertices; v++)
        for (int axis = 0; axis < 3; axis++) {
            set_scaled(motion->vertex[v][axis], solid->origin[axis], scale);
            for (int i = 0; i < solid->count; i++) {
                set_scaled(length, solid->column[i][axis], scale);
                if (solid->hull ? i == v : v >> i & 1)
                    mpz_add(motion->vertex[v][axis], motion->vertex[v][axis], length);
            }
        }
    mpz_clear(length);
}

static void set_turn(struct motion *motion, const struct fmb_placement *placement)
{
    static const int sign[3][4] = {{1, 1, -1, -1}, {1, -1, 1, -1}, {1, -1, -1, 1}};
    struct polynomial q[4], two;
    mpq_t number[2][4];
    mpz_t scale, end[2];
    mpz_inits(scale, end[0], end[1], NULL);
    mpz_set_ui(scale, 1);
    for (int i = 0; i < 8; i++)
        mpq_init(number[i / 4][i % 4]);
    rational_orientation(placement, number[0], number[1]);
    for (int i = 0; i < 8; i++)
        mpz_lcm(scale, scale, mpq_denref(number[i / 4][i % 4]));
    polynomial_init(&two);
    mpz_set_ui(end[0], 2);
    polynomial_set_line(&two, end[0], end[0]);
    for (int i = 0; i < 4; i++) {
        polynomial_init(&q[i]);
        set_scaled(end[0], number[0][i], scale);
        set_scaled(end[1], number[1][i], scale);
        polynomial_set_line(&q[i], end[0], end[1]);
        polynomial_add(&motion->norm, 1, &q[i], &q[i]);
        for (int axis = 0; axis < 3; axis++)
            polynomial_add(&motion->matrix[axis][axis], sign[axis][i], &q[i], &q[i]);
    }
    for (int axis = 0; axis < 3; axis++) { /* i x j = axis */
        const int i = (axis + 1) % 3, j = (axis + 2) % 3;
        for (int side = 0; side < 2; side++) {
            struct polynomial *out = side ? &motion->matrix[j][i] : &motion->matrix[i][j], sum;
            polynomial_init(&sum);
            polynomial_add(&sum, 1, &q[1 + i], &q[1 + j]);
            polynomial_add(&sum, side ? 1 : -1, &q[0], &q[1 + axis]);
            polynomial_add(out, 1, &sum, &two);
            polynomial_clear(&sum);
        }
    }
    for (int i = 0; i < 8; i++)
        mpq_clear(number[i / 4][i % 4]);
    for (int i = 0; i < 4; i++)
        polynomial_clear(&q[i]);
    polynomial_clear(&two);
    mpz_clears(scale, end[0], end[1], NULL);
}

static void motion_init(struct motion *motion)
{
    memset(motion, 0, sizeof *motion);
    for (int i = 0; i < TURNING_VERTICES_MAX; i++)
        vector_init(motion->vertex[i]);
    for (int i = 0; i < FACES_MAX; i++)
        vector_init(motion->face[i]);
    for (int i = 0; i < EDGES_MAX; i++)
        vector_init(motion->edge[i]);
    polynomial_vector_init(motion->position);
    polynomial_init(&motion->norm);
    for (int i = 0; i < 3; i++)
        polynomial_vector_init(motion->matrix[i]);
}

static void motion_clear(struct motion *motion)
{
    for (int i = 0; i < TURNING_VERTICES_MAX; i++)
        vector_clear(motion->vertex[i]);
    for (int i = 0; i < FACES_MAX; i++)
        vector_clear(motion->face[i]);
    for (int i = 0; i < EDGES_MAX; i++)
        vector_clear(motion->edge[i]);
    polynomial_vector_clear(motion->position);
    polynomial_clear(&motion->norm);
    for (int i = 0; i < 3; i++)
        polynomial_vector_clear(motion->matrix[i]);
}

/* out := N v. */
static void turn(struct motion *motion, vector v, polynomial_vector out)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            polynomial_add_times(&out[i], &motion->matrix[i][j], v[j]);
}

/* ---- The directions ---- */

struct direction {
    int first, count; /* of polynomials */
};

struct turning {
    struct motion motion[2];
    polynomial_vector way; /* from A's position to B's */
    struct polynomial *polynomial;
    struct sturm **sturm; /* NULL: not computed yet */
    struct direction *direction;
    int polynomials, directions;
    struct turning_truth *truth;
};

static bool is_equal(const struct polynomial *x, const struct polynomial *y)
{
    bool equal = x->degree == y->degree;
    for (int i = 0; i <= x->degree && equal; i++)
        equal = mpz_cmp(x->c[i], y->c[i]) == 0;
    return equal;
}

/* out := the distinct n . N v of the vertices v of a side, divided by divisor and multiplied by
 * factor; either may be NULL. Returns how many. */
static int heights(struct motion *motion, polynomial_vector n, const struct polynomial *divisor,
                   const struct polynomial *factor, struct polynomial *out)
{
    int count = 0;
    for (int v = 0; v < motion->vertices; v++) {
        polynomial_vector point;
        struct polynomial height;
        polynomial_vector_init(point);
        polynomial_init(&height);
        polynomial_init(&out[count]);
        turn(motion, motion->vertex[v], point);
        polynomial_dot(&height, n, point);
        if (divisor)
            polynomial_divide(&height, divisor);
        if (factor)
            polynomial_add(&out[count], 1, &height, factor);
        else
            polynomial_set(&out[count], &height);
        bool is_new = true;
        for (int i = 0; i < count; i++)
            is_new = is_new && !is_equal(&out[i], &out[count]);
        if (!is_new)
            polynomial_clear(&out[count]);
        count += is_new;
        polynomial_clear(&height);
        polynomial_vector_clear(point);
    }
    return count;
}

/* Adds a direction and its polynomials: n . m times |q_A|^2 |q_B|^2, divided by |q_A|^2 if divide_a
 * and by |q_B|^2 if divide_b. */
static void add_direction(struct turning *turning, polynomial_vector n, bool divide_a,
                          bool divide_b)
{
    const struct polynomial *norm[2] = {&turning->motion[0].norm, &turning->motion[1].norm};
    const bool divide[2] = {divide_a, divide_b};
    struct polynomial height[2][TURNING_VERTICES_MAX], base, raised;
    int count[2];
    for (int side = 0; side < 2; side++)
        count[side] = heights(&turning->motion[side], n, divide[side] ? norm[side] : NULL,
                              divide[1 - side] ? NULL : norm[1 - side], height[side]);
    polynomial_init(&base);
    polynomial_dot(&base, n, turning->way);
    for (int side = 0; side < 2; side++) {
        if (divide[side])
            continue;
        polynomial_init(&raised);
        polynomial_add(&raised, 1, &base, norm[side]);
        polynomial_clear(&base);
        base = raised;
    }
    const int first = turning->polynomials, more = count[0] * count[1];
    turning->polynomial =
        realloc(turning->polynomial, (size_t) (first + more) * sizeof *turning->polynomial);
    turning->direction = realloc(turning->direction,
                                 (size_t) (turning->directions + 1) * sizeof *turning->direction);
    mpz_t one, minus_one;
    mpz_init_set_si(one, 1), mpz_init_set_si(minus_one, -1);
    bool any = false;
    for (int i = 0; i < count[0]; i++)
        for (int j = 0; j < count[1]; j++) {
            struct polynomial *p = &turning->polynomial[turning->polynomials++];
            polynomial_init(p);
            polynomial_set(p, &base);
            polynomial_add_times(p, &height[0][i], minus_one);
            polynomial_add_times(p, &height[1][j], one);
            any = any || p->degree >= 0;
        }
    if (any)
        turning->direction[turning->directions++] = (struct direction){first, more};
    mpz_clears(one, minus_one, NULL);
    polynomial_clear(&base);
    for (int side = 0; side < 2; side++)
        for (int i = 0; i < count[side]; i++)
            polynomial_clear(&height[side][i]);
}

static void add_edges(struct turning *turning, vector e, vector f)
{
    const bool segments = turning->motion[0].spanned == 1 && turning->motion[1].spanned == 1;
    polynomial_vector edge[2], n, in_plane;
    polynomial_vector_init(edge[0]), polynomial_vector_init(edge[1]), polynomial_vector_init(n);
    turn(&turning->motion[0], e, edge[0]);
    turn(&turning->motion[1], f, edge[1]);
    polynomial_cross(edge[0], edge[1], n);
    add_direction(turning, n, true, true);
    for (int side = 0; side < 2 && segments; side++) {
        polynomial_vector_init(in_plane);
        polynomial_cross(edge[side], n, in_plane);
        add_direction(turning, in_plane, false, false);
        polynomial_vector_clear(in_plane);
    }
    polynomial_vector_clear(edge[0]), polynomial_vector_clear(edge[1]), polynomial_vector_clear(n);
}

static void add_directions(struct turning *turning)
{
    for (int side = 0; side < 2; side++) {
        struct motion *motion = &turning->motion[side];
        for (int i = 0; i < motion->faces; i++) {
            polynomial_vector n;
            polynomial_vector_init(n);
            turn(motion, motion->face[i], n);
            add_direction(turning, n, side == 0, side == 1);
            polynomial_vector_clear(n);
        }
    }
    for (int i = 0; i < turning->motion[0].edges; i++)
        for (int j = 0; j < turning->motion[1].edges; j++)
            add_edges(turning, turning->motion[0].edge[i], turning->motion[1].edge[j]);
}

/* ---- Intervals ---- */

/* Signs on a closed interval: -1, 0 and 1; OPEN: unknown or not constant. */
enum { OPEN = 2 };

/* Bits of a direction: n may separate, -n may separate. */
enum { WITH = 1, AGAINST = 2 };

struct node {
    signed char *sign;    /* [polynomials] */
    unsigned char *alive; /* [directions] */
};

static void set_time(mpq_t out, const mpz_t i, unsigned k)
{
    mpz_set(mpq_numref(out), i);
    mpz_set_ui(mpq_denref(out), 1);
    mpz_mul_2exp(mpq_denref(out), mpq_denref(out), k);
    mpq_canonicalize(out);
}

static void lower_to(mpq_t least, const mpq_t x)
{
    if (mpq_cmp(x, least) < 0)
        mpq_set(least, x);
}

static void raise_to(mpq_t most, const mpq_t x)
{
    if (mpq_cmp(x, most) > 0)
        mpq_set(most, x);
}

/* Records a verdict that holds from a time in [from[0], from[1]] to a time in [to[0], to[1]]. */
static void record(struct turning_truth *truth, enum fmb_verdict verdict, mpq_t from[2],
                   mpq_t to[2])
{
    if (verdict > truth->least)
        truth->least = verdict;
    if (verdict > truth->most)
        truth->most = verdict;
    for (int i = 0; i < 2 && verdict != FMB_SEPARATED; i++) {
        lower_to(truth->first[i], from[i]);
        raise_to(truth->last[i], to[i]);
    }
}

/* Records a verdict that holds from i / 2^k to j / 2^k. */
static void record_between(struct turning *turning, enum fmb_verdict verdict, const mpz_t i,
                           const mpz_t j, unsigned k)
{
    mpq_t from[2], to[2];
    mpq_inits(from[0], from[1], to[0], to[1], NULL);
    for (int end = 0; end < 2; end++) {
        set_time(from[end], i, k);
        set_time(to[end], j, k);
    }
    record(turning->truth, verdict, from, to);
    mpq_clears(from[0], from[1], to[0], to[1], NULL);
}

/* Determines signs that are open on the interval. Returns whether the frames are separated there.
 * If not, open := how many polynomials of alive directions remain open, alive := whether any
 * direction is alive. */
static bool look_over(struct turning *turning, struct node *node, const mpz_t i, unsigned k,
                      int *open, bool *alive)
{
    *open = 0;
    *alive = false;
    for (int d = 0; d < turning->directions; d++) {
        const struct direction *direction = &turning->direction[d];
        bool strict = true;
        int found = 0;
        for (int p = direction->first; p < direction->first + direction->count && node->alive[d];
             p++) {
            if (node->sign[p] == OPEN)
                node->sign[p] = (signed char) polynomial_sign_over(&turning->polynomial[p], i, k);
            const int sign = node->sign[p];
            node->alive[d] &= sign == 1 ? WITH : sign == -1 ? AGAINST : WITH | AGAINST;
            strict = strict && (sign == 1 || sign == -1);
            found += sign == OPEN;
        }
        if (!node->alive[d])
            continue;
        if (strict)
            return true;
        *alive = true;
        *open += found;
    }
    return false;
}

/* Verdict at i / 2^k. If common is not NULL: at a root, where the polynomials of common[] are 0 and
 * the others have their signs at i / 2^k. */
static enum fmb_verdict verdict_at(struct turning *turning, const struct node *node, const mpz_t i,
                                   unsigned k, const bool *common)
{
    enum fmb_verdict verdict = FMB_OVERLAPPING;
    for (int d = 0; d < turning->directions && verdict != FMB_SEPARATED; d++) {
        const struct direction *direction = &turning->direction[d];
        bool zero = false, side[2] = {false, false};
        for (int p = direction->first;
             p < direction->first + direction->count && node->alive[d] && !(side[0] && side[1]);
             p++) {
            int sign = node->sign[p];
            if (common && common[p])
                sign = 0;
            else if (sign == OPEN)
                sign = polynomial_sign(&turning->polynomial[p], i, k);
            zero = zero || sign == 0;
            side[0] = side[0] || sign < 0;
            side[1] = side[1] || sign > 0;
        }
        if (side[0] != side[1])
            verdict = zero ? FMB_TOUCHING : FMB_SEPARATED;
    }
    return verdict;
}

static const struct sturm *sturm_of(struct turning *turning, int p)
{
    if (!turning->sturm[p]) {
        turning->sturm[p] = memory_get(sizeof *turning->sturm[p]);
        sturm_init(turning->sturm[p], &turning->polynomial[p]);
    }
    return turning->sturm[p];
}

/* common[p] := whether polynomial p has a root in the open interval. divisor := the greatest common
 * divisor of all polynomials that do, 0 if there are none. Returns false if a polynomial has
 * several roots there, or if the divisor is constant. */
static bool have_one_root(struct turning *turning, const struct node *node, const mpz_t from,
                          const mpz_t to, unsigned k, bool *common, struct polynomial *divisor)
{
    for (int d = 0; d < turning->directions; d++) {
        const struct direction *direction = &turning->direction[d];
        for (int p = direction->first; p < direction->first + direction->count && node->alive[d];
             p++) {
            if (node->sign[p] != OPEN)
                continue;
            const struct sturm *sturm = sturm_of(turning, p);
            const int roots = sturm_between(sturm, from, to, k);
            if (roots > 1)
                return false;
            common[p] = roots == 1;
            if (common[p] && divisor->degree < 0)
                polynomial_set(divisor, &sturm->p[0]);
            else if (common[p] && !is_equal(divisor, &sturm->p[0]))
                polynomial_gcd(divisor, &sturm->p[0]);
            if (divisor->degree == 0)
                return false;
        }
    }
    return true;
}

/* Encloses the root of the divisor. In: the open interval. Out: an interval of more halvings whose
 * ends are both strictly within it. Returns false unless the divisor has one root there, or if a
 * midpoint is the root. */
static bool enclose(const struct polynomial *divisor, mpz_t from, mpz_t to, unsigned *k)
{
    struct sturm sturm;
    mpz_t middle;
    bool moved[2] = {false, false};
    sturm_init(&sturm, divisor);
    mpz_init(middle);
    bool found = sturm_between(&sturm, from, to, *k) == 1;
    const unsigned enough = *k + BITS;
    while (found && !(moved[0] && moved[1] && *k >= enough)) {
        mpz_add(middle, from, to);
        mpz_mul_2exp(from, from, 1);
        mpz_mul_2exp(to, to, 1);
        (*k)++;
        found = polynomial_sign(divisor, middle, *k) != 0;
        const bool before = sturm_between(&sturm, from, middle, *k) == 1;
        mpz_set(before ? to : from, middle);
        moved[before] = true;
    }
    mpz_clear(middle);
    sturm_clear(&sturm);
    return found;
}

/* Decides the closed interval if it has at most one root. Returns whether it was decided. */
static bool decide_by_root(struct turning *turning, const struct node *node, const mpz_t i,
                           unsigned k)
{
    bool *common = memory_get((size_t) turning->polynomials + 1);
    struct polynomial divisor;
    mpz_t end[2], near[2];
    mpz_inits(end[0], end[1], near[0], near[1], NULL);
    polynomial_init(&divisor);
    mpz_set(end[0], i);
    mpz_add_ui(end[1], i, 1);
    mpz_set(near[0], end[0]);
    mpz_set(near[1], end[1]);
    unsigned fine = k;
    bool done = have_one_root(turning, node, end[0], end[1], k, common, &divisor);
    const bool root = divisor.degree >= 0;
    done = done && (!root || enclose(&divisor, near[0], near[1], &fine));
    if (done) {
        for (int side = 0; side < 2; side++)
            record_between(turning, verdict_at(turning, node, end[side], k, NULL), end[side],
                           end[side], k);
        if (!root) {
            mpz_add(near[0], end[0], end[1]);
            record_between(turning, verdict_at(turning, node, near[0], k + 1, NULL), end[0], end[1],
                           k);
        } else {
            mpq_t from[2], to[2];
            mpq_inits(from[0], from[1], to[0], to[1], NULL);
            for (int side = 0; side < 3; side++) { /* before, after, at the root */
                const bool before = side == 0, after = side == 1;
                set_time(from[0], before ? end[0] : near[0], before ? k : fine);
                set_time(from[1], before ? end[0] : near[1], before ? k : fine);
                set_time(to[0], after ? end[1] : near[0], after ? k : fine);
                set_time(to[1], after ? end[1] : near[1], after ? k : fine);
                record(turning->truth,
                       verdict_at(turning, node, near[after], fine, side == 2 ? common : NULL),
                       from, to);
            }
            mpq_clears(from[0], from[1], to[0], to[1], NULL);
        }
    }
    mpz_clears(end[0], end[1], near[0], near[1], NULL);
    polynomial_clear(&divisor);
    free(common);
    return done;
}

/* Gives up: the interval may have any verdict. */
static void leave_open(struct turning *turning, const mpz_t i, unsigned k)
{
    mpz_t next;
    mpq_t time;
    mpz_init(next);
    mpq_init(time);
    mpz_add_ui(next, i, 1);
    turning->truth->most = FMB_OVERLAPPING;
    turning->truth->whole = false;
    set_time(time, i, k);
    lower_to(turning->truth->first[0], time);
    set_time(time, next, k);
    raise_to(turning->truth->last[1], time);
    mpz_clear(next);
    mpq_clear(time);
}

static void visit(struct turning *turning, const mpz_t i, unsigned k, const struct node *above)
{
    struct node node = {memory_get((size_t) turning->polynomials + 1),
                        memory_get((size_t) turning->directions + 1)};
    mpz_t next;
    int open;
    bool alive;
    memcpy(node.sign, above->sign, (size_t) turning->polynomials);
    memcpy(node.alive, above->alive, (size_t) turning->directions);
    mpz_init(next);
    if (!look_over(turning, &node, i, k, &open, &alive)) {
        mpz_add_ui(next, i, 1);
        if (!alive) {
            record_between(turning, FMB_OVERLAPPING, i, next, k);
        } else if ((open > FEW && k < WIDE) || !decide_by_root(turning, &node, i, k)) {
            if (k == HALVINGS_MAX)
                leave_open(turning, i, k);
            mpz_mul_2exp(next, i, 1);
            for (int half = 0; half < 2 && k < HALVINGS_MAX; half++) {
                visit(turning, next, k + 1, &node);
                mpz_add_ui(next, next, 1);
            }
        }
    }
    mpz_clear(next);
    free(node.sign);
    free(node.alive);
}

/* ---- The whole window ---- */

static void set_scale(mpz_t scale, const struct rational_solid *solid)
{
    for (int axis = 0; axis < 3; axis++) {
        mpz_lcm(scale, scale, mpq_denref(solid->origin[axis]));
        for (int i = 0; i < solid->count; i++)
            mpz_lcm(scale, scale, mpq_denref(solid->column[i][axis]));
    }
}

/* The positions at both ends of the window, as points. */
static void set_ends(const struct fmb_frame *frame, const struct fmb_placement *placement,
                     double duration, struct rational_solid end[2])
{
    struct fmb_frame point = {.dim = frame->dim, .shape = FMB_CUBOID};
    mpq_t at;
    mpq_init(at);
    for (int i = 0; i < 2; i++) {
        mpq_set_ui(at, (unsigned long) i, 1);
        rational_solid_init_at(&point, placement, at, duration, &end[i]);
    }
    mpq_clear(at);
}

static void decide_frames(const struct pair *pair, const struct fmb_frame *frame[2],
                          struct turning_truth *truth)
{
    struct turning *turning = memory_get(sizeof *turning);
    const struct fmb_placement *placement[2] = {&pair->a, &pair->b};
    struct rational_solid local[2], end[2][2];
    mpz_t scale, x, y;
    mpz_inits(scale, x, y, NULL);
    mpz_set_ui(scale, 1);
    turning->truth = truth;
    polynomial_vector_init(turning->way);
    for (int side = 0; side < 2; side++) {
        const struct fmb_placement still = {.body = placement[side]->body};
        rational_solid_init(frame[side], &still, &local[side]);
        set_ends(frame[side], placement[side], pair->duration, end[side]);
        set_scale(scale, &local[side]);
        set_scale(scale, &end[side][0]);
        set_scale(scale, &end[side][1]);
    }
    for (int side = 0; side < 2; side++) {
        struct motion *motion = &turning->motion[side];
        motion_init(motion);
        set_vertices(motion, &local[side], scale);
        list_features(motion);
        set_turn(motion, placement[side]);
        for (int axis = 0; axis < 3; axis++) {
            set_scaled(x, end[side][0].origin[axis], scale);
            set_scaled(y, end[side][1].origin[axis], scale);
            polynomial_set_line(&motion->position[axis], x, y);
            mpz_set_si(x, side == 0 ? -1 : 1);
            polynomial_add_times(&turning->way[axis], &motion->position[axis], x);
        }
    }
    add_directions(turning);
    struct node all = {memory_get((size_t) turning->polynomials + 1),
                       memory_get((size_t) turning->directions + 1)};
    memset(all.sign, OPEN, (size_t) turning->polynomials);
    memset(all.alive, WITH | AGAINST, (size_t) turning->directions);
    turning->sturm = memory_get((size_t) (turning->polynomials + 1) * sizeof *turning->sturm);
    mpz_set_ui(x, 0);
    visit(turning, x, 0, &all);
    for (int p = 0; p < turning->polynomials; p++) {
        polynomial_clear(&turning->polynomial[p]);
        if (turning->sturm[p])
            sturm_clear(turning->sturm[p]);
        free(turning->sturm[p]);
    }
    for (int side = 0; side < 2; side++) {
        motion_clear(&turning->motion[side]);
        rational_solid_clear(&local[side]);
        rational_solid_clear(&end[side][0]);
        rational_solid_clear(&end[side][1]);
    }
    polynomial_vector_clear(turning->way);
    mpz_clears(scale, x, y, NULL);
    free(turning->polynomial);
    free(turning->sturm);
    free(turning->direction);
    free(all.sign);
    free(all.alive);
    free(turning);
}

void turning_init(struct turning_truth *truth)
{
    truth->least = truth->most = FMB_SEPARATED;
    truth->whole = true;
    mpq_inits(truth->first[0], truth->first[1], truth->last[0], truth->last[1], NULL);
    for (int i = 0; i < 2; i++) {
        mpq_set_si(truth->first[i], 2, 1);
        mpq_set_si(truth->last[i], -1, 1);
    }
}

void turning_clear(struct turning_truth *truth)
{
    mpq_clears(truth->first[0], truth->first[1], truth->last[0], truth->last[1], NULL);
}

static bool takes(const struct fmb_frame *frame)
{
    return frame->radius == 0 &&
           (frame->shape != FMB_HULL || frame->vertex_count <= TURNING_VERTICES_MAX);
}

void turning_decide(const struct pair *pair, struct turning_truth *truth)
{
    for (unsigned i = 0; i < pair->a.body->frame_count; i++)
        for (unsigned j = 0; j < pair->b.body->frame_count; j++) {
            const struct fmb_frame *frame[2] = {fmb_body_frame(pair->a.body, i),
                                                fmb_body_frame(pair->b.body, j)};
            if (takes(frame[0]) && takes(frame[1])) {
                decide_frames(pair, frame, truth);
                continue;
            }
            truth->most = FMB_OVERLAPPING;
            truth->whole = false;
            mpq_set_ui(truth->first[0], 0, 1);
            mpq_set_ui(truth->last[1], 1, 1);
        }
}

enum fmb_verdict turning_look(const struct pair *pair, const mpq_t time,
                              struct turning_truth *truth)
{
    struct pair moment = *pair;
    struct oracle_answer answer;
    mpq_t at[2];
    moment.at = time;
    mpq_inits(at[0], at[1], NULL);
    mpq_set(at[0], time);
    mpq_set(at[1], time);
    oracle_init(&answer);
    oracle_decide(&moment, 0, &answer);
    record(truth, answer.verdict, at, at);
    mpq_clears(at[0], at[1], NULL);
    oracle_clear(&answer);
    return answer.verdict;
}
