#include "support_round.h"

#include "interval.h"
#include "programs.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- Distance ----
 *
 * Lower bound: n . x >= least - 4 error for all x of D, n the direction of the search
 * (support_search.c). The length of n is 1 up to 6 u, which changes the bound by less than another
 * error. The sharper bound takes the least n . x from support_farthest(), which is off by one error
 * |n|.
 *
 * Upper bound: the weights of the search, none of them below 0 and divided by their sum, give a
 * point of D. Each of its at most 4 terms is off by error, and computing the sum by 10 u reach,
 * less than a third of another error. */

static double sharper_distance(const struct support_pair *pair,
                               const struct support_nearest *nearest)
{
    const double *n = nearest->direction, outward[FMB_DIM_MAX] = {-n[0], -n[1], -n[2]};
    struct support_column column;
    return -support_farthest(pair, outward, &column) - 1.25 * pair->error;
}

/* Sets the point of D that a search found, as its weights say. Returns their sum. */
static double point_of(const struct support_nearest *nearest, double out[FMB_DIM_MAX])
{
    double total = 0;
    memset(out, 0, FMB_DIM_MAX * sizeof *out);
    for (unsigned i = 0; i < nearest->simplex.count; i++) {
        const double weight = fmax(nearest->weight[i], 0);
        total += weight;
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            out[axis] += weight * nearest->simplex.vertex[i].at[axis];
    }
    return total;
}

double support_distance_above(const struct support_pair *pair,
                              const struct support_nearest *nearest)
{
    double at[FMB_DIM_MAX];
    const double total = point_of(nearest, at);
    const double distance = sqrt(vec3_dot(at, at)) / total * (1 + 0x1p-49) + 1.4 * pair->error;
    return total > 0.5 && total < 2 ? distance : INFINITY;
}

double support_round_far(const struct support_pair *pair)
{
    return pair->radius[1] + 2 * support_separating_distance(pair);
}

/* GAP_FAR: the distance is greater than far - 4 error. */
enum fmb_verdict support_round_verdict(const struct support_pair *pair, enum fmb_verdict cores,
                                       const struct support_nearest *nearest)
{
    if (nearest->outcome == GAP_FAR)
        return FMB_SEPARATED;
    if (cores == FMB_OVERLAPPING || support_distance_above(pair, nearest) < pair->radius[0])
        return FMB_OVERLAPPING;
    if (nearest->outcome != GAP_KNOWN || nearest->least < pair->radius[1])
        return 0;
    return nearest->least - 5 * pair->error > pair->radius[1] ||
                   sharper_distance(pair, nearest) > pair->radius[1]
               ? FMB_SEPARATED
               : 0;
}

/* ---- Contact in doubles ----
 *
 * Times are fractions tau of the window, counted from the end of the window at which the search
 * begins, its edge. The offset at tau is that at the edge plus tau times a drift: two more
 * roundings, which the error of the pair covers (support_pair.h counts 4.1 u |offset| and 5.1 u
 * |drift| of its 32 u).
 *
 * Method. While the nearest point p of D stays on the same face, the distance of the cores after
 * another time tau is |p + tau w|, w the component of the drift orthogonal to the face. It equals R
 * at a root of a quadratic equation. A search near that time finds the face there, and the step is
 * repeated. If the root is not between the bounds known so far, their middle takes its place.
 *
 * Proof. The end of the contact is between a time up to which the frames are apart, and a time at
 * which they meet or from which on they are apart. The two times differ by at most the limit. */

/* The limit on an end, relative to the window. fmb.h allows 1e-12; the remainder covers the
 * rounding of seconds. */
static const double contact_limit = 0.9e-12;

enum { LOOKS_MAX = 16 };

struct slice {
    struct support_pair pair;
    double edge[FMB_DIM_MAX], drift[FMB_DIM_MAX]; /* offset at the edge; its change from there */
    struct support_nearest nearest;
};

/* Searches for the nearest point at one time, starting from the direction found last. Returns the
 * verdict that is proved, or 0. */
static enum fmb_verdict look(struct slice *slice, double tau)
{
    const struct support_pair *pair = &slice->pair;
    double toward[FMB_DIM_MAX];
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        slice->pair.offset[axis] = slice->edge[axis] + tau * slice->drift[axis];
    memcpy(toward, slice->nearest.direction, sizeof toward);
    if (vec3_dot(toward, toward) == 0)
        support_toward(pair, toward);
    const enum fmb_verdict cores = support_search_from(pair, toward, INFINITY, &slice->nearest);
    return support_round_verdict(pair, cores, &slice->nearest);
}

