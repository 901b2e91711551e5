#include "turn_decision.h"

#include "aabb.h"
#include "integer.h"
#include "programs.h"

#include <math.h>
#include <string.h>

/* Short intervals are left to integers, which divide them down to the least length. Relative to the
 * window, an end of a contact is at most short_interval too far out. */
static const double short_interval = 0x1p-41, least_interval = 0x1p-50;

/* A negative bound in doubles that is closer to 0 than this, relative to the reach, may be negative
 * only because about 2^-46 is subtracted for rounding. A search at one time subtracts less for
 * frames with a radius (support_round_verdict()). So it may prove a verdict at the middles of
 * thousands of intervals over which the bound is negative. Integers decide all these intervals at
 * once. */
static const double close_bound = 0x1p-43;

enum {
    /* The work of a decision, in searches in doubles, before it is given up without a verdict. */
    LOOKS_MAX = 4000,
    LOOKS_EXACT = 8,       /* the cost of an exact verdict */
    LOOKS_DIRECTION = 2,   /* the cost of an exact direction */
    VERTICES_OF_LOOK = 64, /* so many vertices add 1 to either cost */
    LOOKS_BOUNDED = 200,
    LOOKS_STEP = 64,
    CORNERS_STEP = 64,   /* directions by vertices that a step tests in doubles */
    DIRECTIONS_MAX = 20, /* tried towards an end of the contact */
    /* After so much work on lists of directions that separated no part of an interval, the exact
     * verdict is determined before any list is tried. Plates in one plane have tens of directions
     * that never separate them. */
    LOOKS_FRUITLESS = 400
};

void turn_none(struct turn_decision *out)
{
    out->programs = NULL;
    out->has_exact = false;
    out->phase = TURN_COMPLETE;
}

void turn_end(struct turn_decision *decision)
{
    if (decision->programs)
        programs_end(decision->programs, NULL);
    if (decision->has_exact)
        turn_exact_end(&decision->exact);
    if (decision->phase == TURN_GAP)
        turn_gap_end(&decision->gap);
    turn_none(decision);
}

/* ---- Verdicts at one time ---- */

/* Returns where an interval is examined and divided: at `split` if the interval contains it,
 * otherwise at its middle. The middle is rounded down to a multiple of 2^-52 so that
 * 1 - s is exact (the length of an interval next to a known contact need not be a power of two). */
static double cut_of(const struct turn_decision *decision, struct turn_interval interval)
{
    if (interval.lo < decision->split && decision->split < interval.hi)
        return decision->split;
    return floor(0.5 * (interval.lo + interval.hi) * 0x1p52) * 0x1p-52;
}

static void remember(struct turn_decision *decision, double at, enum fmb_verdict verdict)
{
    decision->known[decision->next_known].at = at;
    decision->known[decision->next_known].verdict = verdict;
    decision->next_known = (decision->next_known + 1) % TURN_KNOWN;
}

/* Begins the programs for the pose at s: for the nearest point, or for the verdict; in the stage
 * TURN_CORNER, for its proof too. If a frame has a radius, the nearest point gives the verdict. */
static void begin_programs(struct turn_decision *decision, double s, bool nearest)
{
    const unsigned want = decision->stage == TURN_CORNER ? FMB_WANT_CERTIFICATE : 0;
    struct support_pair *pair = &decision->path.pair;
    struct support_column first[FMB_DIM_MAX + 1];
    const bool guessed = pair->usable && decision->looked == s;
    const unsigned count = guessed ? support_columns(&decision->nearest.simplex, first) : 0;
    turn_path_pose(&decision->path, s);
    decision->looks += LOOKS_EXACT + turn_vertices(&decision->path) / VERTICES_OF_LOOK;
    decision->programs = nearest || pair->rounded
                             ? programs_begin_nearest(pair, false, first, count)
                             : programs_begin(pair, want, first, count);
}

/* Searches in doubles at s. Returns the verdict, or 0. If the origin is on the boundary of the
 * simplex, as for frames with a common centre, the search proves nothing. Then a depth that is
 * greater than 0 proves an overlap. */
static enum fmb_verdict look(struct turn_decision *decision, double s)
{
    const struct support_pair *pair = &decision->path.pair;
    struct fmb_gap depth;
    enum fmb_verdict verdict = 0, cores;
    if (pair->usable) {
        verdict = turn_look(&decision->path, s, decision->toward, &decision->nearest, &cores);
        if (verdict == 0 && !pair->rounded &&
            support_gap_of_pair(pair, false, &decision->nearest, FMB_OVERLAPPING, FMB_OVERLAPPING,
                                INFINITY, &depth, NULL) == GAP_KNOWN &&
            depth.bounds[1] < 0)
            verdict = FMB_OVERLAPPING;
        decision->looks++;
        decision->looked = s;
        decision->sure = verdict != 0;
    }
    if (verdict)
        remember(decision, s, verdict);
    if (verdict == FMB_SEPARATED)
        memcpy(decision->toward, decision->nearest.direction, sizeof decision->toward);
    return verdict;
}

/* Returns the verdict at s if s is among the last TURN_KNOWN examined times, otherwise 0. */
static enum fmb_verdict known_at(const struct turn_decision *decision, double s)
{
    for (unsigned k = 0; k < TURN_KNOWN; k++)
        if (decision->known[k].at == s)
            return decision->known[k].verdict;
    return 0;
}

/* Returns the verdict at s if it is known or doubles give it. Otherwise returns 0, and a bounded
 * decision is exhausted. */
static enum fmb_verdict verdict_in_doubles(struct turn_decision *decision, double s)
{
    const enum fmb_verdict known = known_at(decision, s);
    const enum fmb_verdict verdict = known ? known : look(decision, s);
    if (verdict == 0 && decision->bounded)
        decision->exhausted = true;
    return verdict;
}

/* The same; but if it returns 0, a decision that is not bounded has begun the programs, and the
 * verdict is known when they have ended. */
