#include "compare.h"

#include "big_endian.h"
#include "logged_query.h"

#include <math.h>
#include <string.h>

const char *difference_name(enum difference_kind kind)
{
    static const char *const name[DIFFERENT_KINDS] = {
        [DIFFERENT_STATUS] = "status",     [DIFFERENT_VERDICT] = "verdict",
        [DIFFERENT_INTERVAL] = "interval", [DIFFERENT_BOX] = "box",
        [DIFFERENT_GAP] = "gap",           [DIFFERENT_CERTIFICATE] = "certificate",
    };
    return name[kind];
}

/* ---- Numbers ---- */

static bool same_bits(const double *a, const double *b, int count)
{
    return memcmp(a, b, (size_t) count * sizeof *a) == 0;
}

/* Whether numbers differ by at most limit. If the difference is infinite or NaN, they do not,
 * unless their bits are the same. Without a tolerance the bits are compared, so that 0 and -0
 * differ. */
static bool within(const struct compare_options *options, const double *a, const double *b,
                   int count, double limit)
{
    if (!(options->tolerance > 0))
        return same_bits(a, b, count);
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

static bool same_intervals(const struct compare_options *options, double duration,
                           const struct fmb_answer *a, const struct fmb_answer *b)
{
    if (a->has_contact != b->has_contact)
        return false;
    return !a->has_contact ||
           within(options, a->contact, b->contact, 2, options->tolerance * duration);
}

static bool same_boxes(const struct compare_options *options, int dim, const struct fmb_answer *a,
                       const struct fmb_answer *b)
{
    if (a->has_box != b->has_box)
        return false;
    const double most = largest(a->box[0], BOX_NUMBERS,
                                largest(b->box[0], BOX_NUMBERS, 0)); /* numbers beyond dim are 0 */
    const double limit = options->tolerance > 0 ? options->tolerance * most : 0;
    for (int side = 0; side < 2 && a->has_box; side++)
        if (!within(options, a->box[side], b->box[side], dim, limit))
            return false;
    return true;
}

static double largest_of_gap(const struct fmb_gap *gap, double most)
{
    return largest(gap->witness[0], BOX_NUMBERS, largest(gap->bounds, 2, most));
}

static bool same_gaps(const struct compare_options *options, const struct fmb_answer *a,
                      const struct fmb_answer *b)
{
    if (a->has_gap != b->has_gap)
        return false;
    if (!(options->tolerance > 0))
        return query_same_gap(&a->gap, &b->gap);
    const double most = largest_of_gap(&a->gap, largest_of_gap(&b->gap, 0));
    return within(options, a->gap.bounds, b->gap.bounds, 2, options->tolerance * most);
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
    if (out->then.status != out->now.status)
        out->kind = DIFFERENT_STATUS;
    else if (then->verdict != now->verdict)
        out->kind = DIFFERENT_VERDICT;
    else if (!same_intervals(options, duration, then, now))
        out->kind = DIFFERENT_INTERVAL;
    else if (!same_boxes(options, out->dim, then, now))
        out->kind = DIFFERENT_BOX;
    else if (!same_gaps(options, then, now))
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

/* ---- Pairs ---- */

/* A box or gap of another dimension than the query's is ignored. */
static struct difference_side side_of_pair(const struct pair_result *result, int dim)
{
    struct difference_side side = {
        .status = result->status, .answer = result->answer, .certificate = result->certificate};
    side.answer.has_box = side.answer.has_box && result->dim == dim;
    side.answer.has_gap = side.answer.has_gap && result->dim == dim;
    return side;
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

/* A cursor over the answers of a result. */
struct answers {
    const struct scene_query *query;
    const struct scene_result *result;
    int32_t next;    /* index of the next verdict */
    int32_t contact; /* index of the next contact, in times and boxes */
};

static bool is_contact(unsigned char verdict)
{
    return verdict == FMB_TOUCHING || verdict == FMB_OVERLAPPING;
}

/* The number of the next pair among all pairs of the query; INT32_MAX at the end. */
static int32_t number_at(const struct answers *answers)
{
    if (answers->next >= answers->result->verdict_count)
        return INT32_MAX;
    if (!answers->result->names_pairs)
        return answers->query->first_pair + answers->next;
    const unsigned *pair = answers->result->pair[answers->next];
    return (int32_t) logged_query_pair_number(answers->query, pair[0], pair[1]);
}

/* Copies the box of a contact, if it has the query's dimension. */
static void take_box(const struct answers *answers, int32_t contact, struct fmb_answer *out)
{
    const int dim = answers->result->dim;
    out->has_box = answers->result->has_boxes && dim == dim_of(&answers->query->placement[0]);
    for (int i = 0; i < 2 * dim && out->has_box; i++)
        out->box[i / dim][i % dim] = answers->result->boxes[2 * dim * contact + i];
}

/* Copies the gap of a verdict, if it has the query's dimension. */
static void take_gap(const struct answers *answers, int32_t verdict, struct fmb_answer *out)
{
    const struct scene_result *result = answers->result;
    out->has_gap = result->has_gaps && query_has_gap(&result->gap[verdict]) &&
                   result->dim == dim_of(&answers->query->placement[0]);
    if (out->has_gap)
        out->gap = result->gap[verdict];
}

/* Returns the next answer, and advances the cursor. */
static struct fmb_answer take(struct answers *answers)
{
    const struct scene_result *result = answers->result;
    struct fmb_answer answer = {.verdict = (enum fmb_verdict) result->verdict[answers->next]};
    take_gap(answers, answers->next++, &answer);
    if (!is_contact((unsigned char) answer.verdict))
        return answer;
    const int32_t contact = answers->contact++;
    answer.has_contact = result->has_times;
    for (int end = 0; end < 2 && answer.has_contact; end++)
        answer.contact[end] = result->times[2 * contact + end];
    take_box(answers, contact, &answer);
    return answer;
}

/* The answer to the pair with this number: the one that the result names, or separated. Advances
 * the cursor past it. */
static struct fmb_answer answer_to(struct answers *answers, int32_t number)
{
    if (number_at(answers) == number)
        return take(answers);
    return (struct fmb_answer){.verdict = FMB_SEPARATED};
}

/* The placements of the pair at the cursor. */
static const unsigned *pair_at(const struct answers *answers)
{
    return answers->result->names_pairs ? answers->result->pair[answers->next]
                                        : answers->query->pair[number_at(answers)];
}

static struct difference difference_of(const struct scene_query *query, const unsigned pair[2])
{
    struct difference difference = {.dim = dim_of(&query->placement[0])};
    for (int f = 0; f < 2; f++) {
        difference.placement[f] = pair[f];
        if (pair[f] < (unsigned) query->placement_count && pair[f] < QUERY_PLACEMENTS_MAX)
            difference.body_id[f] = query->placement[pair[f]].body_id;
    }
    return difference;
}

static bool compare_answers(const struct compare_options *options, struct answers *then,
                            struct answers *now, int32_t end, difference_sink *sink, void *user)
{
    bool same = true;
    for (;;) {
        const int32_t next_then = number_at(then), next_now = number_at(now);
        const int32_t number = next_then < next_now ? next_then : next_now;
        if (number >= end)
            return same;
        struct difference difference =
            difference_of(now->query, pair_at(next_then == number ? then : now));
        difference.then.answer = answer_to(then, number);
        difference.now.answer = answer_to(now, number);
        if (!find_difference(options, now->query->duration, &difference))
            continue;
        sink(user, &difference);
        same = false;
    }
}

/* Whether the result is consistent with the query, so that its answers can be iterated. Always true
 * for results of this process. */
static bool is_consistent(const struct scene_query *query, const struct scene_result *result)
{
    const bool names = query->which != QUERY_PAIRS_LISTED;
    if (result->end_pair < query->first_pair || result->end_pair > logged_query_pairs(query))
        return false;
    if (!names)
        return (!result->names_pairs || result->verdict_count == 0) &&
               result->verdict_count == result->end_pair - query->first_pair;
    int32_t before = query->first_pair - 1;
    for (int32_t i = 0; i < result->verdict_count; i++) {
        const unsigned *pair = result->names_pairs ? result->pair[i] : NULL;
        if (!pair || pair[0] >= pair[1] || pair[1] >= (unsigned) query->placement_count)
            return false;
        if (query->which == QUERY_PAIRS_ACROSS &&
            (pair[0] >= (unsigned) query->split || pair[1] < (unsigned) query->split))
            return false;
        const int32_t number = (int32_t) logged_query_pair_number(query, pair[0], pair[1]);
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
    struct answers of_then = {.query = query, .result = then};
    struct answers of_now = {.query = query, .result = now};
    const int32_t end = then->end_pair < now->end_pair ? then->end_pair : now->end_pair;
    const bool same = compare_answers(options, &of_then, &of_now, end, sink, user);
    return same ? REPLAY_SAME : REPLAY_DIFFERENT;
}

/* ---- Encoded results ----
 *
 * Both types begin with the fingerprint, the echoed utime, client id and sequence number (8 bytes
 * each) and the server id, and end with compute_ns. */

enum { SERVER_END = 40, COMPUTE_BYTES = 8 };

/* Pair results: the ids of the bodies, their handles, and all that is compared, the status first.
 */
enum { BODIES_END = SERVER_END + 16, HANDLES_END = BODIES_END + 2 * HANDLE_BYTES };

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
           same_bytes(then, now, SERVER_END, BODIES_END) &&
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
