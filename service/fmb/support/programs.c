/* Pairs by their vertices, in integers: verdict, contact and box from linear programs whose columns
 * are the vertices of D, priced by the support function (column generation). For frames with radii:
 * the point of D nearest to the origin, at the end of this file.
 *
 * Coordinates. All points are integers, in units of 2^unit / scale of the pair
 * (support_integers.h), so that no step rounds. Points enter as 4 x, because the interior point c
 * below is a mean in quarters.
 *
 * 1. Span (span_step()). Finds k + 1 points of D that are affinely independent, k the dimension of
 *    D: starting with the points given, it looks for a point off the flat that is spanned so far,
 *    in a direction orthogonal to it. If all of D is in that flat, that is its affine hull. If this
 *    does not contain the origin, the frames are separated. Else k coordinates are chosen in which
 *    the projection of the flat is one to one; D has an interior there. The point c, a mean of the
 *    k + 1 points with weights of 1/4 and 1/2, lies in it. If k = 3 and the origin is strictly
 *    inside their tetrahedron, they are the basis of step 3, and no ray is shot.
 *
 * 2. Shoot (shoot_step()). The linear program
 *
 *        minimise sum_i a_i   subject to   sum_i a_i (x_i - c) = -c,  a_i >= 0
 *
 *    over vertices x_i of D finds where the ray from c through the origin leaves D: at the origin
 *    itself if the sum is 1; the sum is less than 1 if and only if the origin is in the relative
 *    interior of D, 1 if it is on the boundary, and greater if it is outside. Its basis is k
 *    vertices whose cone with apex c contains the ray: geometrically, a portal through which the
 *    ray passes, as in the Minkowski portal refinement of G. Snethen (Game Programming Gems 7,
 *    2008). The dual solution is the normal N of the portal, N . (x_i - c) = 1. The vertex with the
 *    greatest N . x enters the basis. If N . x < 0 for it, N separates. If N . x = 0 and the sum
 *    is 1, the origin is on the face of D in direction N: the vertices of both frames that attain
 *    the maximum span that face, the sweep contributes what N . w permits, and step 1 is repeated
 *    with them. Their dimension is less, so this ends.
 *    At the end the origin is in the relative interior of a face F of D, of the convex hull of c
 *    and the basis, or it is outside of D.
 *
 * 3. Heights (height_step()). Each end of contact and box is the optimum of
 *
 *        maximise sum_i b_i h(x_i)   subject to   sum_i b_i x_i = 0,  sum_i b_i = 1,  b_i >= 0
 *
 *    over the vertices of F, where h is linear in the vertex of A, that of B, and the time: +-t for
 *    the contact, +-(a + t v_a) along an axis for the box. c and the basis of step 2 are feasible.
 *    A convex combination such as c may stay in the basis, it does not change the optimum.
 *
 * 4. Verdict. OVERLAPPING if at some t the origin is in the relative interior of M + t w. That is
 *    so if and only if no vertex of a frame has been left out by the faces of step 2: relint D is
 *    the union of relint M + t w for 0 < t < T, and a face of D on which N is constant on M is M at
 *    one end of the window. If N is not constant on M, no point of M + t w with N . x = 0, the
 *    greatest value, is in its relative interior: TOUCHING.
 *
 * 5. Proof (programs.h), on request, instead of heights. A normal that separates is known from
 *    step 1 or 2. It is replaced by the shortest of its truncations to a few bits that separates
 *    (shorten_step()).
 *    If the frames touch, the solution of step 2 is the origin as a combination of vertices, and N
 *    is the normal, unless a face N' was taken before, at one end of the window. N then proves the
 *    verdict at that end, where N' . x = 0. If N . x increases towards the other end, the normal is
 *    |N' . w| N + |N . w| N', which is constant along w: on M it is a positive multiple of N, and
 *    so proves the verdict at all times.
 *    If they overlap, the origin is sum a_i x_i + (1 - sum a_i) c, all numbers at least 0 and the
 *    last one positive: c is a mean of the points y_j of the span, all with positive weights. Or
 *    the y_j alone contain it. Let z be a sum of points of D whose vertices span both frames. For
 *    e = 2^-k, the numbers a_i are rounded down to multiples of e, z gets the weight e, and the
 *    weights of the y_j follow, since these are affinely independent. They are positive if e is
 *    small enough. Only the weights of the y_j are long fractions.
 *
 * Both programs have one form: minimise or maximise sum a_i h_i subject to sum a_i H_i = q, a >= 0,
 * with columns H_i of m numbers, m <= 4. With the cofactors C_i of the basis, C_i . H_j = det if
 * i = j, else 0: the solution is a_i = C_i . q / det, the coordinates of an entering column s in
 * the basis are C_i . s / det, and the dual solution is sum h_i C_i / det.
 *
 * Finite: ties in the choice of the leaving column are broken as if the origin were at (e, e^2,
 * ...) for a small e > 0 (the lexicographic rule; Dantzig, Orden and Wolfe, 1955): by C_i . q, then
 * by the coordinates of C_i in order. The first basis has to contain the origin in this order too
 * (passes()). Then no basis repeats, and there are finitely many. The optimum does not depend on
 * the path, so neither does the answer.
 *
 * Pricing. The direction is turned into body coordinates exactly and then rounded. One scan in
 * doubles leaves the vertices within the bound of the greatest value; only these are evaluated
 * exactly. */
#include "programs.h"

#include "integer.h"
#include "integer_simplex.h"
#include "memory.h"
#include "support_integers.h"
#include "support_search.h"

#include <math.h>

enum { ROWS = 4, QUARTERS = 4, KEPT = 8 };

/* A point of D, or a mean of points, times QUARTERS. */
struct point {
    struct support_column column;
    int end;    /* 4 t / T */
    mpz_t x[3]; /* its coordinates */
    mpz_t a[3]; /* of the point of A at its time, in the world; if a box is wanted */
};

/* One placed frame. */
struct side {
    unsigned count; /* of vertices of the face, [0, count) of face */
    uint16_t face[FMB_HULL_VERTICES_MAX];
};

enum stage { SPANNING_A, SPANNING_B, SPANNING, SHOOTING, RAISING, SHORTENING, NEARING, COMPLETE };

struct programs {
    const struct support_pair *pair;
    unsigned want;
    enum stage stage;
    struct support_integers integers;
    struct side side[2];
    /* The numbers of the vertices in kept_at, from 1; 0: none. Of the vertices with the same index
     * modulo KEPT, the one used last is kept. */
    unsigned kept[2][KEPT];
    bool ends[2];           /* of the window, that the face has */
    bool reduced, touching; /* the face is not all of D; it leaves out vertices */
    bool proves;
    bool ends_wanted;                     /* of the contact of a pair that drifts, or of a box */
    unsigned spanning[2][ROWS], spans[2]; /* vertices that span a frame */
    struct programs_proof proof;
    struct support_column first[ROWS];
    unsigned first_count, next_first;