/* Returns the fraction of the window after which the distance is R if the nearest point stays on
 * its face; INFINITY if there is no face. */
static double time_to_contact(const struct slice *slice)
{
    const struct support_nearest *nearest = &slice->nearest;
    const unsigned count = nearest->simplex.count;
    const double *w = slice->drift, *n = nearest->direction;
    double p[FMB_DIM_MAX], across[FMB_DIM_MAX], radius = slice->pair.radius[0];
    if (nearest->outcome != GAP_KNOWN || count > 3)
        return INFINITY;
    point_of(nearest, p);
    memcpy(across, w, sizeof across);
    if (count == 3)
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            across[axis] = vec3_dot(n, w) * n[axis];
    if (count == 2) {
        double e[FMB_DIM_MAX];
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            e[axis] = nearest->simplex.vertex[1].at[axis] - nearest->simplex.vertex[0].at[axis];
        const double along = vec3_dot(w, e) / vec3_dot(e, e);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            across[axis] -= along * e[axis];
    }
    const double a = vec3_dot(across, across), b = vec3_dot(p, across);
    const double distance = sqrt(vec3_dot(p, p));
    const double square = (distance - radius) * (distance + radius), root = b * b - a * square;
    return root > 0 ? square / (sqrt(root) - b) : -b / a;
}

/* Returns 1 if the frames are certainly apart at all times before the last one searched, -1 if at
 * all times after it, 0 if neither is certain. The direction n of the search proves it, since n . x
 * changes by n . drift. In: the frames are apart at that time. */
static int side_of(const struct slice *slice)
{
    const double speed = vec3_dot(slice->nearest.direction, slice->drift);
    const double error = 0x1p-48 * vec3_sum(slice->drift);
    return speed < -error ? 1 : speed > error ? -1 : 0;
}

/* Sets *guess to a time near the first one at which the frames meet, or to NAN, and *apart to
 * whether they are certainly apart at the edge. Returns a time up to which they are apart, at most
 * contact_limit before they meet; 0 if they meet at the edge; NAN if doubles do not give it. In: a
 * pair that meets at some time. */
static double find_end(struct slice *slice, double *guess, bool *apart)
{
    double tau = 0, out = 0, in = 1, root = 0;
    enum fmb_verdict verdict = look(slice, tau);
    *guess = NAN;
    *apart = verdict == FMB_SEPARATED;
    if (verdict == FMB_OVERLAPPING)
        return 0;
    for (int n = 0; n < LOOKS_MAX && *apart; n++) {
        const double before = root;
        root = tau + time_to_contact(slice);
        if (!(root > out && root < in))
            root = out + 0.5 * (in - out);
        if (fabs(root - before) < 0.2 * contact_limit)
            *guess = root;
        /* Just before the root; or just after it, if the frames are apart until just before it. */
        tau = root + (out > root - 0.6 * contact_limit ? 0.45 : -0.45) * contact_limit;
        verdict = look(slice, tau);
        const int side = verdict == FMB_SEPARATED ? side_of(slice) : 0;
        if (side > 0)
            out = tau;
        else if (side < 0 || verdict == FMB_OVERLAPPING)
            in = tau;
        else if (!isnan(*guess))
            return NAN;
        if (in - out <= contact_limit)
            return out;
    }
    return NAN;
}

bool support_round_contact(const struct support_pair *pair, struct support_round_ends *out)
{
    const double duration = pair->frames->duration;
    struct slice slice;
    *out = (struct support_round_ends){.time = {NAN, NAN}, .guess = {NAN, NAN}};
    if (!pair->usable)
        return false;
    support_pair_set(pair->frames, &slice.pair);
    slice.pair.drifts = false;
    for (int end = 0; end < 2; end++) {
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            const double drift = pair->drift[axis];
            slice.edge[axis] = pair->offset[axis] + (end ? drift : 0);
            slice.drift[axis] = end ? -drift : drift;
            slice.nearest.direction[axis] = 0;
        }
        double guess;
        const double tau = find_end(&slice, &guess, &out->apart[end]);
        out->time[end] =
            end ? duration * (1 - tau) * (1 + 0x1p-50) : duration * tau * (1 - 0x1p-50);
        if (out->time[end] > duration)
            out->time[end] = duration;
        out->guess[end] = duration * (end ? 1 - guess : guess);
    }
    return out->time[0] <= out->time[1];
}