static enum fmb_verdict verdict_at(struct turn_decision *decision, double s)
{
    const enum fmb_verdict verdict = verdict_in_doubles(decision, s);
    if (verdict == 0 && !decision->bounded)
        begin_programs(decision, s, false);
    return verdict;
}

/* ---- Directions by vertices ---- */

static void begin_exact(struct turn_decision *decision)
{
    if (!decision->has_exact)
        turn_exact_begin(&decision->path, &decision->exact);
    decision->has_exact = true;
}

static void add_corners(struct turn_decision *decision, int of, unsigned v0, unsigned v1,
                        unsigned v2, unsigned v3)
{
    if (decision->corner_count + 2 > TURN_CORNERS)
        return;
    for (int sign = -1; sign <= 1; sign += 2) {
        decision->corners[decision->corner_count] =
            (struct turn_corners){of, {(uint16_t) v0, (uint16_t) v1, (uint16_t) v2, (uint16_t) v3}};
        decision->sign[decision->corner_count++] = (signed char) sign;
    }
}

/* Vertices of a frame from which candidate faces and edges are formed. */
struct turn_features {
    uint16_t vertex[FMB_HULL_VERTICES_MAX];
    unsigned count;
    unsigned char edge[32][2]; /* indices of vertex */
    unsigned edges;
};

enum { NEAR_VERTICES = 6 };

/* Sets all vertices of a frame that has few, or the vertices of a hull near the nearest point. The
 * edges are all pairs of these vertices; the edges of a cuboid are its components. */
static void set_features(const struct turn_decision *decision, int f, struct turn_features *out)
{
    const struct support_view *view = &decision->path.pair.view[f];
    const struct fmb_frame *frame = view->placed.frame;
    out->count = view->vertices.count;
    out->edges = 0;
    if (frame->shape == FMB_CUBOID || frame->shape == FMB_BOX) {
        out->count = 1 + (unsigned) frame->count;
        for (unsigned i = 0; i < out->count; i++)
            out->vertex[i] = (uint16_t) (i == 0 ? 0 : 1u << (i - 1));
        for (unsigned i = 1; i < out->count; i++) {
            out->edge[out->edges][0] = 0;
            out->edge[out->edges++][1] = (unsigned char) i;
        }
        return;
    }
    for (unsigned i = 0; i < out->count; i++)
        out->vertex[i] = (uint16_t) i;
    if (out->count > NEAR_VERTICES) {
        double n[FMB_DIM_MAX];
        const double *last = decision->nearest.direction;
        turn_body_direction(view, vec3_dot(last, last) > 0 ? last : decision->toward, n);
        out->count = turn_farthest(view, n, f ? -1 : 1, 0, out->vertex);
        /* Takes vertices far apart in the list: neighbours may be nearly collinear. */
        for (unsigned i = 0; out->count > NEAR_VERTICES && i < NEAR_VERTICES; i++)
            out->vertex[i] = out->vertex[i * out->count / NEAR_VERTICES];
        out->count = out->count < NEAR_VERTICES ? out->count : NEAR_VERTICES;
    }
    for (unsigned i = 0; i < out->count; i++)
        for (unsigned j = i + 1; j < out->count; j++) {
            out->edge[out->edges][0] = (unsigned char) i;
            out->edge[out->edges++][1] = (unsigned char) j;
        }
}

/* Returns whether direction k might separate the frames over an interval, according to doubles. */
static bool may_separate(const struct turn_decision *decision, unsigned k,
                         struct turn_interval interval)
{
    struct turn_direction direction;
    if (!decision->path.pair.usable || decision->corners[k].vertex[0] >= TURN_ROUNDED)
        return true;
    turn_direction_of(decision->path.pair.view, &decision->corners[k], &direction);
    return turn_may_separate(&decision->path, &direction, decision->sign[k], interval.lo,
                             interval.hi);
}

/* Begins a list of directions. at: as corners_at. */
static void begin_list(struct turn_decision *decision, double at)
{
    decision->stage = TURN_CORNER;
    decision->outcome = TURN_OPEN;
    decision->corner = decision->corner_count = 0;
    decision->corners_at = at;
    decision->cleared = NAN;
}

/* Stores the verdict and the edges of the nearest point for list_nearest(). */
static void take_nearest(struct turn_decision *decision, const struct programs_proof *proof)
{
    unsigned count[2] = {0, 0};
    decision->nearest_verdict = proof->verdict;
    for (int f = 0; f < 2; f++)
        for (unsigned i = 0; i < proof->count; i++) {
            uint16_t *seen = &decision->nearest_edges.vertex[2 * f];
            const uint16_t v = (uint16_t) proof->column[i].vertex[f];
            const bool is_new = count[f] == 0 || (v != seen[0] && (count[f] == 1 || v != seen[1]));
            if (is_new && count[f] < 2)
                seen[count[f]] = v;
            count[f] += is_new;
        }
    decision->nearest_are_edges = count[0] == 2 && count[1] == 2 && decision->path.pair.dim == 3;
}

/* Lists the directions towards the nearest point: the product of the edges that it is on, and the
 * directions fixed in a frame. A proof stores doubles: if one is wanted, these are rounded first.
 */
static void list_nearest(struct turn_decision *decision)
{
    const uint16_t *v = decision->nearest_edges.vertex;
    const bool rounds = decision->proof && decision->nearest_verdict == FMB_SEPARATED;
    decision->corner_count = 0;
    if (decision->nearest_verdict == FMB_OVERLAPPING)
        return;
    if (decision->nearest_are_edges)
        add_corners(decision, 2, v[0], v[1], v[2], v[3]);
    for (int k = rounds ? 0 : 2; k < 4; k++) {
        const uint16_t which = k < 2 ? TURN_ROUNDED : TURN_NEAREST;
        decision->corners[decision->corner_count] = (struct turn_corners){k % 2, {which}};
        decision->sign[decision->corner_count++] = 1;
    }
}

/* Begins to try the directions towards the nearest point at a time or, if the frames touch then,
 * the direction that proves it. The programs compute this, unless it is known. */
