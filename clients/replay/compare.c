#include "compare.h"

#include "allocate.h"
#include "big_endian.h"
#include "geometry.h"
#include "logged_query.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const difference_name[DIFFERENT_KINDS] = {
    [DIFFERENT_STATUS] = "status",     [DIFFERENT_VERDICT] = "verdict",
    [DIFFERENT_INTERVAL] = "interval", [DIFFERENT_BOX] = "box",
    [DIFFERENT_GAP] = "gap",           [DIFFERENT_CERTIFICATE] = "certificate",
    [DIFFERENT_SCENE] = "scene",
};

/* ---- Numbers ---- */

static bool same_bits(const double *a, const double *b, int count)
{
    return memcmp(a, b, (size_t) count * sizeof *a) == 0;
}

/* Whether each number has the same bits in both lists or differs by at most limit. */
static bool within(const double *a, const double *b, int count, double limit)
{
    for (int i = 0; i < count; i++)
        if (!same_bits(&a[i], &b[i], 1) && !(fabs(a[i] - b[i]) <= limit))
            return false;
    return true;
}

/* The largest of `most` and the finite magnitudes. */
static double largest(const double *number, int count, double most)
{
    for (int i = 0; i < count; i++)
        most = isfinite(number[i]) ? fmax(most, fabs(number[i])) : most;
    return most;
}

/* ---- The largest coordinate of a query ---- */

/* The largest distance of a corner from the origin of the body: of a vertex, or at most |origin|
 * and the components together on each axis. */
static double frame_reach(int dim, const struct geometry_frame *frame, const double *number)
{
    double most = 0, axis[FMB_DIM_MAX] = {0};
    for (size_t i = 0; i < frame->count; i += (size_t) dim) {
        double distance = 0;
        for (int k = 0; k < dim; k++) {
            axis[k] = frame->by_vertices ? fabs(number[i + (size_t) k])
                                         : axis[k] + fabs(number[i + (size_t) k]);
            distance = hypot(distance, axis[k]); /* squares could overflow */
        }
        most = fmax(most, distance);
    }
    return most;
}

/* 0: the geometry is not known. */
static double body_reach(const struct body_view *body)
{
    double most = 0, *number = NULL;
    size_t capacity = 0;
    struct geometry_frame frame;
    for (struct geometry_reader reader = geometry_begin(body); geometry_next(&reader, &frame);) {
        number = allocate_grow(number, &capacity, frame.count, sizeof *number);
        geometry_numbers(&frame, number);
        const double reach = frame_reach(body->dim, &frame, number);
        most = largest(&reach, 1, most);
    }
    free(number);
    return most;
}

static double largest_coordinate(const struct logged_query *query, double duration)
{
    double most = 0;
    const struct query_placement *placement = query->placement;
    for (int32_t i = 0; i < query->placement_count; i++) {
        const double reach = body_reach(&placement[i].body);
        for (int k = 0; k < FMB_DIM_MAX; k++) {
            const double *position = &placement[i].placed.position[k];
            const double moved =
                placement[i].velocity_count ? placement[i].placed.velocity[k] * duration : 0;
            const double ends[2] = {fabs(*position) + reach, fabs(*position + moved) + reach};
            most = largest(ends, 2, most);
        }
    }
    return most;
}

/* ---- Answers ---- */

/* What numbers may differ by. */
struct limits {
    double tolerance; /* 0: not at all */
    double time, length;
};

/* Returns the parts that differ by more than the limits: a sum of FMB_WANT_ bits. */
static unsigned parts_apart(const struct limits *limits, int dim, const struct fmb_answer *a,
                            const struct fmb_answer *b)
{
    unsigned parts = query_parts_that_differ(a, b);
    if (!(limits->tolerance > 0))
        return parts;
    if (a->has_contact && b->has_contact && within(a->contact, b->contact, 2, limits->time))
        parts &= ~(unsigned) FMB_WANT_TIMES;
    if (a->has_box && b->has_box && within(a->box[0], b->box[0], dim, limits->length) &&
        within(a->box[1], b->box[1], dim, limits->length))
        parts &= ~(unsigned) FMB_WANT_BOX;
    if (a->has_gap && b->has_gap && within(a->gap.bounds, b->gap.bounds, 2, limits->length))
        parts &= ~(unsigned) FMB_WANT_GAP;
    return parts;
}