    /* Span: rank + 1 points; the vectors from the first to the others; the direction to be tried.
     */
    int rank, attempt;
    struct point span[ROWS];
    int axis[3]; /* [rank]: the coordinates of the projection */

    /* Programs. */
    int rows;
    struct point centre, basis[ROWS], entering;
    bool basis_set; /* its rows and cofactors are */
    int target; /* the height: an end of the contact, 0 and 1, or of the box, 2 + 2 axis + end */

    enum { GUESS_UNKNOWN, GUESS_GIVEN, GUESS_NONE } guesses;
    struct support_guess guess;

    struct integer_simplex simplex; /* of the nearest point */
    bool simplex_set;

    double contact[2], box[2][FMB_DIM_MAX];

    /* Numbers alone from here on. */
    mpz_t kept_at[2][KEPT][3]; /* vertices in the world at time 0 */
    mpz_t edge[2][3];          /* of the span */
    mpz_t row[ROWS][ROWS], cofactor[ROWS][ROWS], det, dual[ROWS], coordinate[ROWS], enters[ROWS];
    mpz_t height[ROWS];
    mpz_t normal[2][3], body[3], sum, best, scratch[2], denominator, minor[6], vector[3];
};

/* ---- Memory ---- */

static void each(struct programs *e, void (*call)(mpz_ptr))
{
    support_integers_each(&e->integers, call);
    for (int i = 0; i < ROWS; i++) {
        INTEGER_EACH_FROM(x, &e->span[i], call);
        INTEGER_EACH_FROM(x, &e->basis[i], call);
    }
    INTEGER_EACH_FROM(x, &e->centre, call);
    INTEGER_EACH_FROM(x, &e->entering, call);
    if (e->simplex_set)
        integer_simplex_each(&e->simplex, call);
    INTEGER_EACH_FROM(normal, &e->proof, call);
    INTEGER_EACH_FROM(kept_at, e, call);
}

/* ---- Points ---- */

/* sum := n . vertex i, in body coordinates. */
static void set_value(struct programs *e, int f, unsigned i, mpz_t n[3])
{
    const struct support_vertices *vertices = &e->pair->view[f].vertices;
    const struct support_side *side = &e->integers.side[f];
    mpz_set_ui(e->sum, 0);
    for (int axis = 0; axis < vertices->dim; axis++) {
        if (side->frame->shape != FMB_HULL) {
            mpz_addmul(e->sum, n[axis], side->small[i][axis]);
            continue;
        }
        const struct dyadic x = dyadic_of(vertices->at[(size_t) axis * vertices->stride + i]);
        if (x.mantissa == 0)
            continue;
        mpz_mul_si(e->scratch[0], n[axis], x.mantissa);
        mpz_mul_2exp(e->scratch[0], e->scratch[0], (mp_bitcnt_t) (x.exponent - e->integers.unit));
        mpz_add(e->sum, e->sum, e->scratch[0]);
    }
}

/* Returns vertex i of frame f in the world at time 0. The ends of a box, other than a verdict, come
 * back to the same vertices: they are kept. */
static mpz_t *place(struct programs *e, int f, unsigned i)
{
    const unsigned k = e->stage == RAISING ? i % KEPT : 0;
    if (e->kept[f][k] != i + 1)
        support_integers_place(&e->integers, f, i, e->kept_at[f][k]);
    e->kept[f][k] = i + 1;
    return e->kept_at[f][k];
}

/* out := a point of D. */
static void set_difference(struct programs *e, struct support_column column, mpz_t out[3])
{
    mpz_t *a = place(e, 0, column.vertex[0]), *b = place(e, 1, column.vertex[1]);
    for (int axis = 0; axis < 3; axis++) {
        mpz_sub(out[axis], b[axis], a[axis]);
        if (column.end)
            mpz_add(out[axis], out[axis], e->integers.drift[axis]);
    }
}

static void set_point(struct programs *e, struct support_column column, struct point *out)
{
    mpz_t *a = place(e, 0, column.vertex[0]);
    out->column = column;
    out->end = column.end ? QUARTERS : 0;
    set_difference(e, column, out->x);
    for (int axis = 0; axis < 3; axis++) {
        mpz_mul_2exp(out->x[axis], out->x[axis], 2);
        if (!(e->want & FMB_WANT_BOX))
            continue;
        if (column.end)
            mpz_add(out->a[axis], a[axis], e->integers.side[0].displacement[axis]);
        else
            mpz_set(out->a[axis], a[axis]);
        mpz_mul_2exp(out->a[axis], out->a[axis], 2);
    }
}

static void swap_points(struct point *x, struct point *y)
{
    const struct point copy = *x;
    *x = *y;
    *y = copy;
}

/* ---- Pricing ---- */

/* e->body := n in body coordinates, times a positive factor. */
static void turn_back(struct programs *e, int f, mpz_t n[3])
{
    const struct support_turn *turn = &e->integers.side[f].turn;
    for (int j = 0; j < 3; j++) {
        if (!turn->turned) {
            mpz_set(e->body[j], n[j]);
            continue;
        }
        mpz_set_ui(e->body[j], 0);
        for (int i = 0; i < 3; i++)
            mpz_addmul(e->body[j], turn->row[i][j], n[i]);
    }
}

/* Returns the first vertex of the face with the greatest normal[f] . v, in world coordinates.
 * reduce: keeps those vertices alone in the face. */
static unsigned price_side(struct programs *e, int f, bool reduce)
{
    struct side *side = &e->side[f];
    uint16_t listed[FMB_HULL_VERTICES_MAX];
    double n[FMB_DIM_MAX];
    unsigned kept = 0, best = side->face[0];
    bool known = false; /* e->best is the value of best */
    turn_back(e, f, e->normal[f]);
    if (integer_is_zero(e->body))
        return best;
    integer_round(e->body, 3, n);
    const unsigned count = support_view_list(&e->pair->view[f], n, side->face, side->count, listed);
    for (unsigned k = 0; k < count; k++) {
        const unsigned i = listed[k];
        int order = 1;
        if (kept > 0) {
            if (!known) {
                set_value(e, f, best, e->body);
                mpz_swap(e->sum, e->best);
                known = true;
            }
            set_value(e, f, i, e->body);
            order = mpz_cmp(e->sum, e->best);
        }
        if (order > 0) {
            if (kept > 0)
                mpz_swap(e->sum, e->best);
            best = i;
            kept = 0;
        }
        if (order >= 0) {
            if (reduce)
                side->face[kept] = (uint16_t) i;
            kept++;
        }
    }
    if (reduce)
        side->count = kept;
    return best;
}