static void begin_nearest(struct turn_decision *decision, double at)
{
    begin_list(decision, at);
    if (decision->nearest_at == at)
        list_nearest(decision);
    else
        begin_programs(decision, at, known_at(decision, at) != FMB_TOUCHING);
}

/* Lists the directions by vertices that will be tried. */
static void begin_corners(struct turn_decision *decision)
{
    struct turn_features of[2];
    const int dim = decision->path.pair.dim;
    begin_list(decision, -1);
    decision->began = decision->looks;
    for (int f = 0; f < 2; f++) {
        set_features(decision, f, &of[f]);
        const struct turn_features *on = &of[f];
        for (unsigned i = 0; i < on->count; i++)
            for (unsigned j = i + 1; j < on->count; j++) {
                if (dim == 2)
                    add_corners(decision, f, on->vertex[i], on->vertex[j], 0, 0);
                for (unsigned k = j + 1; k < on->count && dim == 3; k++)
                    if (on->edges > on->count || i == 0)
                        add_corners(decision, f, on->vertex[i], on->vertex[j], on->vertex[k], 0);
            }
    }
    for (unsigned i = 0; i < of[0].edges && dim == 3; i++)
        for (unsigned j = 0; j < of[1].edges; j++)
            add_corners(decision, 2, of[0].vertex[of[0].edge[i][0]], of[0].vertex[of[0].edge[i][1]],
                        of[1].vertex[of[1].edge[j][0]], of[1].vertex[of[1].edge[j][1]]);
    begin_exact(decision);
}

/* ---- Intervals ---- */

/* The stack suffices (turn_decision.h); if it did not, the pair would have no verdict. */
static void push(struct turn_decision *decision, double lo, double hi)
{
    if (decision->count == TURN_STACK)
        decision->undecided = true;
    else if (lo < hi)
        decision->stack[decision->count++] = (struct turn_interval){lo, hi};
}

static double approach_contact(struct turn_decision *decision, double apart);

/* Half of short_interval, signed towards the known contact. */
static double margin(const struct turn_decision *decision)
{
    return decision->phase == TURN_LAST ? -0.5 * short_interval : 0.5 * short_interval;
}

/* Replaces all intervals by the interval between limit and the known contact. limit: no time before
 * it (TURN_LAST: after it) has a contact. approach: shortens the interval in doubles first. */
static void seek_end(struct turn_decision *decision, double limit, bool approach)
{
    const int late = decision->phase == TURN_LAST;
    decision->count = 0;
    decision->stage = TURN_LOOK;
    if (approach && decision->path.pair.usable && limit != decision->in[late])
        limit = approach_contact(decision, limit);
    if (fabs(decision->in[late] - limit) <= short_interval)
        decision->out[late] = late ? fmax(decision->out[1], limit) : fmin(decision->out[0], limit);
    else if (late)
        push(decision, decision->in[1], limit);
    else
        push(decision, limit, decision->in[0]);
}

/* Takes a contact at s into account. interval: the interval in progress, which contains s. Returns
 * whether the intervals have changed. */
static bool add_contact(struct turn_decision *decision, double s, enum fmb_verdict verdict,
                        struct turn_interval interval)
{
    const bool first = s < decision->in[0];
    if (s >= decision->in[0] && s <= decision->in[1] && decision->phase != TURN_VERDICT)
        return false;
    decision->in[0] = fmin(decision->in[0], s);
    decision->in[1] = fmax(decision->in[1], s);
    if (verdict == FMB_OVERLAPPING && !decision->overlaps) {
        decision->overlaps = true;
        decision->overlap = s;
    }
    if (decision->phase == TURN_VERDICT && decision->overlaps) {
        if (decision->want & (FMB_WANT_TIMES | FMB_WANT_BOX))
            decision->phase = TURN_FIRST;
        decision->count = 0;
        decision->stage = TURN_LOOK;
        if (first && decision->phase == TURN_FIRST)
            seek_end(decision, interval.lo, true);
        return true;
    }
    if (decision->phase == TURN_FIRST)
        seek_end(decision, interval.lo, false);
    if (decision->phase == TURN_LAST)
        seek_end(decision, interval.hi, false);
    return decision->phase != TURN_VERDICT;
}

static void pop(struct turn_decision *decision)
{
    decision->count--;
    decision->stage = TURN_LOOK;
}

/* Divides the interval in progress. The half that is next in order is pushed last. */
static void divide(struct turn_decision *decision, struct turn_interval interval)
{
    const double middle = cut_of(decision, interval);
    pop(decision);
    if (decision->phase == TURN_LAST)
        push(decision, interval.lo, middle);
    push(decision, middle, interval.hi);
    if (decision->phase != TURN_LAST)
        push(decision, interval.lo, middle);
}

/* Removes a short interval that contains an end of the contact, and extends out[] to it. */
static void enclose_end(struct turn_decision *decision, struct turn_interval interval)
{
    decision->out[0] = fmin(decision->out[0], interval.lo);
    decision->out[1] = fmax(decision->out[1], interval.hi);
    pop(decision);
}

static void give_up(struct turn_decision *decision)
{
    decision->undecided = true;
    pop(decision);
}

/* out := the direction, which doubles represent exactly. */
static void set_rounded(const struct turn_decision *decision, const struct turn_corners *corners,
                        struct turn_direction *out)
{
    mpz_t m[2][3];
    integer_each(m, sizeof m, mpz_init);
    turn_exact_direction(&decision->exact, corners, 1, m);
    out->of = corners->of;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out->m[0][axis] = mpz_get_d(m[0][axis]);
    integer_each(m, sizeof m, mpz_clear);
}

/* Removes the interval in progress, over which the frames are apart, and adds it to the proof if
 * one is wanted. direction: the direction that proves it, or NULL for the corners tried last. */
