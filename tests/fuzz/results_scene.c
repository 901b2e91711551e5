#include "results.h"

#include "layout.h"
#include "same.h"

#include "fmb_msgs_pair_result_t.h"
#include "fmb_msgs_scene_result_t.h"

#include <float.h>
#include <stdlib.h>

/* ---- Whether wire.h describes the message, by the generated decoder ---- */

enum { TOUCHING = FMB_MSGS_PAIR_RESULT_T_VERDICT_TOUCHING };
enum { OVERLAPPING = FMB_MSGS_PAIR_RESULT_T_VERDICT_OVERLAPPING };

static int64_t contacts_of(const fmb_msgs_scene_result_t *message)
{
    int64_t count = 0;
    for (int32_t i = 0; i < message->num_verdicts; i++)
        count += message->verdicts[i] == TOUCHING || message->verdicts[i] == OVERLAPPING;
    return count;
}

static bool are_unknown(const fmb_msgs_scene_result_t *message)
{
    const int32_t count = message->num_unknown;
    bool good = (message->status == FMB_MSGS_PAIR_RESULT_T_STATUS_UNKNOWN_BODY) == (count > 0);
    for (int32_t i = 0; i < count && good; i++)
        good = message->unknown[i] > (i > 0 ? message->unknown[i - 1] : -1) &&
               message->unknown[i] < QUERY_PLACEMENTS_MAX;
    return good;
}

/* What a query that was refused has none of. */
static bool is_answer(const fmb_msgs_scene_result_t *message)
{
    return message->num_verdicts || message->num_handle_bytes || message->end_pair;
}

enum { SEPARATED = FMB_MSGS_PAIR_RESULT_T_VERDICT_SEPARATED };

static int32_t dim_of_gaps(const fmb_msgs_scene_result_t *message)
{
    return message->num_gaps > 0 && message->num_verdicts > 0
               ? message->num_directions / message->num_verdicts
               : 0;
}

static int32_t dim_of_boxes(const fmb_msgs_scene_result_t *message)
{
    return message->num_boxes == 0 ? 0 : message->num_boxes == 4 * contacts_of(message) ? 2 : 3;
}

/* Of boxes, points or gaps. */
static int32_t dim_of(const fmb_msgs_scene_result_t *message)
{
    if (message->num_boxes > 0)
        return dim_of_boxes(message);
    if (message->num_points > 0)
        return message->num_points == 3 * contacts_of(message) ? 2 : 3;
    return dim_of_gaps(message);
}

static struct results_gap gap_of(const fmb_msgs_scene_result_t *message, int32_t i)
{
    const int32_t dim = dim_of_gaps(message), points = 1 + 2 * dim;
    const double *witness = message->witnesses + points * i;
    return (struct results_gap){message->gaps + 2 * i, message->directions + dim * i,
                                results_are_none(witness, points) ? NULL : witness,
                                message->num_gap_frames ? message->gap_frames + 2 * i : NULL};
}

/* Whether a pair is neither near nor a contact, or is not decided. */
static bool is_far(const fmb_msgs_scene_result_t *message, int32_t i)
{
    const int32_t dim = dim_of_gaps(message);
    const int16_t *frames = message->num_gap_frames ? message->gap_frames + 2 * i : NULL;
    return message->verdicts[i] <= SEPARATED && results_are_none(message->gaps + 2 * i, 2) &&
           (!frames || (frames[0] == 0 && frames[1] == 0)) &&
           results_are_none(message->directions + dim * i, dim) &&
           results_are_none(message->witnesses + (1 + 2 * dim) * i, 1 + 2 * dim);
}

static bool are_gaps(const fmb_msgs_scene_result_t *message)
{
    const int64_t verdicts = message->num_verdicts;
    if (message->num_gaps == 0)
        return message->num_directions == 0 && message->num_witnesses == 0 &&
               message->num_gap_frames == 0;
    if (message->num_gaps != 2 * verdicts || verdicts > QUERY_GAPS_MAX)
        return false;
    const int32_t dim = dim_of_gaps(message), points = 1 + 2 * dim;
    bool good = (dim == 2 || dim == 3) && message->num_directions == dim * verdicts &&
                message->num_witnesses == points * verdicts &&
                (message->num_gap_frames == 0 || message->num_gap_frames == 2 * verdicts) &&
                dim_of(message) == dim;
    for (int32_t i = 0; i < verdicts && good; i++) {
        const struct results_gap gap = gap_of(message, i);
        good = is_far(message, i) || results_is_gap(message->verdicts[i], dim, &gap);
    }
    return good;
}

