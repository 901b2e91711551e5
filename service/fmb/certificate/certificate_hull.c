/* Finds certificates of pairs with a hull, without their verdict.
 *
 * With M = { b - a } and D = M + [0, 1] w, w the drift over the window, all in integers:
 *
 * 1. The point of D next to the origin (gap_exact_simplex.h). If it is not 0, it is a normal N with
 *    N . d >= N . N > 0 for all d of D: SEPARATED.
 * 2. Else 0 is a combination of vertices of D, and the frames meet at a time t. Let m be the mean
 * of M by vertices that span both affine hulls, so that it is in ri M, and c = m + s w for some
 * time s of the window. For epsilon = 1/4, 1/16, 1/256, ... find the point of D + epsilon c next to
 *    the origin.
 *    If it is 0, then 0 = d + epsilon c for a d of D. Divided by 1 + epsilon this is a combination
 *    of vertices with positive weights for those that span: OVERLAPPING, whatever s is.
 *    Else it is a normal N. If N . d >= 0 for all d of D, and N is not constant on one of the
 *    frames: TOUCHING.
 *
 * This ends if s = t. Then 0 = m' + t w for an m' of M, and c = m - m' is a direction of aff M. If
 * the frames overlap, 0 is in ri M + t* w for some t*, so -epsilon c is in M + t* w, part of D, if
 * epsilon is small enough. If they touch, -epsilon c is never in D: 0 = d + epsilon c would, by the
 * argument above, be in ri M at some time. Near 0, D is a cone K with its tip there; if epsilon is
 * small enough, the point of D next to -epsilon c is that of K, and N, from -epsilon c to there,
 * has N . k >= 0 for all k of K (Moreau's decomposition). And N is not constant on M: d = 0 and D's
 * other points have N . (d + epsilon c) >= N . N > 0, so N . c > 0; but if N were the same on all
 * of M, then N . c = N . (m - m') = 0.
 *
 * For shorter numbers, s = 1/2 is tried first, and normals of few bits for separated frames.
 *
 * Cost: each search takes some ten scans of the vertices in doubles, with a bound, and of those
 * that may be the farthest in integers. */
#include "certificate_hull.h"

#include "gap_exact_simplex.h"
#include "hull_vertices.h"
#include "integer.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SPANNING_MAX = FMB_DIM_MAX + 1, WEIGHTS_MAX = EXACT_CORNERS + SPANNING_MAX };

struct hull_search {
    const struct frame_pair *frames;
    int dim;
    struct hull_integers integers;
    unsigned count[2];
    mpz_t (*vertex[2])[3];             /* [frame][vertex][axis] */
    double (*rounded[2])[FMB_DIM_MAX]; /* the same in doubles */
    double error;                      /* of n . v in doubles, n of unit length */
    unsigned spanning[2][SPANNING_MAX], spans[2];
    mpz_t factor, shift[3]; /* of the polytope that is searched: factor D + shift */
    mpz_t normal[3], t[4];
    struct exact_simplex simplex;
};

static void search_each(struct hull_search *search, void (*call)(mpz_ptr))
{
    exact_simplex_each(&search->simplex, call);
    for (int axis = 0; axis < 3; axis++) {
        call(search->shift[axis]);
        call(search->normal[axis]);
    }
    for (int i = 0; i < 4; i++)
        call(search->t[i]);
    hull_integers_each(&search->integers, call);
    call(search->factor);
}

/* ---- Vertices ---- */

static bool is_wide(mpz_t v[3])
{
    return mpz_sizeinbase(v[0], 2) > CERTIFICATE_SPAN_MAX ||
           mpz_sizeinbase(v[1], 2) > CERTIFICATE_SPAN_MAX ||
           mpz_sizeinbase(v[2], 2) > CERTIFICATE_SPAN_MAX;
}

static bool search_is_wide(struct hull_search *search)
{
    for (int f = 0; f < 2; f++) {
        if (is_wide(search->integers.side[f].displacement))
            return true;
        for (unsigned k = 0; k < search->count[f]; k++)
            if (is_wide(search->vertex[f][k]))
                return true;
    }
    return false;
}

/* With u = 2^-53, and M the largest coordinate: a vertex is cut off, by 2 u of its length, the
 * direction is off by 6 u, and n . v is rounded three times: less than 12 u sqrt(3) M < 2^-48 M. */
