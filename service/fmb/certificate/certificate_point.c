/* A point for the certificate of two frames that meet: exact, and short to write.
 *
 * In space and time (t, p) the intersection over the window is a polytope Q (exact_box.c). If the
 * frames touch, any of its points will do. If they overlap, any point of its relative interior
 * will: by Rockafellar, Convex Analysis, section 6,
 *
 *   if the relative interiors meet at some time inside the window, then ri Q is the set where they
 *   meet at times inside it (theorem 6.5, applied to the sets that the frames fill in space and
 *   time, and to the window);
 *   otherwise they meet only at an end of the window, and then all of Q lies there: a segment from
 *   a point where they meet to a point of Q at another time would pass through relative interiors
 *   inside the window (theorem 6.1). So ri Q is where they meet, by theorem 6.5 at that time.
 *
 * Method: a largest set of affinely independent points of Q spans a simplex in Q that is open in
 * the affine hull of Q, so its mean is in ri Q. From there the point is moved inside ri Q along one
 * line after the other, each time to where one coordinate is the simplest number: one coordinate
 * for each dimension of Q, the time first. If Q is flat, the other coordinates follow from these.
 */
#include "certificate_writer.h"

#include "integer.h"

#include <assert.h>

/* [0] the time in seconds, [1] to [3] the place in the world. */
enum { COORDINATES = EXACT_COORDINATES };

/* Calls mpq_init or mpq_clear for every number of a struct from the member `first` to its end,
 * where it holds nothing but rational numbers and arrays of them. */
#define RATIONAL_EACH_FROM(first, object, call) \
    rational_each(&(object)->first, sizeof *(object) -offsetof(__typeof__(*(object)), first), call)

static void rational_each(void *numbers, size_t bytes, void (*call)(mpq_ptr))
{
    mpq_ptr number = numbers;
    for (size_t i = 0; i < bytes / sizeof *number; i++)
        call(&number[i]);
}

/* ---- The simplest number ---- */

/* out := the simplest number strictly between a / b >= 0 and c / d > a / b, which is infinite if d
 * = 0: the number of least denominator, and among these the least. The limits are overwritten.
 *
 * Method: with q = floor(a / b), it is q + 1 if that is less than c / d. Otherwise both limits are
 * q + 1 / y, for y from d / (c - q d) to b / (a - q b), and it is q + 1 / y for the simplest y
 * between these. It is thus computed as a continued fraction; num / den is the value so far and
 * last_num / last_den the previous one. */
static void simplest_of_positive(mpq_t out, mpz_t a, mpz_t b, mpz_t c, mpz_t d)
{
    mpz_t term, last_num, last_den;
    mpz_inits(term, last_num, last_den, NULL);
    mpq_set_ui(out, 1, 0);
    mpz_set_ui(last_den, 1);
    for (bool whole = false; !whole;) {
        mpz_fdiv_q(term, a, b);
        mpz_submul(a, term, b);
        mpz_submul(c, term, d);
        whole = mpz_cmp(d, c) < 0; /* term + 1 < c / d */
        mpz_add_ui(term, term, whole);
        mpz_addmul(last_num, term, mpq_numref(out));
        mpz_addmul(last_den, term, mpq_denref(out));
        mpz_swap(last_num, mpq_numref(out));
        mpz_swap(last_den, mpq_denref(out));
        mpz_swap(a, d);
        mpz_swap(b, c);
    }
    mpz_clears(term, last_num, last_den, NULL);
}

/* out := the simplest number strictly between low and high > low: 0 if it is one; otherwise one of
 * the least denominator, and among these the closest to 0. low and high need not be in lowest
 * terms; they are overwritten. */
static void simplest_between(mpq_t out, mpq_t low, mpq_t high)
{
    bool negative = mpq_sgn(high) <= 0;
    if (mpq_sgn(low) < 0 && mpq_sgn(high) > 0) {
        mpq_set_ui(out, 0, 1);
        return;
    }
    if (negative) {
        mpq_swap(low, high);
        mpq_neg(low, low);
        mpq_neg(high, high);
    }
    simplest_of_positive(out, mpq_numref(low), mpq_denref(low), mpq_numref(high), mpq_denref(high));
    if (negative)
        mpq_neg(out, out);
}

/* ---- Scaling ---- */

/* x := x 2^exponent. */
static void scale(mpq_t x, long exponent)
{
    if (exponent < 0)
        mpq_div_2exp(x, x, (mp_bitcnt_t) -exponent);
    else
        mpq_mul_2exp(x, x, (mp_bitcnt_t) exponent);
}

void certificate_set_scaled(mpq_t x, const mpz_t num, const mpz_t den, long exponent)
{
    mpq_set_num(x, num);
    mpq_set_den(x, den);
    mpq_canonicalize(x);
    scale(x, exponent);
}

/* ---- A point inside of Q, and the directions of Q ---- */

