#include "results.h"

#include "layout.h"
#include "same.h"

#include "fmb_msgs_pair_result_t.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Whether wire.h describes the message, by the generated decoder ---- */

static bool is_verdict(int32_t verdict)
{
    return verdict == FMB_MSGS_PAIR_RESULT_T_VERDICT_SEPARATED ||
           verdict == FMB_MSGS_PAIR_RESULT_T_VERDICT_TOUCHING ||
           verdict == FMB_MSGS_PAIR_RESULT_T_VERDICT_OVERLAPPING;
}

static bool is_contact(const fmb_msgs_pair_result_t *message)
{
    const double *t = message->contact;
    return message->num_contact == 2 && t[0] >= 0 && t[1] >= t[0] && t[1] <= DBL_MAX;
}

static bool is_box(const fmb_msgs_pair_result_t *message)
{
    const int32_t dim = message->num_box / 2;
    bool good = message->num_box == 0 || message->num_box == 4 || message->num_box == 6;
    for (int32_t axis = 0; axis < dim && good; axis++)
        good = message->box[axis] <= message->box[dim + axis];
    return good;
}

bool results_is_point(const double *point, int count)
{
    bool good = point[0] >= 0 && point[0] <= DBL_MAX;
    for (int i = 1; i < count && good; i++)
        good = point[i] == point[i];
    return good;
}

/* Of the dimension of the box, if there is one. */
static bool is_point(const fmb_msgs_pair_result_t *message)
{
    const int32_t count = message->num_point;
    return count == 0 ||
           ((message->num_box ? count == 1 + message->num_box / 2 : count == 3 || count == 4) &&
            results_is_point(message->point, count));
}

bool results_are_none(const double *numbers, int count)
{
    bool none = true;
    for (int i = 0; i < count && none; i++) {
        uint64_t bits;
        memcpy(&bits, &numbers[i], sizeof bits);
        none = bits == 0x7ff8000000000000;
    }
    return none;
}

bool results_is_gap(int verdict, int dim, const struct results_gap *gap)
{
    bool good = gap->bounds[0] <= gap->bounds[1];
    for (int axis = 0; axis < dim; axis++)
        good = good && fabs(gap->direction[axis]) <= DBL_MAX;
    if (verdict == FMB_MSGS_PAIR_RESULT_T_VERDICT_TOUCHING)
        good = good && gap->bounds[0] == 0 && gap->bounds[1] == 0;
    if (gap->frames)
        good = good && gap->frames[0] >= 0 && gap->frames[1] >= 0;
    if (!gap->witness)
        return good && verdict >= FMB_MSGS_PAIR_RESULT_T_VERDICT_TOUCHING;
    good = good && (verdict == FMB_MSGS_PAIR_RESULT_T_VERDICT_SEPARATED ||
                    verdict == FMB_MSGS_PAIR_RESULT_T_VERDICT_OVERLAPPING);
    return good && results_is_point(gap->witness, 1 + 2 * dim);
}

bool results_same_gap(const struct fmb_gap *read, int dim, const struct results_gap *gap)
{
    bool same = same_doubles(read->bounds, gap->bounds, 2) &&
                same_doubles(read->direction, gap->direction, (size_t) dim) &&
                read->has_witness == (gap->witness != NULL);
    for (int f = 0; f < 2; f++)
        same = same && (int) read->frame[f] == (gap->frames ? gap->frames[f] : 0);
    if (gap->witness)
        same = same && same_doubles(&read->time, gap->witness, 1) &&
               same_doubles(read->witness[0], gap->witness + 1, (size_t) dim) &&
               same_doubles(read->witness[1], gap->witness + 1 + dim, (size_t) dim);
    return same;
}

static struct results_gap gap_of(const fmb_msgs_pair_result_t *message)
{
    return (struct results_gap){message->gap, message->direction,
                                message->num_witness ? message->witness : NULL,
                                message->num_gap_frames ? message->gap_frames : NULL};
}

static bool is_gap(const fmb_msgs_pair_result_t *message)
{
    const int32_t dim = message->num_direction;
    const struct results_gap gap = gap_of(message);
    if (message->num_gap == 0)
        return dim == 0 && message->num_witness == 0 && message->num_gap_frames == 0;
    return message->num_gap == 2 && (dim == 2 || dim == 3) &&
           (message->num_box == 0 || message->num_box == 2 * dim) &&
           (message->num_point == 0 || message->num_point == 1 + dim) &&
           message->num_witness == (gap.witness ? 1 + 2 * dim : 0) &&
           (message->num_gap_frames == 0 || message->num_gap_frames == 2) &&
           results_is_gap(message->verdict, dim, &gap);
}

static bool is_certificate(const fmb_msgs_pair_result_t *message)
{
    const char *text = message->certificate;
    const size_t length = strlen(text);
    bool good = length == 0 || (message->status == FMB_MSGS_PAIR_RESULT_T_STATUS_OK &&
                                length < FMB_CERTIFICATE_MAX);
    for (size_t i = 0; i < length && good; i++)
        good = text[i] >= 0x20 && text[i] <= 0x7e;
    return good;
}