/* Prices the vertices of the face: normal[0] for A, normal[1] for B, and the sign of what the end
 * of the window adds. */
static struct support_column price(struct programs *e, int end_sign, bool reduce)
{
    struct support_column out;
    for (int f = 0; f < 2; f++)
        out.vertex[f] = price_side(e, f, reduce);
    out.end = e->ends[0] && e->ends[1] ? end_sign > 0 : e->ends[1];
    if (reduce && end_sign != 0 && e->ends[0] && e->ends[1])
        e->ends[end_sign < 0] = false;
    return out;
}

/* out := the sum of the products of two vectors of count numbers. */
static void dot(mpz_t *x, mpz_t *y, int count, mpz_t out)
{
    mpz_mul(out, x[0], y[0]);
    for (int i = 1; i < count; i++)
        mpz_addmul(out, x[i], y[i]);
}

/* Prices n . x, n = normal[1]. */
static struct support_column price_difference(struct programs *e, bool reduce)
{
    for (int axis = 0; axis < 3; axis++)
        mpz_neg(e->normal[0][axis], e->normal[1][axis]);
    dot(e->normal[1], e->integers.drift, 3, e->sum);
    return price(e, mpz_sgn(e->sum), reduce);
}

/* ---- Span ---- */

static void begin_span(struct programs *e, enum stage stage)
{
    e->stage = stage;
    e->rank = -1;
    e->attempt = 0;
}

/* Sets normal[1] to direction number attempt orthogonal to the flat spanned so far; returns false
 * if there is none of this number. Together these directions span the orthogonal complement. */
static bool set_orthogonal(struct programs *e)
{
    mpz_t *n = e->normal[1], *u = e->edge[0], *v = e->edge[1];
    const int dim = e->pair->dim, attempt = e->attempt;
    const int i = attempt, j = (attempt + 1) % 3, k = (attempt + 2) % 3;
    for (int axis = 0; axis < 3; axis++)
        mpz_set_ui(n[axis], 0);
    if (e->rank == 0 && attempt < dim) {
        mpz_set_ui(n[attempt], 1);
    } else if (e->rank == 1 && dim == 2 && attempt == 0) {
        mpz_neg(n[0], u[1]);
        mpz_set(n[1], u[0]);
    } else if (e->rank == 1 && dim == 3 && attempt < 3) { /* unit vector i x u */
        (void) i;
        mpz_neg(n[j], u[k]);
        mpz_set(n[k], u[j]);
    } else if (e->rank == 2 && dim == 3 && attempt == 0) {
        integer_cross(n, u, v, e->scratch[0]);
    } else {
        return false;
    }
    return true;
}

/* Whether point is off the flat spanned so far. If so, it is added. e->entering: the point. */
static bool extend_span(struct programs *e)
{
    mpz_t *edge = e->vector;
    if (e->rank >= 0)
        for (int axis = 0; axis < 3; axis++)
            mpz_sub(edge[axis], e->entering.x[axis], e->span[0].x[axis]);
    if (e->rank == 0 && integer_is_zero(edge))
        return false;
    if (e->rank == 1 || e->rank == 2) {
        mpz_t *normal = e->normal[1];
        integer_cross(normal, e->edge[0], e->rank == 1 ? edge : e->edge[1], e->scratch[0]);
        dot(normal, edge, 3, e->sum);
        if (e->rank == 1 ? integer_is_zero(normal) : mpz_sgn(e->sum) == 0)
            return false;
    }
    e->rank++;
    if (e->rank == 1 || e->rank == 2)
        for (int axis = 0; axis < 3; axis++)
            mpz_swap(e->edge[e->rank - 1][axis], edge[axis]);
    swap_points(&e->span[e->rank], &e->entering);
    e->attempt = 0;
    return true;
}

/* Whether all points of D have the same n . x as the first: the farthest ones in both directions.
 * If not, adds one that does not. n: normal[1]. */
static bool is_constant(struct programs *e)
{
    for (int sign = 0; sign < 2; sign++) {
        set_point(e, price_difference(e, false), &e->entering);
        dot(e->normal[1], e->entering.x, 3, e->best);
        dot(e->normal[1], e->span[0].x, 3, e->sum);
        if (mpz_cmp(e->best, e->sum) != 0)
            return !extend_span(e);
        for (int axis = 0; axis < 3; axis++)
            mpz_neg(e->normal[1][axis], e->normal[1][axis]);
    }
    return true;
}

/* Returns the vertex of the face nearest to a column that may have left it. */
static struct support_column column_in_face(const struct programs *e, struct support_column column)
{
    for (int f = 0; f < 2; f++) {
        const struct side *side = &e->side[f];
        bool found = false;
        for (unsigned k = 0; k < side->count && !found; k++)
            found = side->face[k] == column.vertex[f];
        column.vertex[f] = found ? column.vertex[f] : side->face[0];
    }
    column.end = e->ends[column.end] ? column.end : e->ends[1];
    return column;
}

/* One step; returns whether the span is complete. */
static bool span_step(struct programs *e)
{
    while (e->next_first < e->first_count && e->rank < e->pair->dim) {
        set_point(e, column_in_face(e, e->first[e->next_first++]), &e->entering);
        extend_span(e);
    }
    if (e->rank < 0) {
        set_point(e, column_in_face(e, (struct support_column){{0, 0}, 0}), &e->entering);
        extend_span(e);
    }
    if (e->rank == e->pair->dim || !set_orthogonal(e))
        return true;
    if (is_constant(e))
        e->attempt++;
    return false;
}

/* Chooses the coordinates of the projection. Returns whether the flat contains the origin; if not,
 * normal[1] separates. */