/* The affine hull of Q, as far as the points seen span it. */
struct hull {
    long unit;  /* of the exact pair */
    int points; /* seen, and affinely independent */
    /* A basis of the directions in reduced echelon form: direction[k], where there is one, is 1 in
     * coordinate k and 0 in those before it; all others are 0 in coordinate k. */
    bool has[COORDINATES];
    mpq_t direction[COORDINATES][COORDINATES]; /* [k][coordinate] */
    mpq_t duration;
    mpq_t first[COORDINATES], sum[COORDINATES];
    mpq_t seen[COORDINATES], rest[COORDINATES];
    mpq_t factor, product;
};

static void set_seen(struct hull *hull, const struct exact_point *point)
{
    for (int k = 0; k < COORDINATES; k++)
        certificate_set_scaled(hull->seen[k], point->at[k], point->den, k == 0 ? 0 : hull->unit);
    mpq_mul(hull->seen[0], hull->seen[0], hull->duration);
}

/* v := v - v[k] direction[k], whose coordinate k is 0. */
static void clear_coordinate(struct hull *hull, mpq_t v[COORDINATES], int k)
{
    if (mpq_sgn(v[k]) == 0)
        return;
    mpq_set(hull->factor, v[k]);
    for (int i = 0; i < COORDINATES; i++) {
        mpq_mul(hull->product, hull->factor, hull->direction[k][i]);
        mpq_sub(v[i], v[i], hull->product);
    }
}

/* Adds a direction, or nothing if it depends on those that there are; true if it did. It is
 * overwritten. */
static bool add_direction(struct hull *hull, mpq_t v[COORDINATES])
{
    int pivot = COORDINATES;
    for (int k = COORDINATES - 1; k >= 0; k--)
        if (hull->has[k])
            clear_coordinate(hull, v, k);
    for (int k = COORDINATES - 1; k >= 0; k--)
        if (mpq_sgn(v[k]) != 0)
            pivot = k;
    if (pivot == COORDINATES)
        return false;

    hull->has[pivot] = true;
    for (int k = 0; k < COORDINATES; k++)
        mpq_div(hull->direction[pivot][k], v[k], v[pivot]);
    for (int k = 0; k < COORDINATES; k++)
        if (hull->has[k] && k != pivot)
            clear_coordinate(hull, hull->direction[k], pivot);
    return true;
}

static void add_point(void *context, const struct exact_point *point)
{
    struct hull *hull = context;
    if (hull->points == COORDINATES + 1)
        return;
    set_seen(hull, point);
    if (hull->points == 0)
        for (int k = 0; k < COORDINATES; k++)
            mpq_set(hull->first[k], hull->seen[k]);
    for (int k = 0; k < COORDINATES; k++)
        mpq_sub(hull->rest[k], hull->seen[k], hull->first[k]);
    if (hull->points > 0 && !add_direction(hull, hull->rest))
        return;
    for (int k = 0; k < COORDINATES; k++)
        mpq_add(hull->sum[k], hull->sum[k], hull->seen[k]);
    hull->points++;
}

/* ---- Along a line ---- */

/* A line at + s direction through a point of ri Q, along a direction of Q. */
struct chord {
    struct exact_pair *exact;
    int frame;
    mpq_t *at, *direction; /* [coordinate] */
    bool bounded;
    mpz_t values[EXACT_VECTORS]; /* a normal . each vector of the pair */
    mpq_t low, high;             /* where the line leaves Q: s from low to high */
    /* [axis]: the point of the line from the origin of one frame, in integers of the exact pair, is
     * place + s way. */
    mpq_t place[3], way[3];
    mpq_t value, slope; /* of what is bounded: value + s slope */
    mpq_t bound[2], number;
};

/* Shortens the chord to bound[0] <= value + s slope <= bound[1], which are overwritten. Where the
 * slope is 0 this holds along the whole line, as it does at its point of ri Q. */
static void shorten(struct chord *chord)
{
    int sign = mpq_sgn(chord->slope);
    if (sign == 0)
        return;
    for (int side = 0; side < 2; side++) {
        mpq_sub(chord->bound[side], chord->bound[side], chord->value);
        mpq_div(chord->bound[side], chord->bound[side], chord->slope);
    }
    if (sign < 0)
        mpq_swap(chord->bound[0], chord->bound[1]);
    if (!chord->bounded || mpq_cmp(chord->bound[0], chord->low) > 0)
        mpq_set(chord->low, chord->bound[0]);
    if (!chord->bounded || mpq_cmp(chord->bound[1], chord->high) < 0)
        mpq_set(chord->high, chord->bound[1]);
    chord->bounded = true;
}

static void shorten_to_window(struct chord *chord, double duration)
{
    mpq_set(chord->value, chord->at[0]);
    mpq_set(chord->slope, chord->direction[0]);
    mpq_set_ui(chord->bound[0], 0, 1);
    mpq_set_d(chord->bound[1], duration);
    shorten(chord);
}