static bool same_certificates(const struct limits *limits, const char *a, const char *b)
{
    if (limits->tolerance > 0 || a == b)
        return true;
    return a && b && strcmp(a, b) == 0;
}

/* Finds the first difference of the two sides. Returns false if there is none. */
static bool find_difference(const struct limits *limits, struct difference *out)
{
    const struct difference_side *then = &out->then, *now = &out->now;
    const unsigned parts = parts_apart(limits, out->dim, &then->answer, &now->answer);
    const bool differs[DIFFERENT_KINDS] = {
        [DIFFERENT_STATUS] = then->status != now->status,
        [DIFFERENT_VERDICT] = then->answer.verdict != now->answer.verdict,
        [DIFFERENT_INTERVAL] = parts & FMB_WANT_TIMES,
        [DIFFERENT_BOX] = parts & FMB_WANT_BOX,
        [DIFFERENT_GAP] = parts & FMB_WANT_GAP,
        [DIFFERENT_CERTIFICATE] = !same_certificates(limits, then->certificate, now->certificate)};
    int kind = 0;
    while (kind < DIFFERENT_KINDS && !differs[kind])
        kind++;
    out->kind = (enum difference_kind)(kind < DIFFERENT_KINDS ? kind : 0);
    return kind < DIFFERENT_KINDS;
}

/* The outcome for two statuses if one or both are transient. */
static enum replay_outcome transient_outcome(int32_t then, int32_t now)
{
    if (then == FMB_UNKNOWN_BODY)
        return REPLAY_UNKNOWN;
    return then == FMB_BUSY || now == FMB_BUSY ? REPLAY_BUSY : REPLAY_UNDEFINED;
}

static int dim_of(const struct query_placement *placement)
{
    return placement->body.dim == 2 ? 2 : 3;
}

/* A box or gap of another dimension than the query's is ignored. */
static struct fmb_answer answer_of(const struct fmb_answer *answer, int dim, int query_dim)
{
    struct fmb_answer out = *answer;
    out.has_box = answer->has_box && dim == query_dim;
    out.has_gap = answer->has_gap && dim == query_dim;
    return out;
}

/* ---- Results ---- */

static struct difference_side side_of(const struct replayed_side *side,
                                      const struct logged_result *result, int dim)
{
    const bool is_pair = result->kind == LOG_PAIR_QUERY;
    return (struct difference_side){.status = is_pair ? result->head.status : FMB_OK,
                                    .answer = answer_of(&side->answer, side->dim, dim),
                                    .certificate = is_pair ? result->pair.certificate : NULL,
                                    .names_frames = result->head.names_frames};
}

static struct difference difference_of(const struct replayed *replayed,
                                       const struct replayed_pair *pair)
{
    const struct query_placement *placement = replayed->query->placement;
    const int32_t count = replayed->query->placement_count;
    const int dim = dim_of(&placement[0]);
    struct difference difference = {.dim = dim,
                                    .placement = {pair->a, pair->b},
                                    .then = side_of(&pair->then, replayed->then, dim),
                                    .now = side_of(&pair->now, replayed->now, dim)};
    for (int f = 0; f < 2; f++)
        if (difference.placement[f] < (unsigned) count)
            difference.body_id[f] = placement[difference.placement[f]].placed.id;
    return difference;
}

/* Compares the pairs that both results answer; of a pair query also the statuses. */
static enum replay_outcome compare_answers(const struct compare_options *options,
                                           const struct replayed *replayed, difference_sink *sink,
                                           void *user)
{
    const struct logged_query *query = replayed->query;
    const bool is_pair = query->kind == LOG_PAIR_QUERY;
    const double duration = is_pair ? query->pair.duration : query->scene.duration;
    struct limits limits = {.tolerance = options->tolerance};
    enum replay_outcome outcome = REPLAY_SAME;
    struct replayed_pairs pairs;
    struct replayed_pair pair;
    if (limits.tolerance > 0) {
        limits.time = limits.tolerance * duration;
        limits.length = limits.tolerance * largest_coordinate(query, duration);
    }
    replayed_pairs_begin(replayed, &pairs);
    while (replayed_pairs_next(&pairs, &pair)) {
        struct difference difference = difference_of(replayed, &pair);
        if ((is_pair || (pair.then.answered && pair.now.answered)) &&
            find_difference(&limits, &difference)) {
            sink(user, &difference);
            outcome = REPLAY_DIFFERENT;
        }
    }
    return outcome;
}