/* Whether all named pairs are contacts, near or not decided. The gaps have been checked. */
static bool are_named(const fmb_msgs_scene_result_t *message)
{
    bool good = true;
    for (int32_t i = 0; i < message->num_indices / 2 && good; i++)
        good = message->verdicts[i] != SEPARATED || (message->num_gaps > 0 && !is_far(message, i));
    return good;
}

static bool are_verdicts(const fmb_msgs_scene_result_t *message)
{
    bool good = true;
    for (int32_t i = 0; i < message->num_verdicts && good; i++)
        good = message->verdicts[i] <= OVERLAPPING;
    return good && message->num_verdicts <= QUERY_VERDICTS_MAX;
}

static bool are_names(const fmb_msgs_scene_result_t *message)
{
    const int64_t count = message->num_indices;
    bool good = count == 0 ||
                (count == 2 * (int64_t) message->num_verdicts && count <= 2 * QUERY_NAMED_MAX);
    int32_t last = -1; /* the last pair as one number */
    for (int32_t i = 0; i < count / 2 && good; i++) {
        const int16_t a = message->indices[2 * i], b = message->indices[2 * i + 1];
        const int32_t here = a * QUERY_PLACEMENTS_MAX + b;
        good = 0 <= a && a < b && b < QUERY_PLACEMENTS_MAX && last < here;
        last = here;
    }
    return good;
}

static bool are_times(const fmb_msgs_scene_result_t *message, int64_t contacts)
{
    const int64_t count = message->num_times;
    bool good = count == 0 || (count == 2 * contacts && count <= QUERY_NUMBERS_MAX);
    for (int32_t i = 0; i < count && good; i += 2) {
        const double first = message->times[i], last = message->times[i + 1];
        good = first >= 0 && last >= first && last <= DBL_MAX;
    }
    return good;
}

static bool are_boxes(const fmb_msgs_scene_result_t *message, int64_t contacts)
{
    const int64_t count = message->num_boxes;
    const int32_t dim = count == 4 * contacts ? 2 : 3;
    bool good = count == 0 || (count == 2 * dim * contacts && count <= QUERY_NUMBERS_MAX);
    for (int32_t box = 0; box < count && good; box += 2 * dim)
        for (int32_t axis = 0; axis < dim; axis++)
            good = good && message->boxes[box + axis] <= message->boxes[box + dim + axis];
    return good;
}

static bool are_points(const fmb_msgs_scene_result_t *message, int64_t contacts)
{
    const int64_t count = message->num_points, each = 1 + dim_of(message);
    bool good = count == 0 || (count == each * contacts && count <= QUERY_NUMBERS_MAX);
    for (int64_t i = 0; i < count && good; i += each)
        good = results_is_point(message->points + i, (int) each);
    return good;
}

static bool is_result(const fmb_msgs_scene_result_t *message)
{
    const int64_t contacts = contacts_of(message);
    const bool answered = message->status == FMB_MSGS_PAIR_RESULT_T_STATUS_OK;
    return are_unknown(message) && (answered || !is_answer(message)) && message->end_pair >= 0 &&
           message->num_handle_bytes % HANDLE_BYTES == 0 &&
           message->num_handle_bytes / HANDLE_BYTES <= QUERY_PLACEMENTS_MAX &&
           are_verdicts(message) && are_names(message) && are_times(message, contacts) &&
           are_boxes(message, contacts) && are_points(message, contacts) && are_gaps(message) &&
           are_named(message);
}

/* ---- The same fields ---- */

static bool same_ids(const struct scene_result *result, const fmb_msgs_scene_result_t *message)
{
    return result->utime == message->utime && result->client_id == message->client_id &&
           result->sequence_number == message->sequence_number &&
           result->server_id == message->server_id && result->status == message->status &&
           result->method == message->method && result->end_pair == message->end_pair &&
           result->compute_ns == message->compute_ns;
}