static void round_vertices(struct hull_search *search)
{
    double largest = 0;
    for (int f = 0; f < 2; f++)
        for (unsigned k = 0; k < search->count[f]; k++)
            for (int axis = 0; axis < 3; axis++) {
                search->rounded[f][k][axis] = mpz_get_d(search->vertex[f][k][axis]);
                largest = fmax(largest, fabs(search->rounded[f][k][axis]));
            }
    search->error = 0x1p-48 * largest;
}

/* Returns the vertex of frame f with the least sign n . v, the first of several. out := its n . v.
 */
static unsigned least_vertex(struct hull_search *search, int f, int sign, mpz_t n[3], mpz_t out)
{
    double direction[FMB_DIM_MAX], least = INFINITY;
    unsigned best = search->count[f];
    exact_direction(n, direction);
    for (int pass = 0; pass < 2; pass++)
        for (unsigned k = 0; k < search->count[f]; k++) {
            const double *v = search->rounded[f][k];
            const double value =
                sign * ((direction[0] * v[0] + direction[1] * v[1]) + direction[2] * v[2]);
            if (pass == 0 && value < least)
                least = value;
            if (pass == 0 || value > least + 2 * search->error)
                continue;
            integer_dot(search->t[1], n, search->vertex[f][k], search->t[0]);
            if (best == search->count[f] || sign * mpz_cmp(search->t[1], out) < 0) {
                mpz_set(out, search->t[1]);
                best = k;
            }
        }
    return best;
}

/* The support function of factor D + shift. */
static void set_support(void *context, mpz_t n[3], struct exact_corner *out)
{
    struct hull_search *search = context;
    out->bits[0] = least_vertex(search, 0, -1, n, search->t[2]);
    out->bits[1] = least_vertex(search, 1, 1, n, search->t[2]);
    integer_dot(search->t[1], n, search->integers.drift, search->t[0]);
    out->late = mpz_sgn(search->t[1]) < 0;
    for (int axis = 0; axis < 3; axis++) {
        mpz_sub(search->t[0], search->vertex[1][out->bits[1]][axis],
                search->vertex[0][out->bits[0]][axis]);
        if (out->late)
            mpz_add(search->t[0], search->t[0], search->integers.drift[axis]);
        mpz_mul(out->at[axis], search->t[0], search->factor);
        mpz_add(out->at[axis], out->at[axis], search->shift[axis]);
    }
}

/* Finds the point of factor D + shift next to the origin. Returns whether it is the origin. */
static bool solve(struct hull_search *search)
{
    mpz_t toward[3]; /* any direction */
    mpz_init_set_ui(toward[0], 1);
    mpz_inits(toward[1], toward[2], NULL);
    exact_simplex_solve(&search->simplex, toward, set_support, search);
    mpz_clears(toward[0], toward[1], toward[2], NULL);
    return search->simplex.zero;
}

/* Whether the vertices of frame f have the same n . v. */
static bool is_constant(struct hull_search *search, int f, mpz_t n[3])
{
    least_vertex(search, f, 1, n, search->t[2]);
    least_vertex(search, f, -1, n, search->t[3]);
    return mpz_cmp(search->t[2], search->t[3]) == 0;
}

/* Returns the sign of the least n . d over D. In: n is not 0. */
static int least_sign(struct hull_search *search, mpz_t n[3])
{
    least_vertex(search, 1, 1, n, search->t[2]);
    least_vertex(search, 0, -1, n, search->t[3]);
    mpz_sub(search->t[2], search->t[2], search->t[3]);
    integer_dot(search->t[3], n, search->integers.drift, search->t[0]);
    if (mpz_sgn(search->t[3]) < 0)
        mpz_add(search->t[2], search->t[2], search->t[3]);
    return mpz_sgn(search->t[2]);
}

/* ---- Vertices that span ---- */

/* Chooses affinely independent vertices, each the first that is independent of those before it. */
static void choose_spanning(struct hull_search *search, int f)
{
    mpz_t *origin = search->vertex[f][0], *n = search->normal;
    mpz_t first[3], d[3];
    mpz_inits(first[0], first[1], first[2], d[0], d[1], d[2], NULL);
    search->spanning[f][0] = 0;
    search->spans[f] = 1;
    for (unsigned k = 1; k < search->count[f] && search->spans[f] < SPANNING_MAX; k++) {
        for (int axis = 0; axis < 3; axis++)
            mpz_sub(d[axis], search->vertex[f][k][axis], origin[axis]);
        bool independent = !integer_is_zero(d);
        if (search->spans[f] == 1 && independent) {
            for (int axis = 0; axis < 3; axis++)
                mpz_set(first[axis], d[axis]);
        } else if (search->spans[f] == 2) {
            integer_cross(n, first, d, search->t[0]);
            independent = !integer_is_zero(n);
        } else if (search->spans[f] == 3) {
            integer_dot(search->t[1], n, d, search->t[0]);
            independent = mpz_sgn(search->t[1]) != 0;
        }
        if (independent)
            search->spanning[f][search->spans[f]++] = k;
    }
    mpz_clears(first[0], first[1], first[2], d[0], d[1], d[2], NULL);
}