/* ---- Contact in exact numbers ---- */

/* Begins to compare the distance at a time with the sum of the radii. */
static void begin_slice(struct support_round_times *times, double time)
{
    times->frames.duration = time;
    support_pair_set(&times->frames, &times->sliced);
    times->programs = programs_begin_nearest(&times->sliced, true, NULL, 0);
}

/* Begins the search for an end whose time is not known. */
static void begin_end(struct support_round_times *times, int end)
{
    const double duration = times->pair->frames->duration;
    times->end = end;
    times->at_edge = !times->ends.apart[end];
    times->out = end ? duration + 0.0 : 0;
    times->in = times->inside[!end];
    times->near = 0.45 * contact_limit * duration;
}

/* Returns the time to be tried next: just outside of the guess, just inside, or in the middle. */
static double next_time(const struct support_round_times *times)
{
    const double sign = times->end ? -1 : 1, guess = times->ends.guess[times->end];
    const double before = guess - sign * times->near, after = guess + sign * times->near;
    if (sign * before > sign * times->out && sign * before < sign * times->in)
        return before;
    if (sign * after > sign * times->out && sign * after < sign * times->in)
        return after;
    return times->out + 0.5 * (times->in - times->out);
}

/* If the result at a time tried contradicts the guess, moves the guess to the other side of that
 * time. */
static void move_guess(struct support_round_times *times, double tried, bool meets)
{
    const double sign = times->end ? -1 : 1;
    double *guess = &times->ends.guess[times->end];
    if ((sign * tried < sign * *guess) != meets)
        return;
    times->near *= 4;
    *guess = tried + (meets ? -sign : sign) * times->near;
}

/* Begins the next time to be tried. Returns false if both ends are known. An interval is bisected
 * only while it is longer than the limit, which is far more than the rounding of `inside`. */
static bool try_next(struct support_round_times *times)
{
    const double duration = times->pair->frames->duration;
    for (;;) {
        const double next = times->at_edge ? times->out : next_time(times);
        if (times->at_edge || (fabs(times->in - times->out) > contact_limit * duration &&
                               next != times->in && next != times->out)) {
            begin_slice(times, next);
            return true;
        }
        times->ends.time[times->end] = times->out;
        if (times->end == 1 || !isnan(times->ends.time[1]))
            return false;
        begin_end(times, 1);
    }
}

void support_round_times_begin(const struct support_pair *pair, const double inside[2],
                               const struct support_round_ends *ends,
                               struct support_round_times *out)
{
    out->pair = pair;
    out->frames = *pair->frames;
    out->ends = *ends;
    memcpy(out->inside, inside, sizeof out->inside);
    begin_end(out, isnan(ends->time[0]) ? 0 : 1);
    try_next(out);
}

bool support_round_times_step(struct support_round_times *times)
{
    if (!programs_step(times->programs))
        return false;
    const bool meets = programs_proof(times->programs)->verdict != FMB_SEPARATED;
    const double tried = times->frames.duration;
    support_round_times_end(times);
    if (times->at_edge && meets)
        times->in = times->out;
    if (!times->at_edge) {
        move_guess(times, tried, meets);
        *(meets ? &times->in : &times->out) = tried;
    }
    times->at_edge = false;
    return !try_next(times);
}

void support_round_times_end(struct support_round_times *times)
{
    if (times->programs)
        programs_end(times->programs, NULL);
    times->programs = NULL;
}

/* ---- Box ----
 *
 * The coordinate of the farthest vertex along an axis is exact if the frame is not turned and its
 * stored vertices are exact; otherwise it is off by the bound of support_view_farthest(). Sums are
 * rounded outward. */

static double sum_up(double x, double y)
{
    return interval_sum(interval_of(x), interval_of(y)).high;
}

/* Returns an upper bound of velocity times t over the contact. */
static double path_up(double velocity, const double contact[2])
{
    const double path = fmax(velocity * contact[0], velocity * contact[1]);
    return path == 0 || velocity == 0 ? path : path + fabs(path) * 0x1p-52 + 0x1p-1074;
}

/* Returns the greatest sign times coordinate of a frame along an axis over the contact. Numbers
 * near the largest double are scaled, so that no sum overflows. */
