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
    const struct difference_side *then = &out->then, *now = &out->now;
    const unsigned parts = parts_apart(options, duration, out->dim, &then->answer, &now->answer);
    const bool differs[DIFFERENT_KINDS] = {
        [DIFFERENT_STATUS] = then->status != now->status,
        [DIFFERENT_VERDICT] = then->answer.verdict != now->answer.verdict,
        [DIFFERENT_INTERVAL] = parts & FMB_WANT_TIMES,
        [DIFFERENT_BOX] = parts & FMB_WANT_BOX,
        [DIFFERENT_GAP] = parts & FMB_WANT_GAP,
        [DIFFERENT_CERTIFICATE] = !same_certificates(options, then->certificate, now->certificate)};
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
    enum replay_outcome outcome = REPLAY_SAME;
    struct replayed_pairs pairs;
    struct replayed_pair pair;
    replayed_pairs_begin(replayed, &pairs);
    while (replayed_pairs_next(&pairs, &pair)) {
        struct difference difference = difference_of(replayed, &pair);
        if ((is_pair || (pair.then.answered && pair.now.answered)) &&
            find_difference(options, duration, &difference)) {
            sink(user, &difference);
            outcome = REPLAY_DIFFERENT;
        }
    }
    return outcome;
}

enum replay_outcome compare_results(const struct compare_options *options,
                                    const struct replayed *replayed, difference_sink *sink,
                                    void *user)
{
    const struct logged_query *query = replayed->query;
    const int32_t then = replayed->then->head.status;
    const int32_t now = replayed->now->head.status;
    if (logged_status_is_transient(then) || logged_status_is_transient(now))
        return transient_outcome(then, now);
    if (query->kind == LOG_PAIR_QUERY ||
        (then == FMB_OK && now == FMB_OK &&
         logged_result_fits(&query->scene, &replayed->then->scene) &&
         logged_result_fits(&query->scene, &replayed->now->scene)))
        return compare_answers(options, replayed, sink, user);
    if (then == now && now != FMB_OK)
        return REPLAY_SAME;
    sink(user, &(struct difference){.kind = DIFFERENT_STATUS,
                                    .whole = true,
                                    .dim = 3,
                                    .then = {.status = then},
                                    .now = {.status = now}});
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