/* factor := K 2^e, shift := K c, with c = m + s w, s = num / den, and K the common denominator. */
static void set_shift(struct hull_search *search, const mpz_t num, const mpz_t den, unsigned e)
{
    const unsigned product = search->spans[0] * search->spans[1];
    for (int axis = 0; axis < 3; axis++) {
        mpz_set_ui(search->shift[axis], 0);
        for (int f = 0; f < 2; f++)
            for (unsigned k = 0; k < search->spans[f]; k++) {
                mpz_srcptr x = search->vertex[f][search->spanning[f][k]][axis];
                if (f == 0)
                    mpz_submul_ui(search->shift[axis], x, search->spans[1]);
                else
                    mpz_addmul_ui(search->shift[axis], x, search->spans[0]);
            }
        mpz_mul(search->shift[axis], search->shift[axis], den);
        mpz_mul_ui(search->t[0], num, product);
        mpz_addmul(search->shift[axis], search->t[0], search->integers.drift[axis]);
    }
    mpz_mul_ui(search->factor, den, product);
    mpz_mul_2exp(search->factor, search->factor, e);
}

/* ---- Text ---- */

static void write_normal(struct certificate_writer *writer, struct hull_search *search, mpz_t n[3])
{
    mpq_t number;
    mpq_init(number);
    mpz_gcd(search->t[0], n[0], n[1]);
    mpz_gcd(search->t[0], search->t[0], n[2]);
    certificate_write_text(writer, " normal");
    for (int axis = 0; axis < search->dim; axis++) {
        mpz_divexact(mpq_numref(number), n[axis], search->t[0]);
        certificate_write_text(writer, axis == 0 ? " (" : " ");
        certificate_write_number(writer, number);
    }
    certificate_write_text(writer, ")");
    mpq_clear(number);
}

/* A combination of vertices of both frames at one time. */
struct combination {
    mpq_t late; /* the time, in windows */
    unsigned count[2], vertex[2][WEIGHTS_MAX];
    mpq_t weight[2][WEIGHTS_MAX];
};

static void combination_each(struct combination *all, void (*call)(mpq_ptr))
{
    call(all->late);
    for (int i = 0; i < WEIGHTS_MAX; i++) {
        call(all->weight[0][i]);
        call(all->weight[1][i]);
    }
}

/* Adds a weight, in the order of the vertices. */
static void add_weight(struct combination *all, int f, unsigned vertex, const mpq_t weight)
{
    unsigned i = all->count[f]++;
    for (; i > 0 && all->vertex[f][i - 1] > vertex; i--) {
        all->vertex[f][i] = all->vertex[f][i - 1];
        mpq_swap(all->weight[f][i], all->weight[f][i - 1]);
    }
    all->vertex[f][i] = vertex;
    mpq_set(all->weight[f][i], weight);
    if (i == 0 || all->vertex[f][i - 1] != vertex)
        return;
    mpq_add(all->weight[f][i - 1], all->weight[f][i - 1], weight);
    all->count[f]--;
    for (; i < all->count[f]; i++) {
        all->vertex[f][i] = all->vertex[f][i + 1];
        mpq_swap(all->weight[f][i], all->weight[f][i + 1]);
    }
}

/* The weights of the simplex, divided by 1 + epsilon; epsilon = 0 without e. */
static void add_simplex(const struct hull_search *search, unsigned e, struct combination *out)
{
    const struct exact_simplex *simplex = &search->simplex;
    mpq_t weight;
    mpq_init(weight);
    for (int c = 0; c < simplex->count; c++) {
        const struct exact_corner *corner = simplex->corner[c];
        mpz_set(mpq_numref(weight), simplex->weight[c]);
        mpz_set(mpq_denref(weight), simplex->total);
        if (e > 0) { /* 1 / (1 + 2^-e) = 2^e / (2^e + 1) */
            mpz_mul_2exp(mpq_numref(weight), mpq_numref(weight), e);
            mpz_mul_2exp(mpq_denref(weight), mpq_denref(weight), e);
            mpz_add(mpq_denref(weight), mpq_denref(weight), simplex->total);
        }
        mpq_canonicalize(weight);
        for (int f = 0; f < 2; f++)
            add_weight(out, f, corner->bits[f], weight);
        if (corner->late)
            mpq_add(out->late, out->late, weight);
    }
    mpq_clear(weight);
}