static bool same_bodies(const struct scene_result *result, const fmb_msgs_scene_result_t *message)
{
    bool same = result->unknown_count == message->num_unknown &&
                same_handles(result->handle, result->handle_count, QUERY_PLACEMENTS_MAX,
                             message->handles, message->num_handle_bytes);
    for (int32_t i = 0; i < message->num_unknown && same; i++)
        same = result->unknown[i] == (unsigned) message->unknown[i];
    return same;
}

static bool same_verdicts(const struct scene_result *result, const fmb_msgs_scene_result_t *message)
{
    bool same = result->verdict_count == message->num_verdicts &&
                result->names_pairs == (message->num_indices > 0);
    for (int32_t i = 0; i < message->num_verdicts && same; i++)
        same = result->verdict[i] == message->verdicts[i];
    for (int32_t i = 0; i < message->num_indices && same; i++)
        same = result->pair[i / 2][i % 2] == (unsigned) message->indices[i];
    return same;
}

static bool same_contacts(const struct scene_result *result, const fmb_msgs_scene_result_t *message)
{
    const int32_t boxes = message->num_boxes;
    const int64_t contacts = contacts_of(message);
    return result->contact_count == contacts && result->has_times == (message->num_times > 0) &&
           same_doubles(result->times, message->times, (size_t) message->num_times) &&
           result->has_boxes == (boxes > 0) && result->dim == dim_of(message) &&
           result->has_points == (message->num_points > 0) &&
           same_doubles(result->boxes, message->boxes, (size_t) boxes) &&
           same_doubles(result->points, message->points, (size_t) message->num_points);
}

static bool same_gaps(const struct scene_result *result, const fmb_msgs_scene_result_t *message)
{
    bool same = result->has_gaps == (message->num_gaps > 0) &&
                result->names_frames == (message->num_gap_frames > 0);
    for (int32_t i = 0; i < message->num_verdicts && result->has_gaps && same; i++) {
        const struct results_gap gap = gap_of(message, i);
        same = is_far(message, i) ? !query_has_gap(&result->gap[i])
                                  : results_same_gap(&result->gap[i], result->dim, &gap);
    }
    return same;
}

/* ---- Reading ---- */

/* What the reader should have returned. On output: *whole, if it accepts: detail was not changed.
 */
static bool check_decoder(const struct scene_result *result, bool accepted, const uint8_t *bytes,
                          size_t size, bool *whole)
{
    fmb_msgs_scene_result_t message;
    if (!layout_fits(LAYOUT_SCENE_RESULT, __fmb_msgs_scene_result_t_get_hash(), bytes, size))
        return false;
    FUZZ_CHECK(fmb_msgs_scene_result_t_decode(bytes, 0, (int) size, &message) == (int) size);
    const bool good = is_result(&message);
    if (accepted) {
        FUZZ_CHECK(same_ids(result, &message));
        FUZZ_CHECK(same_text(result->detail, sizeof result->detail, message.detail, whole));
        FUZZ_CHECK(same_bodies(result, &message));
        FUZZ_CHECK(same_verdicts(result, &message));
        FUZZ_CHECK(same_contacts(result, &message));
        FUZZ_CHECK(same_gaps(result, &message));
    }
    SAME_ENCODED(fmb_msgs_scene_result_t, message, bytes, size);
    return good;
}

static void check_writer(const struct scene_result *result, bool whole, const uint8_t *bytes,
                         size_t size)
{
    static unsigned char written[QUERY_BYTES_MAX], again[QUERY_BYTES_MAX];
    static struct scene_result read;
    if (size > QUERY_BYTES_MAX)
        return;
    const size_t count = wire_write_scene_result(result, written);
    if (whole)
        same_bytes(written, count, bytes, size);
    FUZZ_CHECK(!wire_read_scene_result(written, (uint32_t) count, &read));
    same_bytes(again, wire_write_scene_result(&read, again), written, count);
}

const struct scene_result *results_read_scene(const uint8_t *data, size_t size)
{
    static struct scene_result result;
    bool whole = false;
    same_header(wire_read_scene_result_header, __fmb_msgs_scene_result_t_get_hash(), data, size);
    uint8_t *bytes = fuzz_copy(data, size);
    const bool accepted = !wire_read_scene_result(bytes, (uint32_t) size, &result);
    FUZZ_CHECK(check_decoder(&result, accepted, bytes, size, &whole) == accepted);
    if (accepted)
        check_writer(&result, whole, bytes, size);
    free(bytes);
    return accepted ? &result : NULL;
}
