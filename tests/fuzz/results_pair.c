#include "results.h"

#include "layout.h"
#include "same.h"

#include "fmb_msgs_pair_result_t.h"

#include <float.h>
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

/* Lists that this version leaves empty. */
static bool has_gap(const fmb_msgs_pair_result_t *message)
{
    return message->num_gap || message->num_direction || message->num_witness;
}

static bool is_certificate(const fmb_msgs_pair_result_t *message)
{
    const char *text = message->certificate;
    const size_t length = strlen(text);
    bool good = length == 0 || (message->status == FMB_MSGS_PAIR_RESULT_T_STATUS_OK &&
                                length < QUERY_CERTIFICATE_MAX);
    for (size_t i = 0; i < length && good; i++)
        good = text[i] >= 0x20 && text[i] <= 0x7e;
    return good;
}

static bool is_result(const fmb_msgs_pair_result_t *message)
{
    const bool answered = message->status == FMB_MSGS_PAIR_RESULT_T_STATUS_OK;
    const bool meet = message->verdict >= FMB_MSGS_PAIR_RESULT_T_VERDICT_TOUCHING;
    return (answered ? is_verdict(message->verdict) : message->verdict == 0) &&
           (meet ? is_contact(message) && is_box(message)
                 : message->num_contact == 0 && message->num_box == 0) &&
           !has_gap(message) && is_certificate(message);
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
    const int dim = message->num_box / 2;
    bool same = (int) answer->verdict == message->verdict && result->dim == dim &&
                answer->has_contact == (message->num_contact > 0) &&
                answer->has_box == (message->num_box > 0) &&
                same_doubles(answer->contact, message->contact, (size_t) message->num_contact);
    for (int side = 0; side < 2 && same && dim > 0; side++)
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