static double end_of(const struct support_view *view, int axis, double sign,
                     const double contact[2])
{
    const struct fmb_placement *placement = view->placed.placement;
    const bool exact = !view->rotation.turned && view->slack == 0;
    const double path = path_up(sign * placement->velocity[axis], contact);
    const double position = sign * placement->position[axis];
    const double most = fmax(fmax(view->reach, fabs(position)), fabs(path));
    const double scale = most < 0x1p1000 ? 1 : 0x1p-4;
    double along[FMB_DIM_MAX] = {0};
    along[axis] = sign * scale;
    double end = support_view_farthest(view, along).value;
    if (!exact)
        end = sum_up(end, scale * (fmin(0x1p-48 * view->reach, 0x1p977) + view->slack));
    end = sum_up(end, scale * position);
    end = sum_up(end, scale * path);
    end = sum_up(end, scale * view->placed.frame->radius);
    /* An end below all doubles is rounded up to the least one. */
    return isnan(end) ? INFINITY : fmax(end / scale, -DBL_MAX);
}

void support_round_box(const struct support_pair *pair, const double contact[2],
                       double box[2][FMB_DIM_MAX])
{
    memset(box, 0, 2 * sizeof *box);
    for (int axis = 0; axis < pair->dim; axis++)
        for (int side = 0; side < 2; side++) {
            const double sign = side ? 1 : -1;
            const double end = fmin(end_of(&pair->view[0], axis, sign, contact),
                                    end_of(&pair->view[1], axis, sign, contact));
            box[side][axis] = sign * end + 0.0; /* never -0 */
        }
}

/* ---- Gap ----
 *
 * The witness points move towards each other by the radii, along the line between them, of length
 * d. The direction of the line is off by 2 u times their coordinates over d, so a point is off by
 * that times its radius: by less than 4 u of the coordinates, since d >= R for separated frames.
 * With the rounding of their own coordinates, the upper bound grows by at most 8 u of the sum of
 * coordinates and radii. The gap of the cores was held to 0.9 of the limit of fmb.h on the width;
 * the remaining tenth is more than this.
 *
 * The witness points of an overlapping pair are moved by the radii along the direction, so that
 * a - b is still the depth times the direction. */
void support_round_gap(const struct frame_pair *frames, int exponent, enum fmb_verdict verdict,
                       bool deepest, struct fmb_gap *gap)
{
    const double radius[2] = {ldexp(frames->a.frame->radius, -exponent),
                              ldexp(frames->b.frame->radius, -exponent)};
    const double underflow = exponent == 0 ? 0 : 4 * 0x1p-1074;
    const bool separated = verdict == FMB_SEPARATED;
    gap->bounds[0] -= underflow;
    gap->bounds[1] += underflow;
    for (int f = 0; f < 2; f++) { /* one after the other: their sum may overflow */
        gap->bounds[0] = -sum_up(-gap->bounds[0], radius[f]);
        gap->bounds[1] = sum_up(gap->bounds[1], -radius[f]);
    }
    if (gap->has_witness && separated) {
        double toward[FMB_DIM_MAX], error = 0x1p-50 * radius[0] + 0x1p-50 * radius[1];
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            const double a = gap->witness[0][axis], b = gap->witness[1][axis];
            toward[axis] = fabs(a) > 1 || fabs(b) > 1 ? 0.25 * b - 0.25 * a : 0.25 * (b - a);
            error += 0x1p-50 * fabs(a) + 0x1p-50 * fabs(b);
        }
        const double largest = vec3_largest(toward);
        for (int axis = 0; axis < FMB_DIM_MAX && largest > 0; axis++)
            toward[axis] /= largest;
        const double length = sqrt(vec3_dot(toward, toward));
        for (int axis = 0; axis < FMB_DIM_MAX && length > 0; axis++) {
            gap->witness[0][axis] += radius[0] * (toward[axis] / length);
            gap->witness[1][axis] -= radius[1] * (toward[axis] / length);
        }
        gap->bounds[1] += error;
    } else if (deepest) {
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            gap->witness[0][axis] += radius[0] * gap->direction[axis];
            gap->witness[1][axis] -= radius[1] * gap->direction[axis];
        }
        gap->bounds[1] = fmin(gap->bounds[1], 0);
    } else {
        gap->has_witness = false;
        memset(gap->witness, 0, sizeof gap->witness);
        gap->time = 0;
        gap->bounds[1] = fmin(gap->bounds[1], 0);
    }
    if (verdict == FMB_TOUCHING)
        gap->bounds[0] = gap->bounds[1] = 0;
}