static bool project(struct programs *e)
{
    mpz_t *x = e->span[0].x, *u = e->edge[0], *n = e->normal[1], *across = e->normal[0];
    int axes = 0, dropped = -1;
    if (e->rank == 0) {
        for (int axis = 0; axis < 3; axis++)
            mpz_neg(n[axis], x[axis]);
        return integer_is_zero(n);
    }
    if (e->rank == 1) {
        for (axes = 0; mpz_sgn(u[axes]) == 0;)
            axes++;
        e->axis[0] = axes;
        integer_cross(across, x, u, e->scratch[0]);
        integer_cross(n, across, u, e->scratch[0]); /* (x . u) u - (u . u) x */
        return integer_is_zero(across);
    }
    mpz_set_ui(e->sum, 0);
    if (e->rank == 2) {
        integer_cross(n, u, e->edge[1], e->scratch[0]);
        for (dropped = 2; mpz_sgn(n[dropped]) == 0;)
            dropped--;
        dot(n, x, 3, e->sum);
    }
    for (int axis = 0; axis < 3; axis++) {
        if (axis != dropped)
            e->axis[axes++] = axis;
        if (mpz_sgn(e->sum) > 0)
            mpz_neg(n[axis], n[axis]);
    }
    return mpz_sgn(e->sum) == 0;
}

/* ---- Programs ---- */