static void prove(struct turn_decision *decision, struct turn_interval interval,
                  const struct turn_direction *direction)
{
    struct turn_proof *proof = decision->proof;
    pop(decision);
    if (!proof || proof->count++ >= TURN_PROOF)
        return;
    struct turn_part *part = &proof->part[proof->count - 1];
    *part = (struct turn_part){.interval = interval};
    if (direction) {
        part->direction = *direction;
        return;
    }
    part->corners = decision->corners[decision->corner - 1];
    if (part->corners.vertex[0] == TURN_NEAREST) {
        proof->count = TURN_PROOF + 1;
        return;
    }
    if (part->corners.vertex[0] == TURN_ROUNDED) {
        set_rounded(decision, &part->corners, &part->direction);
        return;
    }
    part->sign = decision->sign[decision->corner - 1];
    turn_direction_of(decision->path.pair.view, &part->corners, &part->direction);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        part->direction.m[0][axis] *= part->sign;
}

/* Whether an interval is next to the known contact, on the side that the phase examines. */
static bool is_next_to_contact(const struct turn_decision *decision, struct turn_interval interval)
{
    return decision->phase == TURN_FIRST  ? interval.hi == decision->in[0]
           : decision->phase == TURN_LAST ? interval.lo == decision->in[1]
                                          : false;
}

/* Stores a part of an interval, around its middle, over which a direction separates the frames.
 * Next to the known contact, the interval is then divided at the end of this part. */
static void remember_apart(struct turn_decision *decision, struct turn_interval interval,
                           double middle, const struct turn_direction *direction)
{
    const bool next = is_next_to_contact(decision, interval);
    turn_part(&decision->path, direction, middle, &interval.lo, &interval.hi);
    if (!(turn_distance(&decision->path, direction, interval.lo, interval.hi) > 0))
        return;
    decision->apart[decision->apart_count++ % TURN_KNOWN] = interval;
    if (next)
        decision->split = decision->phase == TURN_FIRST ? interval.hi : interval.lo;
}

/* Removes the interval in progress if the frames are known to be apart over all of it; divides it
 * if they are known to be apart at its middle. Returns whether it did either. */
static bool skip_apart(struct turn_decision *decision, struct turn_interval interval)
{
    const double middle = cut_of(decision, interval);
    bool divides = false;
    for (unsigned k = 0; k < decision->apart_count && k < TURN_KNOWN; k++) {
        const struct turn_interval apart = decision->apart[k];
        if (apart.lo <= interval.lo && interval.hi <= apart.hi) {
            pop(decision);
            return true;
        }
        divides = divides || (apart.lo <= middle && middle <= apart.hi);
    }
    if (divides)
        divide(decision, interval);
    return divides;
}

/* Whether directions are to be tried before the exact verdict within an interval: the direction of
 * the last search may cease to separate the frames there. */
static bool may_cross(const struct turn_decision *decision, struct turn_interval interval)
{
    const struct turn_path *path = &decision->path;
    struct turn_direction direction[3];
    bool may = false;
    if (path->pair.rounded || !path->pair.usable || !is_next_to_contact(decision, interval) ||
        interval.hi - interval.lo <= 2 * short_interval || decision->fruitless >= LOOKS_FRUITLESS ||
        decision->split == cut_of(decision, interval))
        return false;
    const unsigned count = turn_directions(path, decision->nearest.direction, 0, direction);
    for (unsigned k = 0; k < count && !may; k++)
        may = turn_may_separate(path, &direction[k], 1, interval.lo, interval.hi);
    return may;
}

/* Removes the interval in progress if a direction of the last search separates the frames over it.
 * direction: receives these directions. Returns the greatest lower bound of the distance that one
 * of them proves. */
static double prove_in_doubles(struct turn_decision *decision, struct turn_interval interval,
                               struct turn_direction direction[3])
{
    const unsigned count =
        turn_directions(&decision->path, decision->nearest.direction, 0, direction);
    double most = -INFINITY;
    for (unsigned k = 0; k < count && !(most > 0); k++) {
        most = fmax(most, turn_distance(&decision->path, &direction[k], interval.lo, interval.hi));
        if (most > 0)
            prove(decision, interval, &direction[k]);
    }
    return most;
}

/* Examines a time within an interval, in doubles if possible. A short interval next to the known
 * contact encloses its end. */
static void look_at(struct turn_decision *decision, struct turn_interval interval)
{
    const double middle = cut_of(decision, interval);
    const bool is_short = interval.hi - interval.lo <= short_interval;
    struct turn_direction direction[3];
    if (is_short && is_next_to_contact(decision, interval)) {
        enclose_end(decision, interval);
        return;
    }
    const enum fmb_verdict verdict = verdict_in_doubles(decision, middle);
    if (decision->exhausted)
        return;
    if (verdict == 0) {
        if (may_cross(decision, interval))
            begin_corners(decision);
        else
            begin_programs(decision, middle, false);
        return;
    }
    if (verdict != FMB_SEPARATED && add_contact(decision, middle, verdict, interval))
        return;
    if (verdict == FMB_SEPARATED && decision->looked == middle && decision->sure) {
        const double bound = prove_in_doubles(decision, interval, direction);
        if (bound > 0)
            return;
        const bool beside = interval.hi == decision->in[0] || interval.lo == decision->in[1];
        const bool close = decision->path.pair.rounded && !decision->bounded && !beside &&
                           bound > -close_bound * decision->path.pair.reach;
        if (!is_short && !close) {
            if (!decision->proof)
                remember_apart(decision, interval, middle, &direction[0]);
            divide(decision, interval);
            return;
        }
    }
    if (decision->bounded)
        decision->exhausted = true;
    else if (decision->path.pair.rounded)
        begin_nearest(decision, middle);
    else
        begin_corners(decision);
}

/* Determines the exact verdict where the interval is divided: no direction separates the frames
 * over all of it. */
static void look_exactly(struct turn_decision *decision, struct turn_interval interval)
{
    const double middle = cut_of(decision, interval);
    const enum fmb_verdict verdict = known_at(decision, middle);
    if (verdict == 0)
        begin_programs(decision, middle, false);
    else if (verdict == FMB_SEPARATED || !add_contact(decision, middle, verdict, interval))
        divide(decision, interval);
}

/* If the frames rest on each other, they touch at both ends of the interval, and no other direction
 * is needed. So the ends are examined after the first TURN_REST. */