/* Writes how the scene of a result differs from that of the query. Returns false if it does not, or
 * that is not known. */
static bool scenes_differ(const struct replayed *replayed, char *out, size_t size)
{
    const struct scene_query *query = &replayed->query->scene;
    const struct scene_result *then = &replayed->then->scene, *now = &replayed->now->scene;
    *out = 0;
    if (replayed->change) {
        snprintf(out, size, "%s", replayed->change);
    } else if (replayed->query->kind == LOG_PAIR_QUERY) {
        const int64_t *a = replayed->then->pair.body_id, *b = replayed->now->pair.body_id;
        if (replayed->by_order && (a[0] != b[0] || a[1] != b[1]))
            snprintf(out, size,
                     "the recording has the bodies %" PRId64 " and %" PRId64 ", the query %" PRId64
                     " and %" PRId64,
                     a[0], a[1], b[0], b[1]);
    } else if (then->status == FMB_OK && now->status == FMB_OK) {
        if (replayed->by_order && then->end_pair != now->end_pair)
            snprintf(out, size, "the recording answers %" PRId32 " pairs, the query has %" PRId64,
                     then->end_pair - query->first_pair,
                     query_pair_count(query) - query->first_pair);
        else if (!logged_result_fits(query, then) || !logged_result_fits(query, now))
            snprintf(out, size, "a result is of other pairs than its query");
    }
    return *out;
}

/* Compares the statuses of a scene, and the pairs if both are OK. */
static enum replay_outcome compare_scenes(const struct compare_options *options,
                                          const struct replayed *replayed, difference_sink *sink,
                                          void *user)
{
    const int32_t then = replayed->then->head.status;
    const int32_t now = replayed->now->head.status;
    if (then == FMB_OK && now == FMB_OK)
        return compare_answers(options, replayed, sink, user);
    if (then == now)
        return REPLAY_SAME;
    sink(user, &(struct difference){.kind = DIFFERENT_STATUS,
                                    .whole = true,
                                    .dim = 3,
                                    .then = {.status = then},
                                    .now = {.status = now}});
    return REPLAY_DIFFERENT;
}

enum replay_outcome compare_results(const struct compare_options *options,
                                    const struct replayed *replayed, difference_sink *sink,
                                    void *user)
{
    const int32_t then = replayed->then->head.status;
    const int32_t now = replayed->now->head.status;
    char detail[COMPARE_DETAIL_MAX];
    if (logged_status_is_transient(then) || logged_status_is_transient(now))
        return transient_outcome(then, now);
    if (scenes_differ(replayed, detail, sizeof detail)) {
        sink(user, &(struct difference){
                       .kind = DIFFERENT_SCENE, .whole = true, .dim = 3, .detail = detail});
        return REPLAY_DIFFERENT;
    }
    return replayed->query->kind == LOG_SCENE_QUERY
               ? compare_scenes(options, replayed, sink, user)
               : compare_answers(options, replayed, sink, user);
}

/* ---- Encoded results ----
 *
 * Both types begin with the fingerprint (8 bytes), the echoed utime, client id and sequence number
 * (8 each) and the server id, and end with compute_ns. Then come, of a scene, the status, and of a
 * pair the ids of the bodies (8 each), their handles and the status. */

enum { TYPE_BYTES = 8, SERVER_END = 40, COMPUTE_BYTES = 8 };
enum { SCENE_STATUS = SERVER_END, PAIR_STATUS = SERVER_END + 2 * 8 + 2 * HANDLE_BYTES };

bool compare_bytes_same(enum log_kind kind, const unsigned char *then, size_t then_size,
                        const unsigned char *now, size_t now_size)
{
    const size_t status = kind == LOG_PAIR_QUERY ? PAIR_STATUS : SCENE_STATUS;
    return then_size == now_size && now_size >= status + 4 + COMPUTE_BYTES &&
           memcmp(then, now, TYPE_BYTES) == 0 &&
           memcmp(then + SERVER_END, now + SERVER_END, now_size - SERVER_END - COMPUTE_BYTES) ==
               0 &&
           !logged_status_is_transient((int32_t) big_endian_32(now + status));
}