/* out[k] := the minor of two rows in the columns of pair k: (0,1) (0,2) (0,3) (1,2) (1,3) (2,3). */
static const int minor_columns[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

static void set_minors(mpz_t row[ROWS], mpz_t other[ROWS], mpz_t out[6])
{
    for (int k = 0; k < 6; k++) {
        const int i = minor_columns[k][0], j = minor_columns[k][1];
        mpz_mul(out[k], row[i], other[j]);
        mpz_submul(out[k], row[j], other[i]);
    }
}

/* out := the cofactors of a row of a 4 x 4 matrix, times sign; minor: of two others; row: the last
 * one. */
static void expand(mpz_t row[ROWS], mpz_t minor[6], int sign, mpz_t out[ROWS])
{
    /* Without column j, the columns a < b < c are left; the minors of (b,c), (a,c) and (a,b). */
    static const int columns[4][3] = {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};
    static const int minors[4][3] = {{5, 4, 3}, {5, 2, 1}, {4, 2, 0}, {3, 1, 0}};
    for (int j = 0; j < ROWS; j++) {
        mpz_mul(out[j], row[columns[j][0]], minor[minors[j][0]]);
        mpz_submul(out[j], row[columns[j][1]], minor[minors[j][1]]);
        mpz_addmul(out[j], row[columns[j][2]], minor[minors[j][2]]);
        if ((sign < 0) != (j % 2 == 1))
            mpz_neg(out[j], out[j]);
    }
}

/* Sets cofactor and det of the rows, det > 0. */
static void set_cofactors(struct programs *e)
{
    mpz_t(*h)[ROWS] = e->row, (*c)[ROWS] = e->cofactor;
    if (e->rows == 1) {
        mpz_set_ui(c[0][0], 1);
    } else if (e->rows == 2) {
        for (int i = 0; i < 2; i++) {
            mpz_set(c[i][i], h[1 - i][1 - i]);
            mpz_neg(c[i][1 - i], h[1 - i][i]);
        }
    } else if (e->rows == 3) {
        for (int i = 0; i < 3; i++)
            integer_cross(c[i], h[(i + 1) % 3], h[(i + 2) % 3], e->scratch[0]);
    } else {
        set_minors(h[2], h[3], e->minor);
        expand(h[1], e->minor, 1, c[0]);
        expand(h[0], e->minor, -1, c[1]);
        set_minors(h[0], h[1], e->minor);
        expand(h[3], e->minor, 1, c[2]);
        expand(h[2], e->minor, -1, c[3]);
    }
    dot(c[0], h[0], e->rows, e->det);
    if (mpz_sgn(e->det) > 0)
        return;
    mpz_neg(e->det, e->det);
    for (int i = 0; i < e->rows; i++)
        for (int j = 0; j < e->rows; j++)
            mpz_neg(c[i][j], c[i][j]);
}

/* out := the column of a point: relative to the centre, or with a 1. */
static void set_row(const struct programs *e, const struct point *point, mpz_t out[ROWS])
{
    for (int i = 0; i < e->rank; i++) {
        mpz_set(out[i], point->x[e->axis[i]]);
        if (e->stage == SHOOTING)
            mpz_sub(out[i], out[i], e->centre.x[e->axis[i]]);
    }
    if (e->stage == RAISING)
        mpz_set_ui(out[e->rank], 1);
}

/* out := coordinate j of q. */
static void set_goal(const struct programs *e, mpz_t out[ROWS])
{
    for (int i = 0; i < e->rank; i++) {
        if (e->stage == SHOOTING)
            mpz_neg(out[i], e->centre.x[e->axis[i]]);
        else
            mpz_set_ui(out[i], 0);
    }
    if (e->stage == RAISING)
        mpz_set_ui(out[e->rank], 1);
}

/* Compares C_i . q / C_i . s with C_j . q / C_j . s, ties broken by the coordinates of the
 * cofactors. coordinate: C_i . q; enters: C_i . s, both > 0 for i and j. Returns whether i is
 * before j. */
static bool leaves_before(struct programs *e, int i, int j)
{
    int order = integer_compare_products(e->coordinate[i], e->enters[j], e->coordinate[j],
                                         e->enters[i], e->scratch);
    for (int k = 0; order == 0 && k < e->rows; k++)
        order = integer_compare_products(e->cofactor[i][k], e->enters[j], e->cofactor[j][k],
                                         e->enters[i], e->scratch);
    return order < 0;
}

/* Sets the rows and their cofactors, and coordinate. */
static void set_basis(struct programs *e)
{
    mpz_t *goal = e->enters;
    for (int i = 0; i < e->rows; i++)
        set_row(e, &e->basis[i], e->row[i]);
    set_cofactors(e);
    set_goal(e, goal);
    for (int i = 0; i < e->rows; i++)
        dot(e->cofactor[i], goal, e->rows, e->coordinate[i]);
}

/* Replaces a column of the basis by the entering one. */
static void pivot(struct programs *e)
{
    int leaving = -1;
    set_row(e, &e->entering, e->dual); /* dual is not needed any more */
    for (int i = 0; i < e->rows; i++)
        dot(e->cofactor[i], e->dual, e->rows, e->enters[i]);
    for (int i = 0; i < e->rows; i++)
        if (mpz_sgn(e->enters[i]) > 0 && (leaving < 0 || leaves_before(e, i, leaving)))
            leaving = i;
    swap_points(&e->basis[leaving], &e->entering);
    mpz_swap(e->height[leaving], e->best); /* set by raise */
    set_basis(e);
}

/* ---- Shoot ---- */

/* Sets the centre: the mean of the points of the span, with weights in quarters. */
static void set_centre(struct programs *e)
{
    static const int weights[4][4] = {{4, 0, 0, 0}, {2, 2, 0, 0}, {1, 1, 2, 0}, {1, 1, 1, 1}};
    struct point *c = &e->centre;
    c->end = 0;
    for (int axis = 0; axis < 3; axis++) {
        mpz_set_ui(c->x[axis], 0);
        mpz_set_ui(c->a[axis], 0);
    }
    for (int i = 0; i <= e->rank; i++) {
        const int weight = weights[e->rank][i];
        for (int axis = 0; axis < 3; axis++) {
            mpz_addmul_ui(c->x[axis], e->span[i].x[axis], (unsigned long) weight);
            mpz_addmul_ui(c->a[axis], e->span[i].a[axis], (unsigned long) weight);
        }
        c->end += e->span[i].end * weight;
    }
    /* Points are in quarters, and so are weights: exact, all sums of vertices times 4. */
    c->end /= 4;
    for (int axis = 0; axis < 3; axis++) {
        mpz_divexact_ui(c->x[axis], c->x[axis], 4);
        mpz_divexact_ui(c->a[axis], c->a[axis], 4);
    }
}

/* Whether the ray passes through the portal of the basis: no C_i . q < 0, ties broken as in a
 * pivot. */
static bool passes(const struct programs *e)
{
    for (int i = 0; i < e->rows; i++) {
        int sign = mpz_sgn(e->coordinate[i]);
        for (int k = 0; sign == 0 && k < e->rows; k++)
            sign = mpz_sgn(e->cofactor[i][k]);
        if (sign < 0)
            return false;
    }
    return true;
}

static void begin_heights(struct programs *e);

/* Sets the signs of the coordinates of the origin in the simplex of a span of rank 3, which are
 * ratios of determinants of three of its points. Returns whether all are positive. */
static bool set_signs(struct programs *e, int sign[ROWS])
{
    /* Coordinate i is the determinant of point other[i] and the pair without i and other[i]. */
    static const int other[ROWS] = {1, 0, 3, 2};
    int sum = 0, all = 0;
    integer_cross(e->normal[0], e->span[0].x, e->span[1].x, e->scratch[0]);
    integer_cross(e->normal[1], e->span[2].x, e->span[3].x, e->scratch[0]);
    mpz_set_ui(e->best, 0);
    for (int i = 0; i < ROWS; i++) {
        dot(e->normal[i < 2], e->span[other[i]].x, 3, e->sum);
        if (i % 2)
            mpz_neg(e->sum, e->sum);
        mpz_add(e->best, e->best, e->sum);
        sign[i] = mpz_sgn(e->sum);
    }
    all = mpz_sgn(e->best);
    for (int i = 0; i < ROWS; i++) {
        sign[i] *= all;
        sum += sign[i];
    }
    return sum == ROWS;
}

/* The ray leaves the simplex of the span through exactly one facet, the first basis; the coordinate
 * of the origin that is 0 there is not positive. If all are, the origin is inside,
 * and no ray is shot. */
static void begin_shoot(struct programs *e)
{
    int sign[ROWS] = {0};
    e->rows = e->rank;
    if (e->rank == 3 && set_signs(e, sign)) {
        begin_heights(e);
        return;
    }
    e->stage = SHOOTING;
    set_centre(e);
    for (int omitted = 0; omitted <= e->rank; omitted++) {
        if (sign[omitted] > 0)
            continue;
        for (int i = 0; i < e->rank; i++) {
            struct point *of = &e->span[i < omitted ? i : i + 1];
            e->basis[i].column = of->column;
            e->basis[i].end = of->end;
            for (int axis = 0; axis < 3; axis++) {
                mpz_set(e->basis[i].x[axis], of->x[axis]);
                mpz_set(e->basis[i].a[axis], of->a[axis]);
            }
        }
        set_basis(e);
        if (passes(e))
            return;
    }
}

static void finish(struct programs *e, enum fmb_verdict verdict)
{
    e->proof.verdict = verdict;
    e->stage = COMPLETE;
}

/* ---- Proof ---- */

enum { BITS_LEAST = 3 };

/* normal[1] separates. */
static void finish_separated(struct programs *e)
{
    for (int axis = 0; axis < 3; axis++)
        mpz_neg(e->proof.normal[axis], e->normal[1][axis]);
    finish(e, FMB_SEPARATED);
    if (e->proves)
        e->stage = SHORTENING;
    e->attempt = BITS_LEAST;
}

/* Tries the normal of the proof truncated to this many bits. */
static void shorten_step(struct programs *e)
{
    size_t bits = 0;
    for (int axis = 0; axis < 3; axis++)
        if (mpz_sizeinbase(e->proof.normal[axis], 2) > bits)
            bits = mpz_sizeinbase(e->proof.normal[axis], 2);
    if ((size_t) e->attempt >= bits) {
        e->stage = COMPLETE;
        return;
    }
    for (int axis = 0; axis < 3; axis++) {
        mpz_tdiv_q_2exp(e->normal[1][axis], e->proof.normal[axis], bits - (size_t) e->attempt);
        mpz_neg(e->normal[1][axis], e->normal[1][axis]);
    }
    set_point(e, price_difference(e, false), &e->entering);
    dot(e->normal[1], e->entering.x, 3, e->sum);
    e->attempt *= 2;
    if (mpz_sgn(e->sum) >= 0)
        return;
    for (int axis = 0; axis < 3; axis++)
        mpz_neg(e->proof.normal[axis], e->normal[1][axis]);
    e->stage = COMPLETE;
}

/* The basis contains the origin, and the normal leaves out vertices. If a face was taken before, it
 * is that of the normal in proof. */
static void prove_touching(struct programs *e)
{
    struct programs_proof *proof = &e->proof;
    mpz_t *n = e->normal[1];
    dot(n, e->integers.drift, 3, e->sum);
    dot(proof->normal, e->integers.drift, 3, e->best);
    for (int axis = 0; axis < 3 && mpz_sgn(e->sum) * mpz_sgn(e->best) < 0; axis++) {
        mpz_abs(e->scratch[0], e->best);
        mpz_mul(n[axis], n[axis], e->scratch[0]);
        mpz_abs(e->scratch[0], e->sum);
        mpz_addmul(n[axis], proof->normal[axis], e->scratch[0]);
    }
    for (int axis = 0; axis < 3; axis++)
        mpz_neg(proof->normal[axis], n[axis]);
    proof->count = (unsigned) e->rank;
    for (int i = 0; i < e->rank; i++) {
        proof->column[i] = e->basis[i].column;
        mpz_set(proof->weight[i], e->coordinate[i]);
    }
    mpz_set(proof->total, e->det);
}

/* The face of D with N . x = 0, the greatest, becomes D. */
static void reduce(struct programs *e)
{
    const unsigned all = e->side[0].count + e->side[1].count;
    price_difference(e, true);
    e->touching = e->touching || e->side[0].count + e->side[1].count < all;
    if (e->touching && !e->ends_wanted) {
        if (e->proves)
            prove_touching(e);
        finish(e, FMB_TOUCHING);
        return;
    }
    for (int axis = 0; axis < 3 && e->proves; axis++)
        mpz_set(e->proof.normal[axis], e->normal[1][axis]);
    e->reduced = true;
    e->next_first = 0;
    begin_span(e, SPANNING);
}

static void shoot_step(struct programs *e)
{
    /* N = sum C_i, N . H_i = det: the sum of the solution is N . q / det. */
    mpz_set_ui(e->sum, 0);
    for (int i = 0; i < e->rows; i++)
        mpz_add(e->sum, e->sum, e->coordinate[i]);
    const int beyond = mpz_cmp(e->sum, e->det);
    if (beyond < 0) {
        begin_heights(e);
        return;
    }
    for (int axis = 0; axis < 3; axis++)
        mpz_set_ui(e->normal[1][axis], 0);
    for (int j = 0; j < e->rank; j++)
        for (int i = 0; i < e->rows; i++)
            mpz_add(e->normal[1][e->axis[j]], e->normal[1][e->axis[j]], e->cofactor[i][j]);
    set_point(e, price_difference(e, false), &e->entering);
    dot(e->normal[1], e->entering.x, 3, e->sum);
    if (mpz_sgn(e->sum) < 0)
        finish_separated(e);
    else if (mpz_sgn(e->sum) == 0 && beyond == 0)
        reduce(e);
    else
        pivot(e);
}

static void span_done(struct programs *e)
{
    if (!project(e))
        finish_separated(e);
    else if (e->rank == 0)
        begin_heights(e);
    else
        begin_shoot(e);
}

/* The origin is in the cone of the basis and before its plane; or, without a basis, inside the
 * simplex of the span. */
static void prove_overlapping(struct programs *e)
{
    struct programs_proof *proof = &e->proof;
    const int rank = e->rank, shot = e->stage == SHOOTING ? rank : 0;
    const unsigned spans = e->spans[0] > e->spans[1] ? e->spans[0] : e->spans[1];
    mpz_t *others = e->vector, *goal = e->enters; /* others: the sum of the points that span */
    struct support_column *column = proof->column;
    for (int i = 0; i < rank + 1; i++)
        *column++ = e->span[i].column;
    for (int i = 0; i < shot; i++)
        *column++ = e->basis[i].column;
    for (int axis = 0; axis < 3; axis++)
        mpz_set_ui(others[axis], 0);
    for (unsigned i = 0; i < spans; i++) {
        for (int f = 0; f < 2; f++)
            column->vertex[f] = e->spanning[f][i < e->spans[f] ? i : 0];
        column->end = !e->ends[0];
        set_point(e, *column++, &e->entering);
        for (int axis = 0; axis < 3; axis++)
            mpz_add(others[axis], others[axis], e->entering.x[axis]);
    }
    proof->count = (unsigned) (column - proof->column);

    for (int i = 0; i < shot; i++)
        mpz_swap(e->height[i], e->coordinate[i]);
    mpz_swap(e->denominator, e->det);
    e->stage = RAISING;
    e->rows = rank + 1;
    for (int i = 0; i < e->rows; i++)
        set_row(e, &e->span[i], e->row[i]);
    set_cofactors(e);
    int positive = 0;
    for (mp_bitcnt_t bits = 4; positive < e->rows; bits *= 2) {
        mpz_set_ui(proof->total, 1);
        mpz_mul_2exp(proof->total, proof->total, bits);
        mpz_sub_ui(goal[rank], proof->total, spans);
        for (int j = 0; j < rank; j++)
            mpz_neg(goal[j], others[e->axis[j]]);
        for (int i = 0; i < shot; i++) {
            mpz_t *weight = &proof->weight[rank + 1 + i];
            mpz_mul_2exp(e->sum, e->height[i], bits);
            mpz_fdiv_q(*weight, e->sum, e->denominator);
            mpz_sub(goal[rank], goal[rank], *weight);
            for (int j = 0; j < rank; j++)
                mpz_submul(goal[j], *weight, e->basis[i].x[e->axis[j]]);
            mpz_mul(*weight, *weight, e->det);
        }
        positive = 0;
        for (int i = 0; i < e->rows; i++) {
            dot(e->cofactor[i], goal, e->rows, proof->weight[i]);
            positive += mpz_sgn(proof->weight[i]) > 0;
        }
    }
    for (unsigned i = proof->count - spans; i < proof->count; i++)
        mpz_set(proof->weight[i], e->det);
    mpz_mul(proof->total, proof->total, e->det);
}

/* ---- Heights ---- */

enum { TARGET_BOX = 2 };

static int target_axis(const struct programs *e)
{
    return (e->target - TARGET_BOX) / 2;
}

/* The sign of the height: lower ends are maximised negated. */
static int target_sign(const struct programs *e)
{
    return e->target % 2 ? 1 : -1;
}

/* out := the height of a point. */
static void set_height(const struct programs *e, const struct point *point, mpz_t out)
{
    if (e->target < TARGET_BOX)
        mpz_set_si(out, point->end);
    else
        mpz_set(out, point->a[target_axis(e)]);
    if (target_sign(e) < 0)
        mpz_neg(out, out);
}

/* Replaces the basis by a guess in doubles of the optimal one, if its simplex contains the origin.
 * Saves steps, and changes no answer. The points of the span are not needed any more. Returns
 * whether it is replaced. */
static bool guess_basis(struct programs *e)
{
    struct support_column column[ROWS];
    if (e->guesses == GUESS_UNKNOWN)
        e->guesses = !e->reduced && e->rank == e->pair->dim && e->pair->usable &&
                             support_guess_begin(e->pair, &e->guess)
                         ? GUESS_GIVEN
                         : GUESS_NONE;
    if (e->guesses == GUESS_NONE ||
        !support_guess_basis(&e->guess, e->target < TARGET_BOX ? -1 : target_axis(e),
                             target_sign(e), column))
        return false;
    for (int i = 0; i < e->rows; i++) {
        set_point(e, column[i], &e->span[i]);
        swap_points(&e->span[i], &e->basis[i]);
    }
    set_basis(e);
    if (mpz_sgn(e->det) > 0 && passes(e))
        return true;
    for (int i = 0; i < e->rows; i++)
        swap_points(&e->span[i], &e->basis[i]);
    e->basis_set = false;
    return false;
}

static void begin_target(struct programs *e)
{
    if (!guess_basis(e) && !e->basis_set)
        set_basis(e);
    e->basis_set = true;
    for (int i = 0; i < e->rows; i++)
        set_height(e, &e->basis[i], e->height[i]);
}

/* Begins the next target from target on that is wanted. */
static void next_target(struct programs *e)
{
    if (e->target < TARGET_BOX && !(e->want & FMB_WANT_TIMES && e->pair->drifts))
        e->target = TARGET_BOX;
    if (e->target >= TARGET_BOX + (e->want & FMB_WANT_BOX ? 2 * e->pair->dim : 0))
        finish(e, e->touching ? FMB_TOUCHING : FMB_OVERLAPPING);
    else
        begin_target(e);
}

/* Columns: the basis of the last program, and the centre; the span, if there was none. */
static void begin_heights(struct programs *e)
{
    if (e->proves) {
        prove_overlapping(e);
        finish(e, FMB_OVERLAPPING);
        return;
    }
    if (e->stage == SHOOTING)
        swap_points(&e->basis[e->rank], &e->centre);
    for (int i = 0; i <= e->rank && e->stage == SPANNING; i++)
        swap_points(&e->basis[i], &e->span[i]);
    e->stage = RAISING;
    e->target = 0;
    e->rows = e->rank + 1;
    e->basis_set = false;
    next_target(e);
}

/* The optimum is dual[rank] / det, in quarters. */
static void end_target(struct programs *e)
{
    const int end = e->target % 2;
    const enum round_direction direction = end ? ROUND_UP : ROUND_DOWN;
    if (end == 0)
        mpz_neg(e->dual[e->rank], e->dual[e->rank]);
    mpz_mul_2exp(e->denominator, e->det, 2);
    if (e->target < TARGET_BOX) {
        const struct dyadic window = dyadic_of(e->pair->frames->duration);
        mpz_mul_si(e->sum, e->dual[e->rank], window.mantissa);
        e->contact[end] =
            integer_ratio_round(e->sum, e->denominator, window.exponent, direction, e->minor);
    } else {
        mpz_mul(e->denominator, e->denominator, e->integers.scale);
        e->box[end][target_axis(e)] = integer_ratio_round(e->dual[e->rank], e->denominator,
                                                          e->integers.unit, direction, e->minor);
    }
    e->target++;
    next_target(e);
}

/* Maximises. The dual N = sum h_i C_i; a column is better if det h - N . H > 0. */
static void height_step(struct programs *e)
{
    for (int j = 0; j < e->rows; j++) {
        mpz_set_ui(e->dual[j], 0);
        for (int i = 0; i < e->rows; i++)
            mpz_addmul(e->dual[j], e->height[i], e->cofactor[i][j]);
    }
    for (int f = 0; f < 2; f++)
        for (int axis = 0; axis < 3; axis++)
            mpz_set_ui(e->normal[f][axis], 0);
    for (int j = 0; j < e->rank; j++) {
        mpz_neg(e->normal[1][e->axis[j]], e->dual[j]);
        mpz_set(e->normal[0][e->axis[j]], e->dual[j]);
    }
    /* What the end of the window adds, in units of 1 / det. */
    dot(e->normal[1], e->integers.drift, 3, e->sum);
    mpz_set(e->scratch[0], e->det);
    if (target_sign(e) < 0)
        mpz_neg(e->scratch[0], e->scratch[0]);
    if (e->target < TARGET_BOX) {
        mpz_add(e->sum, e->sum, e->scratch[0]);
    } else {
        const int axis = target_axis(e);
        mpz_addmul(e->sum, e->scratch[0], e->integers.side[0].displacement[axis]);
        mpz_add(e->normal[0][axis], e->normal[0][axis], e->scratch[0]);
    }
    set_point(e, price(e, mpz_sgn(e->sum), false), &e->entering);
    set_row(e, &e->entering, e->enters);
    dot(e->dual, e->enters, e->rows, e->sum);
    set_height(e, &e->entering, e->best);
    mpz_mul(e->scratch[0], e->best, e->det);
    if (mpz_cmp(e->scratch[0], e->sum) > 0)
        pivot(e);
    else
        end_target(e);
}

/* ---- Nearest point ----
 *
 * The point of D nearest to the origin is sum w_i x_i / total, with the weights of
 * integer_simplex.h, whose corners are points of D, not multiplied by QUARTERS. */

static void set_corner(struct programs *e, struct support_column column, struct integer_corner *out)
{
    out->column = column;
    set_difference(e, column, out->at);
}

static void nearest_corner(void *context, mpz_t n[3], struct integer_corner *out)
{
    struct programs *e = context;
    for (int axis = 0; axis < 3; axis++)
        mpz_neg(e->normal[1][axis], n[axis]);
    set_corner(e, price_difference(e, false), out);
}

/* Sets the proof from the nearest point, and the verdict from its distance and the sum of the
 * radii. */
static void prove_by_nearest(struct programs *e)
{
    struct programs_proof *proof = &e->proof;
    const struct integer_simplex *simplex = &e->simplex;
    proof->count = (unsigned) simplex->count;
    mpz_set(proof->total, simplex->total);
    for (int i = 0; i < simplex->count; i++) {
        proof->column[i] = simplex->corner[i]->column;
        mpz_set(proof->weight[i], simplex->weight[i]);
    }
    for (int axis = 0; axis < 3; axis++) {
        mpz_set(proof->normal[axis], simplex->normal[axis]);
        mpz_set_ui(e->vector[axis], 0);
        for (int i = 0; i < simplex->count; i++)
            mpz_addmul(e->vector[axis], simplex->weight[i], simplex->corner[i]->at[axis]);
    }
    dot(e->vector, e->vector, 3, e->best);
    mpz_mul(e->sum, e->integers.radius, simplex->total);
    mpz_mul(e->sum, e->sum, e->sum);
    const int order = mpz_cmp(e->best, e->sum);
    proof->verdict = order > 0 ? FMB_SEPARATED : order == 0 ? FMB_TOUCHING : FMB_OVERLAPPING;
}

void programs_nearest_time(struct programs *e, double time[2])
{
    const struct dyadic window = dyadic_of(e->pair->frames->duration);
    mpz_set_ui(e->best, 0);
    for (int i = 0; i < e->simplex.count; i++)
        if (e->simplex.corner[i]->column.end)
            mpz_add(e->best, e->best, e->simplex.weight[i]);
    mpz_mul_si(e->best, e->best, window.mantissa);
    for (int end = 0; end < 2; end++)
        time[end] = integer_ratio_round(e->best, e->simplex.total, window.exponent,
                                        end ? ROUND_UP : ROUND_DOWN, e->minor);
}

/* The point is a + (b - a) r_A / R, for the points a of A and b of B that the weights give, with R
 * the sum of the radii r_A and r_B. If R is 0, so is b - a. */
void programs_nearest_point(struct programs *e, double point[1 + FMB_DIM_MAX])
{
    const struct integer_simplex *simplex = &e->simplex;
    const struct frame_pair *frames = e->pair->frames;
    mpz_t *radius = e->dual;
    double time[2];
    programs_nearest_time(e, time);
    point[0] = time[0];
    integer_set(radius[0], dyadic_of(frames->a.frame->radius), e->integers.unit);
    integer_set_sum(radius[1], frames->a.frame->radius, frames->b.frame->radius, e->integers.unit);
    if (mpz_sgn(radius[1]) == 0)
        mpz_set_ui(radius[1], 1);
    mpz_mul(e->denominator, simplex->total, radius[1]);
    mpz_mul(e->denominator, e->denominator, e->integers.scale);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        mpz_set_ui(e->sum, 0);
        mpz_set_ui(e->best, 0);
        for (int i = 0; i < simplex->count; i++) {
            const struct integer_corner *corner = simplex->corner[i];
            mpz_set(e->scratch[0], place(e, 0, corner->column.vertex[0])[axis]);
            if (corner->column.end)
                mpz_add(e->scratch[0], e->scratch[0], e->integers.side[0].displacement[axis]);
            mpz_addmul(e->sum, simplex->weight[i], e->scratch[0]);
            mpz_addmul(e->best, simplex->weight[i], corner->at[axis]);
        }
        mpz_mul(e->sum, e->sum, radius[1]);
        mpz_addmul(e->sum, e->best, radius[0]);
        point[1 + axis] =
            integer_ratio_round(e->sum, e->denominator, e->integers.unit, ROUND_DOWN, e->minor);
    }
}