static void take_outcome(struct turn_decision *decision, enum turn_outcome outcome)
{
    if (outcome == TURN_REST && decision->outcome == TURN_OPEN)
        decision->stage = TURN_ENDS;
    if (outcome == TURN_APART || outcome == TURN_CLEAN || decision->outcome == TURN_OPEN)
        decision->outcome = outcome;
}

/* If the direction just tried separates the frames from the far end of an interval next to the
 * contact up to shortly before a root of its polynomial, and exact arithmetic proves it, stores the
 * times before and after the root. Of several roots, the one nearest to the contact is kept. */
static void take_crossing(struct turn_decision *decision, struct turn_interval interval)
{
    enum { TRIALS = 4 };
    const int late = decision->phase == TURN_LAST;
    const double in = decision->in[late];
    double value[6], lo = interval.lo, hi = interval.hi, step = margin(decision);
    if (!is_next_to_contact(decision, interval))
        return;
    integer_round(decision->exact.value, 6, value);
    if (!(value[late ? 5 : 0] > 0))
        return;
    turn_positive_part(value, late ? hi : lo, &lo, &hi);
    const double root = late ? lo : hi;
    for (int k = 0; k < TRIALS; k++, step *= 16) {
        const double before = root - step;
        if (!(interval.lo < before && before < interval.hi) ||
            fabs(decision->cleared - in) <= fabs(before - in))
            return;
        if (turn_exact_positive(&decision->exact, before, late)) {
            decision->cleared = before;
            decision->beyond = root + step;
            return;
        }
    }
}

/* Divides an interval over which no direction separates the frames. If a direction separates them
 * over a part of it, this part is removed, and the remainder is examined shortly after the root.
 * Otherwise the exact verdict comes first, unless it is known. */
static void divide_open(struct turn_decision *decision, struct turn_interval interval)
{
    const bool late = decision->phase == TURN_LAST;
    if (!isnan(decision->cleared)) {
        pop(decision);
        push(decision, late ? interval.lo : decision->cleared,
             late ? decision->cleared : interval.hi);
        decision->split = decision->beyond;
    } else {
        decision->fruitless += decision->looks - decision->began;
        decision->stage = TURN_EXACT;
    }
}

/* Whether begin_corners() lists all directions by vertices. In 2D it may leave some out, but the
 * direction towards the nearest point was not found to separate more pairs there. */
static bool lists_all(const struct support_pair *pair)
{
    bool all = true;
    for (int f = 0; f < 2; f++) {
        const struct support_view *view = &pair->view[f];
        all =
            all && (view->placed.frame->shape != FMB_HULL || view->vertices.count <= NEAR_VERTICES);
    }
    return all || pair->dim == 2;
}

static void try_corner(struct turn_decision *decision, struct turn_interval interval)
{
    struct turn_exact *exact = &decision->exact;
    const double middle = cut_of(decision, interval);
    const bool complete =
        decision->corners_at >= 0 || lists_all(&decision->path.pair) || !isnan(decision->cleared);
    enum turn_outcome outcome;
    if (exact->trial) {
        if (!turn_exact_step(exact, &outcome))
            return;
        take_outcome(decision, outcome);
        if (outcome == TURN_OPEN)
            take_crossing(decision, interval);
        return;
    }
    if (decision->corner < decision->corner_count && decision->outcome != TURN_APART &&
        (decision->outcome != TURN_CLEAN || decision->proof)) {
        for (int n = 0; n < CORNERS_STEP && decision->corner < decision->corner_count; n++) {
            const unsigned k = decision->corner++;
            if (!may_separate(decision, k, interval))
                continue;
            decision->looks += LOOKS_DIRECTION + turn_vertices(&decision->path) / VERTICES_OF_LOOK;
            turn_exact_try(exact, &decision->corners[k], decision->sign[k], interval.lo,
                           interval.hi);
            break;
        }
        return;
    }
    if (decision->outcome == TURN_APART)
        prove(decision, interval, NULL);
    else if (decision->outcome == TURN_OPEN && complete &&
             interval.hi - interval.lo > least_interval)
        divide_open(decision, interval);
    else if (decision->outcome == TURN_OPEN && decision->corners_at != interval.hi)
        /* Frames that touch at an end of the interval may separate in the direction there. Hulls of
         * which not all directions were listed may separate in the direction at the middle. */
        begin_nearest(decision, decision->corners_at == interval.lo ? interval.hi
                                : decision->corners_at == middle    ? interval.lo
                                                                    : middle);
    else
        decision->stage = TURN_ENDS;
}

/* Examines the ends of an interval in which the frames do not overlap, or of a shortest interval
 * that is undecided. */
static void look_at_ends(struct turn_decision *decision, struct turn_interval interval)
{
    const double middle = cut_of(decision, interval);
    const bool rests = decision->outcome == TURN_REST;
    const enum fmb_verdict at_lo = verdict_at(decision, interval.lo);
    const enum fmb_verdict at_hi = at_lo ? verdict_at(decision, interval.hi) : 0;
    const enum fmb_verdict inside = at_hi ? verdict_at(decision, middle) : 0;
    if (!inside)
        return;
    if (at_lo != FMB_SEPARATED && add_contact(decision, interval.lo, at_lo, interval))
        return;
    if (at_hi != FMB_SEPARATED && add_contact(decision, interval.hi, at_hi, interval))
        return;
    if (rests && decision->corner < decision->corner_count &&
        (at_lo == FMB_SEPARATED || at_hi == FMB_SEPARATED)) {
        decision->stage = TURN_CORNER;
        return;
    }
    const bool both = at_lo != FMB_SEPARATED && at_hi != FMB_SEPARATED;
    const bool any = at_lo != FMB_SEPARATED || at_hi != FMB_SEPARATED || inside != FMB_SEPARATED;
    if (decision->outcome == TURN_OPEN)
        give_up(decision);
    else if (both || (!rests && (any || !decision->proof))) {
        pop(decision);
    } else if (interval.hi - interval.lo > short_interval) {
        divide(decision, interval);
    } else if (any) {
        enclose_end(decision, interval);
    } else if (interval.hi - interval.lo > least_interval) {
        divide(decision, interval);
    } else {
        give_up(decision);
    }
}