/* The weights of epsilon c, divided by 1 + epsilon: 1 / (2^e + 1) in all. */
static void add_spanning(const struct hull_search *search, const mpz_t num, const mpz_t den,
                         unsigned e, struct combination *out)
{
    mpq_t weight;
    mpq_init(weight);
    for (int f = 0; f < 2; f++)
        for (unsigned k = 0; k < search->spans[f]; k++) {
            mpz_set_ui(mpq_denref(weight), 1);
            mpz_mul_2exp(mpq_denref(weight), mpq_denref(weight), e);
            mpz_add_ui(mpq_denref(weight), mpq_denref(weight), 1);
            mpz_mul_ui(mpq_denref(weight), mpq_denref(weight), search->spans[f]);
            mpz_set_ui(mpq_numref(weight), 1);
            add_weight(out, f, search->spanning[f][k], weight);
        }
    mpz_set_ui(mpq_denref(weight), 1);
    mpz_mul_2exp(mpq_denref(weight), mpq_denref(weight), e);
    mpz_add_ui(mpq_denref(weight), mpq_denref(weight), 1);
    mpz_mul(mpq_denref(weight), mpq_denref(weight), den);
    mpz_set(mpq_numref(weight), num);
    mpq_canonicalize(weight);
    mpq_add(out->late, out->late, weight);
    mpq_clear(weight);
}

/* x := x 2^unit / scale */
static void to_length(const struct hull_search *search, mpq_t x)
{
    mpz_mul(mpq_denref(x), mpq_denref(x), search->integers.scale);
    mpq_canonicalize(x);
    if (search->integers.unit < 0)
        mpq_div_2exp(x, x, (mp_bitcnt_t) -search->integers.unit);
    else
        mpq_mul_2exp(x, x, (mp_bitcnt_t) search->integers.unit);
}

/* The coordinate of the point: that of the first frame. */
static void set_coordinate(const struct hull_search *search, struct combination *all, int axis,
                           mpq_t out)
{
    mpq_t x;
    mpq_init(x);
    mpq_set_z(out, search->integers.side[0].displacement[axis]);
    mpq_mul(out, out, all->late);
    for (unsigned i = 0; i < all->count[0]; i++) {
        mpq_set_z(x, search->vertex[0][all->vertex[0][i]][axis]);
        mpq_mul(x, x, all->weight[0][i]);
        mpq_add(out, out, x);
    }
    to_length(search, out);
    mpq_clear(x);
}

static void write_point(struct certificate_writer *writer, const struct hull_search *search,
                        struct combination *all)
{
    mpq_t x;
    char text[16];
    mpq_init(x);
    mpq_set_d(x, search->frames->duration);
    mpq_mul(x, x, all->late);
    certificate_write_text(writer, " at ");
    certificate_write_number(writer, x);
    for (int axis = 0; axis < search->dim; axis++) {
        set_coordinate(search, all, axis, x);
        certificate_write_text(writer, axis == 0 ? " (" : " ");
        certificate_write_number(writer, x);
    }
    certificate_write_text(writer, ")");
    for (int f = 0; f < 2; f++) {
        certificate_write_text(writer, f ? " b" : " a");
        for (unsigned i = 0; i < all->count[f]; i++) {
            snprintf(text, sizeof text, " %u:", all->vertex[f][i]);
            certificate_write_text(writer, text);
            certificate_write_number(writer, all->weight[f][i]);
        }
    }
    mpq_clear(x);
}

/* ---- The search ---- */

/* A normal of few bits where one proves that the frames are separated. */
static void write_separated(struct certificate_writer *writer, struct hull_search *search)
{
    double direction[FMB_DIM_MAX];
    mpz_t *n = search->normal;
    exact_direction(search->simplex.normal, direction);
    certificate_write_text(writer, "separated");
    for (int bits = 6; bits <= 60; bits *= 2) {
        for (int axis = 0; axis < 3; axis++)
            mpz_set_d(n[axis], ldexp(direction[axis], bits));
        if (!integer_is_zero(n) && least_sign(search, n) > 0) {
            write_normal(writer, search, n);
            return;
        }
    }
    write_normal(writer, search, search->simplex.normal);
}