/* ---- Begin and end ---- */

static void set_all_vertices(struct programs *e)
{
    for (int f = 0; f < 2; f++) {
        e->side[f].count = e->pair->view[f].vertices.count;
        for (unsigned i = 0; i < e->side[f].count; i++)
            e->side[f].face[i] = (uint16_t) i;
    }
}

/* Begins the span of a frame: that of D if the other frame is one of its points, without drift. */
static void begin_span_of(struct programs *e, int f)
{
    e->side[!f].count = 1;
    e->next_first = 0;
    begin_span(e, f ? SPANNING_B : SPANNING_A);
}

static void begin_difference(struct programs *e)
{
    e->ends[1] = !e->pair->posed && pair_moves(e->pair->frames) && e->pair->frames->duration > 0;
    e->next_first = 0;
    begin_span(e, SPANNING);
}

static struct programs *begin(const struct support_pair *pair, bool nearest)
{
    struct programs *e = memory_allocate(sizeof *e);
    memset(e, 0, sizeof *e);
    e->simplex_set = nearest;
    each(e, mpz_init);
    e->pair = pair;
    e->proof.integers = &e->integers;
    support_integers_set(pair->frames, pair->posed, pair->at, &e->integers);
    set_all_vertices(e);
    return e;
}

struct programs *programs_begin_nearest(const struct support_pair *pair, bool late,
                                        const struct support_column *first, unsigned count)
{
    struct programs *e = begin(pair, true);
    double toward[FMB_DIM_MAX];
    int exponent;
    e->ends[0] = !late;
    e->ends[1] = late || (pair->drifts && pair->frames->duration > 0);
    e->stage = NEARING;
    if (count > 0) {
        for (unsigned i = 0; i < count; i++)
            set_corner(e, first[i], &e->simplex.pool[i]);
        integer_simplex_begin_near(&e->simplex, (int) count);
        return e;
    }
    support_toward(pair, toward);
    frexp(vec3_largest(toward), &exponent);
    for (int axis = 0; axis < 3; axis++)
        mpz_set_d(e->vector[axis], ldexp(toward[axis], 53 - exponent));
    integer_simplex_begin(&e->simplex, e->vector, nearest_corner, e);
    return e;
}