/* ---- Ends of the contact ---- */

/* Returns a time near the time at which a direction ceases to separate the frames. Along it, they
 * are apart at `from` and not at `to`. The method of false position, in the Illinois variant. */
static double root_of(struct turn_path *path, const struct turn_direction *direction, double from,
                      double to)
{
    double apart = turn_along(path, direction, from), in = turn_along(path, direction, to);
    double z = from, last;
    int side = 0;
    for (int k = 0; k < 30 && apart > 0 && in < 0; k++) {
        last = z;
        z = from + (to - from) * (apart / (apart - in));
        if (fabs(z - last) <= 0x1p-45)
            break;
        const double value = turn_along(path, direction, z);
        if (value > 0) {
            from = z, apart = value;
            in *= side == 1 ? 0.5 : 1;
            side = 1;
        } else {
            to = z, in = value;
            apart *= side == -1 ? 0.5 : 1;
            side = -1;
        }
    }
    return z;
}

/* Searches at times ever farther from `from`, towards the known contact, until doubles give a
 * verdict. Returns the verdict, or 0. A contact becomes the known one. */
static enum fmb_verdict look_ahead(struct turn_decision *decision, double from, double step)
{
    enum { TRIALS = 6 };
    const int late = decision->phase == TURN_LAST;
    const double in = decision->in[late];
    enum fmb_verdict verdict = 0;
    for (int k = 0; k < TRIALS && verdict == 0 && fabs(step) < fabs(in - from); k++, step *= 16) {
        verdict = look(decision, from + step);
        if (verdict > FMB_SEPARATED)
            decision->in[late] = from + step;
    }
    return verdict;
}

static bool separates(const struct turn_decision *decision, const struct turn_direction *direction,
                      double x, double y)
{
    return turn_distance(&decision->path, direction, fmin(x, y), fmax(x, y)) > 0;
}

/* Used if turn_distance() is not positive up to the root. Returns the latest time up to which it is
 * (TURN_LAST: the earliest), or `apart`. May move in[]. */
static double approach_root(struct turn_decision *decision, const struct turn_direction *direction,
                            double apart, double root)
{
    const int late = decision->phase == TURN_LAST;
    double lo = fmin(apart, decision->in[late]), hi = fmax(apart, decision->in[late]);
    turn_part(&decision->path, direction, apart, &lo, &hi);
    const double before = late ? lo : hi, step = 3 * floor((root - before) * 0x1p50) * 0x1p-50;
    if (before == apart || !separates(decision, direction, apart, before))
        return apart;
    if (step * margin(decision) > 0)
        look_ahead(decision, before, step);
    return before;
}

/* Encloses the end of the contact that the phase determines as tightly as doubles can: moves in[],
 * and returns the time up to which the frames are apart. apart: such a time. Along the direction of
 * the last search, the frames are apart until a root of its polynomial. Shortly before the root,
 * this is proven; shortly after it, they meet or another direction separates them. */
static double approach_contact(struct turn_decision *decision, double apart)
{
    const int late = decision->phase == TURN_LAST;
    const double ahead = margin(decision);
    enum fmb_verdict verdict = look(decision, apart);
    if (verdict > FMB_SEPARATED)
        decision->in[late] = apart;
    for (int k = 0; k < DIRECTIONS_MAX && verdict == FMB_SEPARATED; k++) {
        const double in = decision->in[late];
        struct turn_direction direction[3];
        turn_directions(&decision->path, decision->nearest.direction, 0, direction);
        const double root = root_of(&decision->path, direction, apart, in);
        const double before = floor((root - ahead) * 0x1p50) * 0x1p-50;
        if (!((before - apart) * ahead > 0 && fabs(in - before) > short_interval))
            break;
        if (!separates(decision, direction, apart, before))
            return approach_root(decision, direction, apart, root);
        apart = before;
        verdict = look_ahead(decision, before, 2 * ahead);
        if (verdict != FMB_SEPARATED)
            break;
        turn_directions(&decision->path, decision->nearest.direction, 0, direction);
        if (!separates(decision, direction, apart, decision->looked))
            break;
        apart = decision->looked;
    }
    return apart;
}

/* ---- Answers ---- */

/* Returns the time of a fraction, rounded down or up; at most the duration. */
static double seconds(double s, double duration, bool up)
{
    const double time = s * duration, error = fma(s, duration, -time);
    if (s == 0 || s == 1)
        return time + 0.0;
    if (time >= 0x1p-900 && (up ? error <= 0 : error >= 0))
        return time;
    return fmin(nextafter(time, up ? INFINITY : 0), duration);
}

/* The pieces of a contact whose boxes are united. */
enum { BOX_PIECES = 16 };

/* Adds the intersection of the boxes of both frames over an interval to a box. A position passes
 * three roundings, and two more if the body has a velocity: 8 u of both ends cover these. An
 * orientation is off by 2.9 u |q| (turn_path.h), which MOTION_BOX_ERROR covers. */
static void add_box(const struct turn_path *path, double lo, double hi, double box[2][FMB_DIM_MAX])
{
    double low[2][FMB_DIM_MAX], high[2][FMB_DIM_MAX];
    for (int f = 0; f < 2; f++) {
        const struct fmb_frame *frame = path->pair.view[f].placed.frame;
        double q[2][4], position[2][FMB_DIM_MAX], own[2][FMB_DIM_MAX];
        turn_path_at(path, f, lo, q[0], position[0]);
        turn_path_at(path, f, hi, q[1], position[1]);
        frame_box(frame, own);
        motion_box_between((const double(*)[4]) q, (const double(*)[FMB_DIM_MAX]) position,
                           path->pair.dim, (const double(*)[FMB_DIM_MAX]) own, frame->reach, low[f],
                           high[f]);
        for (int axis = 0; axis < path->pair.dim; axis++) {
            const double off =
                0x1p-50 * (fabs(path->position[f][0][axis]) + fabs(path->position[f][1][axis]));
            low[f][axis] -= off;
            high[f][axis] += off;
        }
    }
    for (int axis = 0; axis < path->pair.dim; axis++)
        if (fmax(low[0][axis], low[1][axis]) > fmin(high[0][axis], high[1][axis]))
            return;
    for (int axis = 0; axis < path->pair.dim; axis++) {
        box[0][axis] = fmin(box[0][axis], fmax(low[0][axis], low[1][axis]) + 0.0);
        box[1][axis] = fmax(box[1][axis], fmin(high[0][axis], high[1][axis]) + 0.0);
    }
}