/* Finds the certificate of frames that meet with s = num / den. Returns false if none is found with
 * an epsilon of at least 2^-last. touch: the combination of a common point. */
static bool try_time(struct certificate_writer *writer, struct hull_search *search,
                     struct combination *touch, const mpz_t num, const mpz_t den, unsigned last)
{
    for (unsigned e = 2; e <= last; e *= 2) {
        set_shift(search, num, den, e);
        if (solve(search)) {
            struct combination overlap = {.count = {0, 0}};
            combination_each(&overlap, mpq_init);
            add_simplex(search, e, &overlap);
            add_spanning(search, num, den, e, &overlap);
            certificate_write_text(writer, "overlapping");
            write_point(writer, search, &overlap);
            combination_each(&overlap, mpq_clear);
            return true;
        }
        mpz_t *n = search->simplex.normal;
        if (least_sign(search, n) >= 0 &&
            !(is_constant(search, 0, n) && is_constant(search, 1, n))) {
            certificate_write_text(writer, "touching");
            write_normal(writer, search, n);
            write_point(writer, search, touch);
            return true;
        }
    }
    return false;
}

/* The smallest epsilon that is tried with s = 1/2. With s = t some epsilon will do; each is a
 * quotient of determinants, of at most 5 numbers of CERTIFICATE_SPAN_MAX + 3 bits. */
enum { HALF_LAST = 64, LAST = 1 << 14 };

static void find(struct certificate_writer *writer, struct hull_search *search)
{
    mpz_set_ui(search->factor, 1);
    if (!solve(search)) {
        write_separated(writer, search);
        return;
    }
    struct combination touch = {.count = {0, 0}};
    mpz_t num, den;
    combination_each(&touch, mpq_init);
    mpz_inits(num, den, NULL);
    add_simplex(search, 0, &touch);
    choose_spanning(search, 0);
    choose_spanning(search, 1);
    const bool drifts = !integer_is_zero(search->integers.drift);
    mpz_set_ui(num, drifts);
    mpz_set_ui(den, 2);
    bool found = try_time(writer, search, &touch, num, den, drifts ? HALF_LAST : LAST);
    if (!found)
        found =
            try_time(writer, search, &touch, mpq_numref(touch.late), mpq_denref(touch.late), LAST);
    assert(found);
    (void) found;
    mpz_clears(num, den, NULL);
    combination_each(&touch, mpq_clear);
}

/* ---- Memory ---- */

static void *allocated(size_t bytes)
{
    void *(*allocate)(size_t);
    mp_get_memory_functions(&allocate, NULL, NULL);
    return allocate(bytes);
}

static void vertices_begin(struct hull_search *search)
{
    for (int f = 0; f < 2; f++) {
        const size_t count = search->count[f];
        search->vertex[f] = allocated(count * sizeof *search->vertex[f]);
        search->rounded[f] = allocated(count * sizeof *search->rounded[f]);
        for (size_t k = 0; k < count; k++)
            for (int axis = 0; axis < 3; axis++)
                mpz_init(search->vertex[f][k][axis]);
    }
}

static void vertices_end(struct hull_search *search)
{
    void (*release)(void *, size_t);
    mp_get_memory_functions(NULL, NULL, &release);
    for (int f = 0; f < 2; f++) {
        const size_t count = search->count[f];
        for (size_t k = 0; k < count; k++)
            for (int axis = 0; axis < 3; axis++)
                mpz_clear(search->vertex[f][k][axis]);
        release(search->vertex[f], count * sizeof *search->vertex[f]);
        release(search->rounded[f], count * sizeof *search->rounded[f]);
    }
}

void certificate_hull_write(struct certificate_writer *writer, const struct frame_pair *pair)
{
    struct hull_search search = {.frames = pair, .dim = pair->a.frame->dim};
    search_each(&search, mpz_init);
    search.count[0] = hull_vertex_count(pair->a.frame);
    search.count[1] = hull_vertex_count(pair->b.frame);
    vertices_begin(&search);
    hull_integers_set(pair, &search.integers);
    for (int f = 0; f < 2; f++)
        for (unsigned k = 0; k < search.count[f]; k++)
            hull_integers_place(&search.integers, f, k, search.vertex[f][k]);
    if (!search_is_wide(&search)) {
        round_vertices(&search);
        find(writer, &search);
    }
    vertices_end(&search);
    search_each(&search, mpz_clear);
}
