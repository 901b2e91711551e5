#include "turn_gap.h"

#include <math.h>
#include <string.h>

enum {
    GAP_LOOKS_MAX = 2000,
    GAP_LOOKS_STEP = 16,     /* the most pieces that a step examines */
    GAP_VERTICES_STEP = 4096 /* fewer pieces for large hulls: a depth takes many scans */
};

/* Pieces shorter than this use a second direction. */
static const double wide_piece = 0x1p-6;

/* The limit of fmb.h, with a margin for the rounding of the largest coordinate. */
static const double limit = 0.95e-12;

/* Returns a lower bound, up to rounding, of the largest coordinate of a vertex at s. */
static double largest_coordinate(struct turn_path *path, double s)
{
    double largest = 0;
    turn_path_pose(path, s);
    for (int f = 0; f < 2; f++)
        for (int axis = 0; axis < path->pair.dim; axis++)
            for (int sign = -1; sign <= 1; sign += 2) {
                const struct support_view *view = &path->pair.view[f];
                double n[FMB_DIM_MAX] = {0};
                n[axis] = sign;
                largest = fmax(largest, support_view_farthest(view, n).value +
                                            sign * path->pair.position[f][axis] +
                                            view->placed.frame->radius);
            }
    return largest;
}

/* ---- One piece ---- */

static void push(struct turn_gap *gap, double lo, double hi, double least, bool looked)
{
    gap->piece[gap->count++] = (struct turn_piece){lo, hi, least, looked};
}

/* Takes the gap at the middle of the piece being examined, and bounds the gap over the piece by the
 * direction n, in the order of the path. In: the path is posed at the middle. */
static void take(struct turn_gap *gap, const double n[FMB_DIM_MAX])
{
    struct turn_direction direction[3];
    const struct turn_piece *next = &gap->next;
    const double enough = fmin(gap->at.bounds[1], gap->best.bounds[1]) - gap->tight;
    double least = next->least;
    gap->at.time = gap->path->pair.at * gap->path->pair.frames->duration;
    if (gap->at.has_witness)
        gap->at.bounds[1] = (gap->at.bounds[1] + gap->travel) * (1 + 0x1p-52);
    /* If the frames are slightly apart, the depth is 0 but the direction proves a distance. */
    gap->at.bounds[0] = fmin(gap->at.bounds[0], gap->at.bounds[1]);
    /* Also tries the vertices that become supporting within the piece, and the last good direction.
     */
    for (int k = 0; k < 3 && least < enough && gap->path->pair.usable; k++) {
        const double slack = k == 1 ? next->hi - next->lo : 0;
        const unsigned count =
            k == 2 ? gap->has_good : turn_directions(gap->path, n, slack, direction);
        for (unsigned i = 0; i < count && slack < wide_piece && least < enough; i++) {
            const struct turn_direction *of = k == 2 ? &gap->good : &direction[i];
            const double bound = turn_distance(gap->path, of, next->lo, next->hi);
            if (bound > enough && k < 2) {
                gap->good = *of;
                gap->has_good = true;
            }
            least = fmax(least, bound);
        }
    }
    if (gap->at.bounds[1] < gap->best.bounds[1])
        gap->best = gap->at;
    if (least <= gap->best.bounds[1] && next->lo < next->hi)
        push(gap, next->lo, next->hi, least, true);
}

/* Returns the lower bound of the gap at the present pose that a direction of length 1 proves. */
static double proved_by(const struct support_pair *pair, const double n[FMB_DIM_MAX])
{
    const double outward[FMB_DIM_MAX] = {-n[0], -n[1], -n[2]};
    struct support_column column;
    return -support_farthest(pair, outward, &column) - (1.25 * pair->error + pair->radius[1]);
}

/* Bounds the gap by a search that proves no verdict. The distance of its nearest point is an upper
 * bound. Its direction, computed from a small difference of large numbers, may be poor; the last
 * good direction replaces it if it proves a greater lower bound. */
static void set_unsure(struct turn_gap *gap, struct support_nearest *nearest)
{
    const struct support_pair *pair = &gap->path->pair;
    double *n = nearest->direction, good[FMB_DIM_MAX];
    gap->at.bounds[0] = proved_by(pair, n);
    if (gap->has_good) {
        turn_normal(gap->path, &gap->good, good);
        const double length = sqrt(vec3_dot(good, good));
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            good[axis] /= length;
        const double other = proved_by(pair, good);
        if (other > gap->at.bounds[0]) {
            memcpy(n, good, sizeof good);
            gap->at.bounds[0] = other;
        }
    }
    gap->at.bounds[1] = support_distance_above(pair, nearest) - pair->radius[0];
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        gap->at.direction[axis] = (gap->swapped ? -1 : 1) * n[axis] + 0.0;
}

static void take_known(struct turn_gap *gap)
{
    double n[FMB_DIM_MAX];
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        n[axis] = (gap->swapped ? -1 : 1) * gap->at.direction[axis];
    take(gap, n);
}

/* Examines the middle of a piece. Even if the frames overlap deeply, a search proves no verdict
 * when the origin is on the boundary of its simplex, as for frames with a common centre. The
 * computation of the depth does not depend on the simplex. */