/* Sets the box of a pair in contact over [first, last]. */
static void set_box(const struct turn_path *path, double first, double last,
                    double box[2][FMB_DIM_MAX])
{
    memset(box, 0, 2 * sizeof *box);
    for (int axis = 0; axis < path->pair.dim; axis++)
        box[0][axis] = INFINITY, box[1][axis] = -INFINITY;
    for (int k = 0; k < BOX_PIECES; k++) {
        const double lo = first + (last - first) * k / BOX_PIECES;
        const double hi = k + 1 < BOX_PIECES ? first + (last - first) * (k + 1) / BOX_PIECES : last;
        add_box(path, lo, hi, box);
    }
}

/* Sets the gap of a pair that touches at s: 0, with s as time, and the direction of the greatest
 * lower bound among the directions of the last searches and, of frames without a radius, the
 * directions by vertices. */
static void set_touching_gap(struct turn_decision *decision, double s, struct fmb_gap *out)
{
    struct turn_path *path = &decision->path;
    struct turn_direction direction[6];
    double most = -INFINITY;
    memset(out, 0, sizeof *out);
    out->direction[0] = 1;
    out->time = seconds(s, decision->frames.duration, false);
    if (!path->pair.usable)
        return;
    look(decision, s);
    unsigned count = turn_directions(path, decision->nearest.direction, 0, direction);
    if (vec3_dot(decision->toward, decision->toward) > 0)
        count += turn_directions(path, decision->toward, 0, &direction[count]);
    decision->corner_count = 0;
    if (!path->pair.rounded)
        begin_corners(decision);
    for (unsigned k = 0; k < count + decision->corner_count; k++) {
        double n[FMB_DIM_MAX];
        if (k >= count)
            turn_direction_of(path->pair.view, &decision->corners[k - count], &direction[0]);
        for (int axis = 0; axis < FMB_DIM_MAX && k >= count; axis++)
            direction[0].m[0][axis] *= decision->sign[k - count];
        const struct turn_direction *of = &direction[k < count ? k : 0];
        const double value = turn_along(path, of, s);
        if (!(value > most))
            continue;
        most = value;
        turn_normal(path, of, n);
        const double length = sqrt(vec3_dot(n, n)) * (decision->swapped ? -1 : 1);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            out->direction[axis] = n[axis] / length + 0.0;
    }
}

/* Sets the answer that follows from the intervals. Returns whether there is a verdict. */
static bool set_answer(struct turn_decision *decision, struct fmb_answer *answer)
{
    const double duration = decision->frames.duration;
    const bool meets = decision->in[0] <= decision->in[1];
    const bool ends = decision->want & (FMB_WANT_TIMES | FMB_WANT_BOX);
    if (decision->undecided && (!decision->overlaps || ends))
        return false;
    answer->verdict = decision->overlaps ? FMB_OVERLAPPING : meets ? FMB_TOUCHING : FMB_SEPARATED;
    if (!meets)
        return true;
    const double first = fmin(decision->in[0], decision->out[0]);
    const double last = fmax(decision->in[1], decision->out[1]);
    answer->has_contact = decision->want & FMB_WANT_TIMES;
    answer->has_box = decision->want & FMB_WANT_BOX;
    if (answer->has_contact) {
        answer->contact[0] = seconds(first, duration, false);
        answer->contact[1] = seconds(last, duration, true);
    }
    if (answer->has_box)
        set_box(&decision->path, first, last, answer->box);
    return true;
}

/* Begins the next phase when the intervals of the current phase are done. */
static void next_phase(struct turn_decision *decision, struct fmb_answer *answer)
{
    if (decision->phase == TURN_FIRST) {
        decision->phase = TURN_LAST;
        decision->toward[0] = decision->toward[1] = decision->toward[2] = 0;
        seek_end(decision, 1, true);
        return;
    }
    const bool meets = decision->in[0] <= decision->in[1];
    const bool more = decision->want & FMB_WANT_GAP || (meets && decision->want & FMB_WANT_POINT);
    if (!set_answer(decision, answer)) {
        turn_end(decision);
    } else if (more && decision->bounded) {
        decision->exhausted = true;
    } else if (decision->want & FMB_WANT_GAP && answer->verdict == FMB_TOUCHING) {
        answer->has_gap = true;
        set_touching_gap(decision, decision->in[0], &answer->gap);
        decision->phase = TURN_POINT;
    } else if (decision->want & FMB_WANT_GAP) {
        turn_gap_begin(&decision->path, decision->swapped, !meets,
                       decision->overlaps ? decision->overlap : 0, decision->farthest,
                       &decision->gap);
        decision->phase = TURN_GAP;
    } else {
        decision->phase = TURN_POINT;
    }
}

static void step_gap(struct turn_decision *decision, struct fmb_answer *answer)
{
    const enum gap_outcome outcome = turn_gap_step(&decision->gap, &answer->gap);
    if (outcome == GAP_UNSURE)
        return;
    answer->has_gap = true;
    if (outcome == GAP_FAR)
        answer->gap = gap_none();
    decision->phase = TURN_POINT;
}

/* Begins the programs that compute the point, if it is wanted. */
static void begin_point(struct turn_decision *decision)
{
    if (decision->in[0] <= decision->in[1] && decision->want & FMB_WANT_POINT)
        begin_programs(decision, decision->overlaps ? decision->overlap : decision->in[0], true);
    else
        turn_end(decision);
}

