#include "compare.h"

#include "big_endian.h"
#include "logged_query.h"

#include <math.h>
#include <string.h>

const char *const difference_name[DIFFERENT_KINDS] = {
    [DIFFERENT_STATUS] = "status",     [DIFFERENT_VERDICT] = "verdict",
    [DIFFERENT_INTERVAL] = "interval", [DIFFERENT_BOX] = "box",
    [DIFFERENT_GAP] = "gap",           [DIFFERENT_CERTIFICATE] = "certificate",
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

enum { BOX_NUMBERS = 2 * FMB_DIM_MAX };

/* ---- Answers ---- */

/* Whether parts that both answers have are equal within the tolerance, which is not 0. */

static bool close_boxes(double tolerance, int dim, const struct fmb_answer *a,
                        const struct fmb_answer *b)
{
    const double most = largest(a->box[0], BOX_NUMBERS,
                                largest(b->box[0], BOX_NUMBERS, 0)); /* numbers beyond dim are 0 */
    return within(a->box[0], b->box[0], dim, tolerance * most) &&
           within(a->box[1], b->box[1], dim, tolerance * most);
}

static double largest_of_gap(const struct fmb_gap *gap, double most)
{
    return largest(gap->witness[0], BOX_NUMBERS, largest(gap->bounds, 2, most));
}

static bool close_gaps(double tolerance, const struct fmb_gap *a, const struct fmb_gap *b)
{
    const double most = largest_of_gap(a, largest_of_gap(b, 0));
    return within(a->bounds, b->bounds, 2, tolerance * most);
}

/* Returns the parts that differ by more than the tolerance: a sum of FMB_WANT_ bits. */
static unsigned parts_apart(const struct compare_options *options, double duration, int dim,
                            const struct fmb_answer *a, const struct fmb_answer *b)
{
    const double tolerance = options->tolerance;
    unsigned parts = query_parts_that_differ(a, b);
    if (!(tolerance > 0))
        return parts;
    if (a->has_contact && b->has_contact && within(a->contact, b->contact, 2, tolerance * duration))
        parts &= ~(unsigned) FMB_WANT_TIMES;
    if (a->has_box && b->has_box && close_boxes(tolerance, dim, a, b))
        parts &= ~(unsigned) FMB_WANT_BOX;
    if (a->has_gap && b->has_gap && close_gaps(tolerance, &a->gap, &b->gap))
        parts &= ~(unsigned) FMB_WANT_GAP;
    return parts;
}

static bool same_certificates(const struct compare_options *options, const char *a, const char *b)
{
    if (options->tolerance > 0 || a == b)
        return true;
    return a && b && strcmp(a, b) == 0;
}

/* Finds the first difference of the two sides. Returns false if there is none. */
static bool find_difference(const struct compare_options *options, double duration,
                            struct difference *out)
{
    const struct fmb_answer *then = &out->then.answer, *now = &out->now.answer;
    const unsigned parts = parts_apart(options, duration, out->dim, then, now);
    if (out->then.status != out->now.status)
        out->kind = DIFFERENT_STATUS;
    else if (then->verdict != now->verdict)
        out->kind = DIFFERENT_VERDICT;
    else if (parts & FMB_WANT_TIMES)
        out->kind = DIFFERENT_INTERVAL;
    else if (parts & FMB_WANT_BOX)
        out->kind = DIFFERENT_BOX;
    else if (parts & FMB_WANT_GAP)
        out->kind = DIFFERENT_GAP;
    else if (!same_certificates(options, out->then.certificate, out->now.certificate))
        out->kind = DIFFERENT_CERTIFICATE;
    else
        return false;
    return true;
}

bool compare_status_is_transient(int32_t status)
{
    return status == FMB_BUSY || status == FMB_UNKNOWN_BODY;
}

/* The outcome for two statuses if one or both are transient. */
static enum replay_outcome transient_outcome(int32_t then, int32_t now)
{
    if (then == FMB_UNKNOWN_BODY)
        return REPLAY_UNKNOWN;
    return then == FMB_BUSY || now == FMB_BUSY ? REPLAY_BUSY : REPLAY_UNDEFINED;
}

static int dim_of(const struct placement *placement)
{
    return placement->dim == 2 ? 2 : 3;
}

/* A box or gap of another dimension than the query's is ignored. */
static struct fmb_answer answer_of(const struct fmb_answer *answer, int dim, int query_dim)
{
    struct fmb_answer out = *answer;
    out.has_box = answer->has_box && dim == query_dim;
    out.has_gap = answer->has_gap && dim == query_dim;
    return out;
}

/* ---- Pairs ---- */

static struct difference_side side_of_pair(const struct pair_result *result, int dim)
{
    return (struct difference_side){.status = result->status,
                                    .answer = answer_of(&result->answer, result->dim, dim),
                                    .certificate = result->certificate,
                                    .names_frames = result->names_frames};
}

enum replay_outcome compare_pairs(const struct compare_options *options,
                                  const struct pair_query *query, const struct pair_result *then,
                                  const struct pair_result *now, difference_sink *sink, void *user)
{
    if (compare_status_is_transient(then->status) || compare_status_is_transient(now->status))
        return transient_outcome(then->status, now->status);
    const int dim = dim_of(&query->placement[0]);
    struct difference difference = {
        .body_id = {query->placement[0].body_id, query->placement[1].body_id},
        .placement = {0, 1},
        .dim = dim,
        .then = side_of_pair(then, dim),
        .now = side_of_pair(now, dim)};
    if (!find_difference(options, query->duration, &difference))
        return REPLAY_SAME;
    sink(user, &difference);
    return REPLAY_DIFFERENT;
}

/* ---- Scenes ---- */

static struct difference difference_of(const struct replayed *scene,
                                       const struct replayed_pair *pair)
{
    const struct scene_query *query = scene->scene;
    struct difference difference = {.dim = dim_of(&query->placement[0]),
                                    .placement = {pair->a, pair->b},
                                    .then.names_frames = scene->scene_then->names_frames,
                                    .now.names_frames = scene->scene_now->names_frames};
    for (int f = 0; f < 2; f++) {
        const unsigned i = difference.placement[f];
        if (i < (unsigned) query->placement_count && i < QUERY_PLACEMENTS_MAX)
            difference.body_id[f] = query->placement[i].body_id;
    }
    difference.then.answer = answer_of(&pair->then.answer, pair->then.dim, difference.dim);
    difference.now.answer = answer_of(&pair->now.answer, pair->now.dim, difference.dim);
    return difference;
}

/* Compares the pairs that both results answer. */
static enum replay_outcome compare_answers(const struct compare_options *options,
                                           const struct replayed *scene, difference_sink *sink,
                                           void *user)
{
    enum replay_outcome outcome = REPLAY_SAME;
    struct replayed_pairs pairs;
    struct replayed_pair pair;
    replayed_pairs_begin(scene, &pairs);
    while (replayed_pairs_next(&pairs, &pair)) {
        struct difference difference = difference_of(scene, &pair);
        if (pair.then.answered && pair.now.answered &&
            find_difference(options, scene->scene->duration, &difference)) {
            sink(user, &difference);
            outcome = REPLAY_DIFFERENT;
        }
    }
    return outcome;
}

/* Whether the result is consistent with the query, so that its answers can be iterated. Always true
 * for results of this process. */
static bool is_consistent(const struct scene_query *query, const struct scene_result *result)
{
    const bool names = query->which != FMB_PAIRS_LISTED;
    if (result->end_pair < query->first_pair || result->end_pair > query_pair_count(query))
        return false;
    if (!names)
        return (!result->names_pairs || result->verdict_count == 0) &&
               result->verdict_count == result->end_pair - query->first_pair;
    int32_t before = query->first_pair - 1;
    for (int32_t i = 0; i < result->verdict_count; i++) {
        const unsigned *pair = result->names_pairs ? result->pair[i] : NULL;
        if (!pair || !query_has_pair(query, pair[0], pair[1]))
            return false;
        const int32_t number = (int32_t) query_pair_number(query, pair[0], pair[1]);
        if (number <= before || number >= result->end_pair)
            return false;
        before = number;
    }
    return true;
}

static enum replay_outcome report_scene_difference(const struct scene_result *then,
                                                   const struct scene_result *now,
                                                   difference_sink *sink, void *user)
{
    const struct difference difference = {.kind = DIFFERENT_STATUS,
                                          .whole = true,
                                          .dim = 3,
                                          .then = {.status = then->status},
                                          .now = {.status = now->status}};
    sink(user, &difference);
    return REPLAY_DIFFERENT;
}

enum replay_outcome compare_scenes(const struct compare_options *options,
                                   const struct scene_query *query, const struct scene_result *then,
                                   const struct scene_result *now, difference_sink *sink,
                                   void *user)
{
    if (compare_status_is_transient(then->status) || compare_status_is_transient(now->status))
        return transient_outcome(then->status, now->status);
    if (then->status != now->status)
        return report_scene_difference(then, now, sink, user);
    if (now->status != FMB_OK)
        return REPLAY_SAME;
    if (!is_consistent(query, then) || !is_consistent(query, now))
        return report_scene_difference(then, now, sink, user);
    const struct replayed scene = {.scene = query, .scene_then = then, .scene_now = now};
    return compare_answers(options, &scene, sink, user);
}

/* ---- Encoded results ----
 *
 * Both types begin with the fingerprint, the echoed utime, client id and sequence number (8 bytes
 * each) and the server id, and end with compute_ns. */

enum { SERVER_END = 40, COMPUTE_BYTES = 8 };

/* Pair results: the ids of the bodies (8 bytes each), their handles, and all that is compared, the
 * status first. */
enum { HANDLES_END = SERVER_END + 2 * 8 + 2 * HANDLE_BYTES };

/* Scene results: status, an empty detail if the status is OK, method, number of unknown bodies (0);
 * the size of the handles and the handles; and all that is compared. */
enum { UNKNOWN_END = SERVER_END + 4 + 5 + 4 + 4, COUNT_END = UNKNOWN_END + 4 };

static bool same_bytes(const unsigned char *a, const unsigned char *b, size_t begin, size_t end)
{
    return memcmp(a + begin, b + begin, end - begin) == 0;
}

static bool same_pair_bytes(const unsigned char *then, const unsigned char *now, size_t size)
{
    return size >= HANDLES_END + 4 + COMPUTE_BYTES && same_bytes(then, now, 0, 8) &&
           !compare_status_is_transient((int32_t) big_endian_32(now + HANDLES_END)) &&
           same_bytes(then, now, HANDLES_END, size - COMPUTE_BYTES);
}

static bool same_scene_bytes(const unsigned char *then, const unsigned char *now, size_t size)
{
    if (size < COUNT_END + COMPUTE_BYTES || !same_bytes(then, now, 0, 8) ||
        !same_bytes(then, now, SERVER_END, COUNT_END) || big_endian_32(now + SERVER_END) != FMB_OK)
        return false;
    return same_bytes(then, now, COUNT_END + big_endian_32(now + UNKNOWN_END),
                      size - COMPUTE_BYTES);
}

bool compare_bytes_same(enum log_kind kind, const unsigned char *then, size_t then_size,
                        const unsigned char *now, size_t now_size)
{
    if (then_size != now_size)
        return false;
    return kind == LOG_PAIR_QUERY ? same_pair_bytes(then, now, now_size)
                                  : same_scene_bytes(then, now, now_size);
}