static bool is_result(const fmb_msgs_pair_result_t *message)
{
    const bool answered = message->status == FMB_MSGS_PAIR_RESULT_T_STATUS_OK;
    const bool meet = message->verdict >= FMB_MSGS_PAIR_RESULT_T_VERDICT_TOUCHING;
    return (answered ? is_verdict(message->verdict) : message->verdict == 0) &&
           (meet ? is_contact(message) && is_box(message) && is_point(message)
                 : message->num_contact == 0 && message->num_box == 0 && message->num_point == 0) &&
           is_gap(message) && is_certificate(message);
}

/* ---- The same fields ---- */

static bool same_ids(const struct pair_result *result, const fmb_msgs_pair_result_t *message)
{
    return result->utime == message->utime && result->client_id == message->client_id &&
           result->sequence_number == message->sequence_number &&
           result->server_id == message->server_id && result->body_id[0] == message->body_a &&
           result->body_id[1] == message->body_b &&
           same_handles(&result->handle[0], 1, 1, message->handle_a, sizeof message->handle_a) &&
           same_handles(&result->handle[1], 1, 1, message->handle_b, sizeof message->handle_b) &&
           result->compute_ns == message->compute_ns;
}

static bool same_answer(const struct pair_result *result, const fmb_msgs_pair_result_t *message)
{
    const struct fmb_answer *answer = &result->answer;
    const int dim = message->num_box > 0     ? message->num_box / 2
                    : message->num_point > 0 ? message->num_point - 1
                                             : message->num_direction;
    const struct results_gap gap = gap_of(message);
    bool same = (int) answer->verdict == message->verdict && result->dim == dim &&
                answer->has_gap == (message->num_gap > 0) &&
                result->names_frames == (message->num_gap_frames > 0) &&
                (!answer->has_gap || results_same_gap(&answer->gap, dim, &gap)) &&
                answer->has_contact == (message->num_contact > 0) &&
                answer->has_box == (message->num_box > 0) &&
                answer->has_point == (message->num_point > 0) &&
                same_doubles(answer->point, message->point, (size_t) message->num_point) &&
                same_doubles(answer->contact, message->contact, (size_t) message->num_contact);
    for (int side = 0; side < 2 && same && answer->has_box; side++)
        same = same_doubles(answer->box[side], message->box + side * dim, (size_t) dim);
    return same;
}

/* *whole: detail was not changed. */
static bool same_result(const struct pair_result *result, const fmb_msgs_pair_result_t *message,
                        bool *whole)
{
    const char *certificate = result->certificate ? result->certificate : "";
    return same_ids(result, message) && same_answer(result, message) &&
           result->status == message->status && result->method == message->method &&
           same_text(result->detail, sizeof result->detail, message->detail, whole) &&
           strcmp(certificate, message->certificate) == 0;
}

/* ---- Reading ---- */

/* What the reader should have returned. On output: *whole, if it accepts. */
static bool check_decoder(const struct pair_result *result, bool accepted, const uint8_t *bytes,
                          size_t size, bool *whole)
{
    fmb_msgs_pair_result_t message;
    if (!layout_fits(LAYOUT_PAIR_RESULT, __fmb_msgs_pair_result_t_get_hash(), bytes, size))
        return false;
    FUZZ_CHECK(fmb_msgs_pair_result_t_decode(bytes, 0, (int) size, &message) == (int) size);
    const bool good = is_result(&message);
    if (accepted)
        FUZZ_CHECK(same_result(result, &message, whole));
    SAME_ENCODED(fmb_msgs_pair_result_t, message, bytes, size);
    return good;
}

static void check_writer(const struct pair_result *result, bool whole, const uint8_t *bytes,
                         size_t size)
{
    static unsigned char written[QUERY_BYTES_MAX], again[QUERY_BYTES_MAX];
    struct pair_result read;
    const size_t count = wire_write_pair_result(result, written);
    if (whole)
        same_bytes(written, count, bytes, size);
    FUZZ_CHECK(!wire_read_pair_result(written, (uint32_t) count, &read));
    same_bytes(again, wire_write_pair_result(&read, again), written, count);
}

const struct pair_result *results_read_pair(const uint8_t *data, size_t size)
{
    static uint8_t *bytes;
    static struct pair_result result;
    bool whole = false;
    same_header(wire_read_pair_result_header, __fmb_msgs_pair_result_t_get_hash(), data, size);
    free(bytes); /* of the call before; its certificate is there */
    bytes = fuzz_copy(data, size);
    const bool accepted = !wire_read_pair_result(bytes, (uint32_t) size, &result);
    FUZZ_CHECK(check_decoder(&result, accepted, bytes, size, &whole) == accepted);
    if (accepted)
        check_writer(&result, whole, bytes, size);
    return accepted ? &result : NULL;
}