static bool take_programs(struct turn_decision *decision, struct fmb_answer *answer)
{
    struct programs *programs = decision->programs;
    const double at = decision->path.pair.at;
    if (decision->phase == TURN_POINT) {
        answer->has_point = true;
        programs_nearest_point(programs, answer->point);
        answer->point[0] = seconds(at, decision->frames.duration, false);
        turn_end(decision);
        return true;
    }
    const enum fmb_verdict verdict = programs_proof(programs)->verdict;
    const bool rounded = decision->path.pair.rounded;
    if (rounded || decision->stage != TURN_CORNER)
        remember(decision, at, verdict);
    if (rounded || decision->stage == TURN_CORNER) {
        begin_exact(decision);
        turn_exact_take(&decision->exact, programs_proof(programs));
        take_nearest(decision, programs_proof(programs));
        decision->nearest_at = at;
        if (decision->stage == TURN_CORNER)
            list_nearest(decision);
    }
    programs_end(programs, NULL);
    decision->programs = NULL;
    return false;
}

/* Performs the next piece of work. Returns whether it may have been long. */
static bool work_once(struct turn_decision *decision, struct fmb_answer *answer)
{
    if (decision->phase == TURN_GAP) {
        step_gap(decision, answer);
        return true;
    }
    if (decision->phase == TURN_POINT) {
        begin_point(decision);
        return true;
    }
    if (decision->looks > LOOKS_MAX) {
        decision->undecided = true;
        decision->count = 0;
    }
    if (decision->count == 0) {
        next_phase(decision, answer);
        return false;
    }
    const struct turn_interval interval = decision->stack[decision->count - 1];
    const bool exact = decision->stage == TURN_CORNER;
    if (decision->stage == TURN_LOOK && interval.hi - interval.lo > short_interval &&
        skip_apart(decision, interval))
        return false;
    if (decision->stage == TURN_LOOK)
        look_at(decision, interval);
    else if (decision->stage == TURN_EXACT)
        look_exactly(decision, interval);
    else if (exact)
        try_corner(decision, interval);
    else
        look_at_ends(decision, interval);
    return exact;
}

bool turn_step(struct turn_decision *decision, struct fmb_answer *answer)
{
    const unsigned limit = decision->bounded ? LOOKS_BOUNDED : decision->looks + LOOKS_STEP;
    if (decision->programs)
        return programs_step(decision->programs) && take_programs(decision, answer);
    while (decision->looks < limit && !decision->exhausted && decision->phase != TURN_COMPLETE)
        if (work_once(decision, answer) || decision->programs)
            break;
    return decision->phase == TURN_COMPLETE;
}

/* Returns whether two balls, centred at the positions and containing the frames, are apart over the
 * whole window. The difference D of the positions is linear in s, so for a fixed n, n . D is least
 * at an end of the window. n is the shortest D, up to rounding. A term of D passes three roundings,
 * its product with n four, |n| and the reaches four: 2^-48 of the magnitudes covers each. If n . D
 * is finite, no product has overflowed. If n . D or n . n is small, underflow may matter, and the
 * function returns false. */
static bool is_far(const struct frame_pair *frames)
{
    const struct placed_frame *const of[2] = {&frames->a, &frames->b};
    double end[2][FMB_DIM_MAX] = {{0}}, n[FMB_DIM_MAX], most = 0, along = 0, square = 0;
    for (int f = 0; f < 2; f++)
        for (int axis = 0; axis < of[f]->frame->dim; axis++) {
            const struct fmb_placement *placement = of[f]->placement;
            const double p = placement->position[axis];
            const double path = placement->velocity[axis] * frames->duration;
            const double late = placement->end_count ? placement->end_position[axis] : p + path;
            end[0][axis] += f ? p : -p;
            end[1][axis] += f ? late : -late;
            most += fabs(p) + fabs(late) + fabs(path);
        }
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const double way = end[1][axis] - end[0][axis];
        along -= way * end[0][axis];
        square += way * way;
    }
    const double s = square > 0 ? fmin(fmax(along / square, 0), 1) : 0;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        n[axis] = (1 - s) * end[0][axis] + s * end[1][axis];
    const double least = fmin(vec3_dot(n, end[0]), vec3_dot(n, end[1]));
    const double reach = frames->a.frame->reach + frames->b.frame->reach + 0x1p-48 * most;
    const double length = sqrt(vec3_dot(n, n));
    return length > 0x1p-200 && least > 0x1p-400 && least < INFINITY &&
           least > reach * (1 + 0x1p-48) * length;
}

bool turn_begin(const struct frame_pair *frames, unsigned want, double farthest, bool bounded,
                struct turn_decision *out, struct turn_proof *proof, struct fmb_answer *answer)
{
    out->proof = proof;
    if (proof)
        proof->count = 0;
    out->swapped = support_order(frames, &out->frames);
    out->want = want;
    out->farthest = farthest;
    out->bounded = bounded;
    out->overlaps = out->undecided = out->has_exact = out->sure = false;
    out->exhausted = bounded && want & FMB_WANT_GAP; /* which takes hundreds of searches */
    out->phase = TURN_VERDICT;
    out->stage = TURN_LOOK;
    out->programs = NULL;
    out->exact.trial = NULL;
    out->looks = out->next_known = out->apart_count = out->fruitless = 0;
    out->looked = out->nearest_at = out->split = -1;
    out->toward[0] = out->toward[1] = out->toward[2] = 0;
    memset(out->nearest.direction, 0, sizeof out->nearest.direction);
    for (int k = 0; k < TURN_KNOWN; k++)
        out->known[k].at = -1;
    out->in[0] = out->out[0] = INFINITY;
    out->in[1] = out->out[1] = -INFINITY;
    out->count = 0;
    if (!proof && !(want & FMB_WANT_GAP) && is_far(&out->frames))
        return turn_step(out, answer);
    push(out, 0, 1);
    turn_path_set(&out->frames, &out->path);
    return turn_step(out, answer);
}