/* out := normal . v. */
static void dot(mpq_t out, mpz_t normal[3], mpq_t v[3], mpq_t scratch)
{
    mpq_set_ui(out, 0, 1);
    for (int axis = 0; axis < 3; axis++) {
        mpq_set_z(scratch, normal[axis]);
        mpq_mul(scratch, scratch, v[axis]);
        mpq_add(out, out, scratch);
    }
}

static void shorten_to_slab(void *context, mpz_t normal[3])
{
    struct chord *chord = context;
    exact_set_values(chord->exact, normal, chord->values);
    exact_extent(chord->exact, chord->frame, chord->values, mpq_numref(chord->bound[0]),
                 mpq_numref(chord->bound[1]));
    mpz_set_ui(mpq_denref(chord->bound[0]), 1);
    mpz_set_ui(mpq_denref(chord->bound[1]), 1);
    dot(chord->value, normal, chord->place, chord->number);
    dot(chord->slope, normal, chord->way, chord->number);
    shorten(chord);
}

/* At the time t the point p lies at p - t v - o from the origin of the frame. */
static void shorten_to_frame(struct chord *chord, const struct placed_frame *placed, int f)
{
    const struct exact_pair *exact = chord->exact;
    for (int axis = 0; axis < placed->frame->dim; axis++) {
        mpq_set_d(chord->number, placed->placement->velocity[axis]);
        mpq_mul(chord->place[axis], chord->number, chord->at[0]);
        mpq_sub(chord->place[axis], chord->at[1 + axis], chord->place[axis]);
        mpq_mul(chord->way[axis], chord->number, chord->direction[0]);
        mpq_sub(chord->way[axis], chord->direction[1 + axis], chord->way[axis]);
        scale(chord->place[axis], -exact->unit);
        scale(chord->way[axis], -exact->unit);
        mpq_set_z(chord->number, exact->scale);
        mpq_mul(chord->place[axis], chord->place[axis], chord->number);
        mpq_mul(chord->way[axis], chord->way[axis], chord->number);
        mpq_set_z(chord->number, exact->frame[f].origin[axis]);
        mpq_sub(chord->place[axis], chord->place[axis], chord->number);
    }
    chord->frame = f;
    limbs_functions_of(&exact->question)->normals(&exact->question, f, shorten_to_slab, chord);
}

/* Moves the point along its line to where coordinate k, which is 1 in the direction, is the
 * simplest number inside of Q. */
static void simplify(struct chord *chord, int k)
{
    mpq_add(chord->low, chord->low, chord->at[k]);
    mpq_add(chord->high, chord->high, chord->at[k]);
    simplest_between(chord->number, chord->low, chord->high);
    mpq_sub(chord->value, chord->number, chord->at[k]);
    for (int i = 0; i < COORDINATES; i++) {
        mpq_mul(chord->number, chord->value, chord->direction[i]);
        mpq_add(chord->at[i], chord->at[i], chord->number);
    }
}

static void move_point(struct hull *hull, mpq_t at[COORDINATES], struct exact_pair *exact,
                       const struct frame_pair *pair)
{
    struct chord chord = {.exact = exact, .at = at};
    RATIONAL_EACH_FROM(low, &chord, mpq_init);
    integer_each(chord.values, sizeof chord.values, mpz_init);
    for (int k = 0; k < COORDINATES; k++) {
        if (!hull->has[k])
            continue;
        chord.direction = hull->direction[k];
        chord.bounded = false;
        shorten_to_window(&chord, pair->duration);
        shorten_to_frame(&chord, &pair->a, 0);
        shorten_to_frame(&chord, &pair->b, 1);
        assert(chord.bounded && mpq_cmp(chord.low, chord.high) < 0);
        simplify(&chord, k);
    }
    integer_each(chord.values, sizeof chord.values, mpz_clear);
    RATIONAL_EACH_FROM(low, &chord, mpq_clear);
}

/* ---- The point ---- */

void certificate_write_meeting(struct certificate_writer *writer, struct exact_pair *exact,
                               const struct frame_pair *pair)
{
    struct hull hull = {.unit = exact->unit};
    RATIONAL_EACH_FROM(direction, &hull, mpq_init);
    mpq_set_d(hull.duration, pair->duration);
    points_walk(exact, add_point, &hull);
    assert(hull.points > 0);

    mpq_t *mean = hull.sum;
    mpq_set_si(hull.factor, 1, (unsigned long) hull.points);
    for (int k = 0; k < COORDINATES; k++)
        mpq_mul(mean[k], mean[k], hull.factor);
    move_point(&hull, mean, exact, pair);

    certificate_write_text(writer, " at ");
    certificate_write_number(writer, mean[0]);
    certificate_write_vector(writer, pair->a.frame->dim, mean + 1);
    RATIONAL_EACH_FROM(direction, &hull, mpq_clear);
}
