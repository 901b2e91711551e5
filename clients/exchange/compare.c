#include "compare.h"

#include "big_endian.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const difference_name[DIFFERENT_KINDS] = {
    [DIFFERENT_STATUS] = "status",
    [DIFFERENT_VERDICT] = "verdict",
    [DIFFERENT_INTERVAL] = "interval",
    [DIFFERENT_BOX] = "box",
    [DIFFERENT_POINT] = "point",
    [DIFFERENT_GAP] = "gap",
    [DIFFERENT_CERTIFICATE] = "certificate",
    [DIFFERENT_SCENE] = "scene",
};

/* ---- Numbers ---- */

/* Whether each number has the same bits in both lists or differs by at most limit. */
static bool within(const double *a, const double *b, int count, double limit)
{
    for (int i = 0; i < count; i++)
        if (memcmp(&a[i], &b[i], sizeof *a) != 0 && !(fabs(a[i] - b[i]) <= limit))
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

/* The reach of a body is 0 if its geometry is not known, or the engine refuses it. */
static double largest_coordinate(const struct logged_query *query, double duration)
{
    double most = 0;
    const struct query_placement *placement = query->placement;
    for (int32_t i = 0; i < query->placement_count; i++) {
        const struct body_view *view = &placement[i].body;
        struct owned_scene memory = {.dim = 0};
        const struct fmb_body *body = view->frame_count > 0 ? body_of_view(view, &memory) : NULL;
        const double reach = body && isfinite(body->reach) ? body->reach : 0;
        scene_clear(&memory);
        for (int k = 0; k < FMB_DIM_MAX; k++) {
            const double *position = &placement[i].placed.position[k];
            const double moved =
                placement[i].velocity_count ? placement[i].placed.velocity[k] * duration : 0;
            const double end = placement[i].placed.end_count ? placement[i].placed.end_position[k]
                                                             : *position + moved;
            const double ends[2] = {fabs(*position) + reach, fabs(end) + reach};
            most = largest(ends, 2, most);
        }
    }
    return most;
}

/* ---- Answers ---- */

/* The limits within which numbers may differ. */
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
    if (a->has_point && b->has_point && within(a->point, b->point, 1, limits->time) &&
        within(a->point + 1, b->point + 1, dim, limits->length))
        parts &= ~(unsigned) FMB_WANT_POINT;
    if (a->has_gap && b->has_gap && within(a->gap.bounds, b->gap.bounds, 2, limits->length))
        parts &= ~(unsigned) FMB_WANT_GAP;
    return parts;
}

/* Finds the first difference of the two sides. Returns false if there is none. */
static bool find_difference(const struct limits *limits, struct difference *out)
{
    const struct fmb_client_answer *then = &out->then, *now = &out->now;
    const unsigned parts = parts_apart(limits, out->dim, &then->answer, &now->answer);
    const char *a = then->certificate, *b = now->certificate;
    const bool certificates = a && b ? strcmp(a, b) != 0 : a != b;
    const bool differs[DIFFERENT_KINDS] = {
        [DIFFERENT_STATUS] = then->status != now->status,
        [DIFFERENT_VERDICT] = then->answer.verdict != now->answer.verdict,
        [DIFFERENT_INTERVAL] = parts & FMB_WANT_TIMES,
        [DIFFERENT_BOX] = parts & FMB_WANT_BOX,
        [DIFFERENT_POINT] = parts & FMB_WANT_POINT,
        [DIFFERENT_GAP] = parts & FMB_WANT_GAP,
        [DIFFERENT_CERTIFICATE] = certificates && !(limits->tolerance > 0)};
    int kind = 0;
    while (kind < DIFFERENT_KINDS && !differs[kind])
        kind++;
    out->kind = (enum difference_kind)(kind < DIFFERENT_KINDS ? kind : 0);
    return kind < DIFFERENT_KINDS;
}

/* ---- Exchanges ---- */

/* Returns an answer as it is compared: a box, point or gap of another dimension than the query's is
 * ignored, and a scene's pairs without a verdict have no status of their own. */
static struct fmb_client_answer compared(const struct exchange *exchange,
                                         const struct fmb_client_answer *answer, int dim)
{
    struct fmb_client_answer out = *answer;
    out.answer.has_box = answer->answer.has_box && exchange->head->dim == dim;
    out.answer.has_point = answer->answer.has_point && exchange->head->dim == dim;
    out.answer.has_gap = answer->answer.has_gap && exchange->head->dim == dim;
    if (!exchange->is_pair)
        out.status = FMB_OK;
    return out;
}