struct programs *programs_begin(const struct support_pair *pair, unsigned want,
                                const struct support_column *first, unsigned count)
{
    struct programs *e = begin(pair, false);
    e->want = want & (FMB_WANT_BOX | FMB_WANT_TIMES);
    e->ends_wanted = want & FMB_WANT_BOX || (want & FMB_WANT_TIMES && pair->drifts);
    e->proves = want & FMB_WANT_CERTIFICATE;
    for (unsigned i = 0; i < count; i++)
        e->first[i] = first[i];
    e->first_count = count;
    e->contact[1] = pair->frames->duration + 0.0; /* never -0 */
    e->ends[0] = true;
    if (e->proves)
        begin_span_of(e, 0);
    else
        begin_difference(e);
    return e;
}

/* Takes the vertices that span a frame. */
static void span_of_frame_done(struct programs *e, int f)
{
    e->spans[f] = (unsigned) e->rank + 1;
    for (int i = 0; i <= e->rank; i++)
        e->spanning[f][i] = e->span[i].column.vertex[f];
    set_all_vertices(e);
    if (f == 0)
        begin_span_of(e, 1);
    else
        begin_difference(e);
}

bool programs_step(struct programs *e)
{
    switch (e->stage) {
    case SPANNING_A:
    case SPANNING_B:
        if (span_step(e))
            span_of_frame_done(e, e->stage == SPANNING_B);
        break;
    case SPANNING:
        if (span_step(e))
            span_done(e);
        break;
    case SHOOTING: shoot_step(e); break;
    case RAISING: height_step(e); break;
    case SHORTENING: shorten_step(e); break;
    case NEARING:
        if (integer_simplex_step(&e->simplex, nearest_corner, e)) {
            prove_by_nearest(e);
            e->stage = COMPLETE;
        }
        break;
    case COMPLETE: break;
    }
    return e->stage == COMPLETE;
}

struct programs_proof *programs_proof(struct programs *e)
{
    return &e->proof;
}

void programs_end(struct programs *e, struct fmb_answer *answer)
{
    if (answer) {
        const unsigned given = e->proof.verdict != FMB_SEPARATED ? e->want : 0;
        answer->verdict = e->proof.verdict;
        if (given & FMB_WANT_TIMES) {
            answer->has_contact = true;
            memcpy(answer->contact, e->contact, sizeof e->contact);
        }
        if (given & FMB_WANT_BOX) {
            answer->has_box = true;
            memcpy(answer->box, e->box, sizeof e->box);
        }
    }
    each(e, mpz_clear);
    memory_release(e, sizeof *e);
}