static void look(struct turn_gap *gap, struct turn_piece piece)
{
    struct support_pair *pair = &gap->path->pair;
    struct support_nearest nearest;
    const double none[FMB_DIM_MAX] = {0}, s = 0.5 * (piece.lo + piece.hi);
    enum fmb_verdict cores = 0, verdict = 0;
    gap->next = piece;
    memset(&gap->at, 0, sizeof gap->at);
    gap->looks++;
    if (pair->usable)
        verdict = turn_look(gap->path, s, none, &nearest, &cores);
    else
        turn_path_pose(gap->path, s);
    if (gap->separated) {
        cores = verdict = FMB_SEPARATED;
    } else if (cores == 0 || verdict == 0) {
        if (pair->usable)
            set_unsure(gap, &nearest);
        if (cores || (pair->usable && gap->at.bounds[1] - gap->at.bounds[0] <= gap->tight)) {
            take_known(gap);
            return;
        }
        cores = verdict = FMB_OVERLAPPING;
    }
    if (support_gap_of_pair(pair, gap->swapped, pair->usable ? &nearest : NULL, cores, verdict,
                            INFINITY, &gap->at, &gap->work) == GAP_KNOWN)
        take_known(gap);
}

/* ---- All pieces ---- */

/* Returns an upper bound of the distance that the points of both frames move within the error of a
 * time in seconds. The position at the end passes two roundings. A quaternion turns a frame by at
 * most 2 |q0| |q1| / |q(s)|^2 radians for each unit of s. The lengths of q0 and q1 differ by a
 * factor of at most 4, and |q(s)|^2 is at least half the square of the lesser: at most 16. */
static double travel_of(const struct turn_path *path)
{
    const double duration = path->pair.frames->duration;
    const double late = duration < 0x1p-900 ? fmin(0x1p-1073 / duration, 1) : 0x1p-53;
    double way = 0;
    for (int f = 0; f < 2; f++) {
        way += 16 * path->pair.view[f].reach;
        for (int axis = 0; axis < path->pair.dim; axis++)
            way += fabs(path->position[f][1][axis] - path->position[f][0][axis]) +
                   0x1p-51 * (fabs(path->position[f][0][axis]) + fabs(path->position[f][1][axis]));
    }
    return late * way * (1 + 0x1p-40);
}

void turn_gap_begin(struct turn_path *path, bool swapped, bool separated, double known,
                    double farthest, struct turn_gap *out)
{
    out->path = path;
    out->separated = separated;
    out->swapped = swapped;
    out->farthest = farthest;
    out->count = out->looks = 0;
    out->work = NULL;
    out->has_good = false;
    out->travel = travel_of(path);
    const double most = limit * fmax(largest_coordinate(path, 0), largest_coordinate(path, 1));
    out->tight = fmax(most - 2 * out->travel, 0.5 * most);
    out->best = gap_none();
    out->best.bounds[1] = INFINITY;
    /* The reach plus the radii bounds the distance of all points of D from the origin. */
    const double least = separated ? 0 : -(path->pair.reach + path->pair.radius[1]) * (1 + 0x1p-40);
    /* The ends come first: the gap is often least there. */
    push(out, 0, 1, least, !path->pair.usable);
    push(out, 1, 1, least, false);
    push(out, 0, 0, least, false);
    if (!path->pair.usable)
        push(out, known, known, least, false);
}

static unsigned looks_of_step(const struct turn_path *path)
{
    const unsigned looks = 1 + GAP_VERTICES_STEP / turn_vertices(path);
    return looks < GAP_LOOKS_STEP ? looks : GAP_LOOKS_STEP;
}

enum gap_outcome turn_gap_step(struct turn_gap *gap, struct fmb_gap *out)
{
    const unsigned end = gap->looks + looks_of_step(gap->path);
    if (gap->work) {
        if (support_gap_step(gap->work, &gap->at) == GAP_UNSURE)
            return GAP_UNSURE;
        gap->work = NULL;
        take_known(gap);
    }
    while (gap->looks < end && !gap->work) {
        unsigned first = 0;
        for (unsigned k = 1; k < gap->count; k++)
            if (gap->piece[k].least <= gap->piece[first].least)
                first = k;
        const struct turn_piece piece = gap->piece[first];
        const double least = gap->count ? piece.least : gap->best.bounds[0];
        const double shortest = gap->path->pair.usable ? 0x1p-49 : INFINITY;
        if (least > gap->farthest + gap->tight)
            return GAP_FAR;
        if (gap->best.bounds[1] - least <= gap->tight || gap->count == 0 ||
            gap->looks > GAP_LOOKS_MAX || gap->count + 2 > TURN_PIECES ||
            (piece.looked && piece.hi - piece.lo < shortest)) {
            *out = gap->best;
            /* What the direction proves at the rounded time. */
            const double proved = out->bounds[0] - gap->travel;
            out->bounds[0] = fmin(least, proved - fabs(proved) * 0x1p-52);
            if (!gap->separated) {
                out->bounds[1] = fmin(out->bounds[1], 0);
                out->has_witness = false;
                memset(out->witness, 0, sizeof out->witness);
            }
            return GAP_KNOWN;
        }
        gap->piece[first] = gap->piece[--gap->count];
        /* The last good direction often gives a tight bound, and costs less than a depth. */
        const double bound =
            !piece.looked && gap->has_good && !gap->separated && piece.lo < piece.hi
                ? turn_distance(gap->path, &gap->good, piece.lo, piece.hi)
                : -INFINITY;
        if (bound >= gap->best.bounds[1] - gap->tight) {
            gap->looks++;
            if (bound <= gap->best.bounds[1])
                push(gap, piece.lo, piece.hi, bound, true);
        } else if (piece.looked) {
            const double middle = 0.5 * (piece.lo + piece.hi);
            push(gap, middle, piece.hi, piece.least, false);
            push(gap, piece.lo, middle, piece.least, false);
        } else {
            look(gap, piece);
        }
    }
    return GAP_UNSURE;
}

void turn_gap_end(struct turn_gap *gap)
{
    if (gap->work)
        support_gap_end(gap->work);
    gap->work = NULL;
}