static struct difference difference_of(struct exchange *const both[2],
                                       const struct exchange_pair *pair)
{
    const struct logged_query *query = both[1]->query;
    const int dim = query->placement[0].body.dim == 2 ? 2 : 3;
    struct difference difference = {
        .dim = dim,
        .placement = {pair->a, pair->b},
        .names_frames = {both[0]->head->names_frames, both[1]->head->names_frames},
        .then = compared(both[0], &pair->answer[0], dim),
        .now = compared(both[1], &pair->answer[1], dim)};
    for (int i = 0; i < 2; i++)
        if (difference.placement[i] < (unsigned) query->placement_count)
            difference.body_id[i] = query->placement[difference.placement[i]].placed.id;
    return difference;
}

/* Compares the pairs that both results answer. */
static enum replay_outcome compare_answers(const struct compare_options *options,
                                           struct exchange *const both[2], difference_sink *sink,
                                           void *user)
{
    const struct logged_query *query = both[1]->query;
    const double duration =
        query->kind == LOG_PAIR_QUERY ? query->pair.duration : query->scene.duration;
    struct limits limits = {.tolerance = options->tolerance};
    enum replay_outcome outcome = REPLAY_SAME;
    struct exchange_pair pair;
    if (limits.tolerance > 0) {
        limits.time = limits.tolerance * duration;
        limits.length = limits.tolerance * largest_coordinate(query, duration);
    }
    while (exchange_next_of_both(both, &pair)) {
        struct difference difference = difference_of(both, &pair);
        if (pair.answered[0] && pair.answered[1] && find_difference(&limits, &difference)) {
            sink(user, &difference);
            outcome = REPLAY_DIFFERENT;
        }
    }
    return outcome;
}

/* Writes how the scene of a result differs from the scene of the query. Returns false if it does
 * not, or if this is not known. */
static bool scenes_differ(const struct exchange *then, const struct exchange *now,
                          char out[COMPARE_DETAIL_MAX])
{
    if (then->query != now->query && scene_change(then, now, out))
        return true;
    *out = 0;
    if (now->is_pair) {
        const int64_t *a = then->result->pair.body_id, *b = now->result->pair.body_id;
        if (then->by_order && (a[0] != b[0] || a[1] != b[1]))
            snprintf(out, COMPARE_DETAIL_MAX,
                     "the recording has the bodies %" PRId64 " and %" PRId64 ", the query %" PRId64
                     " and %" PRId64,
                     a[0], a[1], b[0], b[1]);
    } else if (then->head->status == FMB_OK && now->head->status == FMB_OK) {
        const struct scene_query *query = &now->query->scene;
        if (then->by_order && then->end_pair != now->end_pair)
            snprintf(out, COMPARE_DETAIL_MAX,
                     "the recording answers %" PRId32 " pairs, the query has %" PRId64,
                     then->end_pair - query->first_pair,
                     query_pair_count(query) - query->first_pair);
        else if (!then->fits || !now->fits)
            snprintf(out, COMPARE_DETAIL_MAX, "a result is of other pairs than its query");
    }
    return *out;
}

enum replay_outcome compare_exchanges(const struct compare_options *options, struct exchange *then,
                                      struct exchange *now, difference_sink *sink, void *user)
{
    struct exchange *const both[2] = {then, now};
    char detail[COMPARE_DETAIL_MAX];
    struct difference whole = {.whole = true, .dim = 3};
    exchange_begin(then);
    exchange_begin(now);
    whole.then.status = then->head->status;
    whole.now.status = now->head->status;
    if (then->head->status == FMB_UNKNOWN_BODY)
        return REPLAY_UNKNOWN;
    if (then->head->status == FMB_BUSY || now->head->status == FMB_BUSY)
        return REPLAY_BUSY;
    if (now->head->status == FMB_UNKNOWN_BODY)
        return REPLAY_UNDEFINED;
    if (scenes_differ(then, now, detail)) {
        whole.kind = DIFFERENT_SCENE;
        whole.detail = detail;
    } else if (now->is_pair || (then->head->status == FMB_OK && now->head->status == FMB_OK)) {
        return compare_answers(options, both, sink, user);
    } else if (then->head->status == now->head->status) {
        return REPLAY_SAME;
    } else {
        whole.kind = DIFFERENT_STATUS;
    }
    sink(user, &whole);
    return REPLAY_DIFFERENT;
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
