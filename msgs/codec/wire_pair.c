/* Pair queries and pair results. */
#include "wire.h"

#include "wire_placement.h"

#include "fmb_msgs_pair_query_t.h"
#include "fmb_msgs_pair_result_t.h"

#include <assert.h>
#include <float.h>
#include <string.h>

/* The fixed fields of a result, the most numbers that its lists can have, and its texts. */
static_assert(8 + 6 * 8 + 2 * HANDLE_BYTES + 12 * 4 + 2 * 2 + 8 * (6 + 6 * FMB_DIM_MAX) +
                      QUERY_TEXT_MAX + FMB_CERTIFICATE_MAX + 8 <=
                  QUERY_BYTES_MAX,
              "a result is one datagram");

/* The constants of the message types are equal to those of the engine. */
static_assert((int) FMB_SEPARATED == FMB_MSGS_PAIR_RESULT_T_VERDICT_SEPARATED &&
                  (int) FMB_TOUCHING == FMB_MSGS_PAIR_RESULT_T_VERDICT_TOUCHING &&
                  (int) FMB_OVERLAPPING == FMB_MSGS_PAIR_RESULT_T_VERDICT_OVERLAPPING,
              "verdicts");
static_assert((int) FMB_WANT_BOX == FMB_MSGS_PAIR_QUERY_T_WANT_BOX &&
                  (int) FMB_WANT_CERTIFICATE == FMB_MSGS_PAIR_QUERY_T_WANT_CERTIFICATE &&
                  (int) FMB_WANT_TIMES == FMB_MSGS_PAIR_QUERY_T_WANT_TIMES &&
                  (int) FMB_WANT_GAP == FMB_MSGS_PAIR_QUERY_T_WANT_GAP &&
                  (int) FMB_WANT_POINT == FMB_MSGS_PAIR_QUERY_T_WANT_POINT,
              "wants");
#define X(name, number, text) \
    static_assert((int) FMB_##name == FMB_MSGS_PAIR_RESULT_T_STATUS_##name, text);
FMB_STATUS_MAP(X)
#undef X

const char *wire_read_pair_header(const void *bytes, uint32_t size, struct query_header *out)
{
    return wire_read_header(bytes, size, __fmb_msgs_pair_query_t_get_hash(), out);
}

const char *wire_read_pair_result_header(const void *bytes, uint32_t size, struct query_header *out)
{
    return wire_read_header(bytes, size, __fmb_msgs_pair_result_t_get_hash(), out);
}

const char *wire_read_pair_query(const void *bytes, uint32_t size, struct pair_query *out)
{
    struct cursor cursor = cursor_begin(bytes, size, __fmb_msgs_pair_query_t_get_hash());
    wire_read_ids(&cursor, &out->header);
    out->duration = cursor_double(&cursor);
    out->method = cursor_int32(&cursor);
    out->want = cursor_int32(&cursor);
    wire_read_placement(&cursor, &out->placement[0]);
    wire_read_placement(&cursor, &out->placement[1]);
    return cursor_end(&cursor);
}

/* Reads a box: the lower ends of all axes, then the upper ends. */
static void read_box(struct cursor *cursor, struct pair_result *out)
{
    double ends[2 * FMB_DIM_MAX] = {0};
    const int32_t count = cursor_doubles(cursor, ends, 2 * FMB_DIM_MAX);
    if (count != 0 && count != 4 && count != 6)
        cursor_fail(cursor, "a box of neither 4 nor 6 numbers");
    out->dim = count / 2;
    out->answer.has_box = count > 0;
    if (out->answer.has_box && out->answer.verdict < FMB_TOUCHING)
        cursor_fail(cursor, "a box without contact");
    for (int side = 0; side < 2 && !cursor->error; side++)
        for (int axis = 0; axis < out->dim; axis++)
            out->answer.box[side][axis] = ends[side * out->dim + axis];
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        if (!(out->answer.box[0][axis] <= out->answer.box[1][axis]))
            cursor_fail(cursor, "a box that is no box");
}

/* Reads a contact interval, which is present if and only if the bodies touch or overlap. */
static void read_contact(struct cursor *cursor, struct fmb_answer *out)
{
    const int32_t count = cursor_doubles(cursor, out->contact, 2);
    out->has_contact = out->verdict >= FMB_TOUCHING;
    if (count != (out->has_contact ? 2 : 0))
        cursor_fail(cursor, "a contact interval has 2 numbers, for a contact alone");
    if (!(0 <= out->contact[0] && out->contact[0] <= out->contact[1] && out->contact[1] <= DBL_MAX))
        cursor_fail(cursor, "a contact interval that is no interval");
}

/* Reads a point of a contact, of the dimension of the box if there is one. */
static void read_point(struct cursor *cursor, struct pair_result *out)
{
    const int32_t count = cursor_doubles(cursor, out->answer.point, 1 + FMB_DIM_MAX);
    out->answer.has_point = count > 0;
    if (count == 0)
        return;
    if ((count != 3 && count != 4) || (out->dim > 0 && count != 1 + out->dim) ||
        out->answer.verdict < FMB_TOUCHING || !wire_is_point(out->answer.point, count))
        cursor_fail(cursor, "a point that is no point of a contact");
    out->dim = count - 1;
}

static void read_gap(struct cursor *cursor, struct pair_result *out)
{
    const unsigned char verdict = (unsigned char) out->answer.verdict;
    const int dim =
        wire_read_gaps(cursor, &verdict, 1, false, &out->names_frames, &out->answer.gap);
    out->answer.has_gap = dim > 0;
    if (dim > 0 && ((out->dim > 0 && out->dim != dim) || !query_has_gap(&out->answer.gap)))
        cursor_fail(cursor, "no gap, or one of another dimension");
    out->dim = dim > 0 ? dim : out->dim;
}

static void read_certificate(struct cursor *cursor, struct pair_result *out)
{
    const char *text = cursor_take_string(cursor);
    const size_t length = strlen(text);
    if (length == 0)
        return;
    if (out->status != FMB_OK)
        cursor_fail(cursor, "a certificate without a verdict");
    if (length >= FMB_CERTIFICATE_MAX)
        cursor_fail(cursor, "a certificate that is too long");
    for (size_t i = 0; i < length && !cursor->error; i++)
        if (!cursor_is_printable((unsigned char) text[i]))
            cursor_fail(cursor, "a certificate that is not printable");
    out->certificate = text;
}

const char *wire_read_pair_result(const void *bytes, uint32_t size, struct pair_result *out)
{
    struct cursor cursor = cursor_begin(bytes, size, __fmb_msgs_pair_result_t_get_hash());
    memset(out, 0, sizeof *out);
    wire_read_ids(&cursor, &out->header);
    out->server_id = cursor_int64(&cursor);
    for (int f = 0; f < 2; f++)
        out->body_id[f] = cursor_int64(&cursor);
    for (int f = 0; f < 2; f++)
        wire_read_handle(&cursor, &out->handle[f]);
    out->status = cursor_int32(&cursor);
    cursor_string(&cursor, out->detail, sizeof out->detail);
    out->method = cursor_int32(&cursor);
    int32_t verdict = cursor_int32(&cursor);
    if (out->status == FMB_OK ? !fmb_verdict_name(verdict) : verdict != 0)
        cursor_fail(&cursor, "verdict and status do not go together");
    out->answer.verdict = (enum fmb_verdict) verdict;
    read_contact(&cursor, &out->answer);
    read_box(&cursor, out);
    read_point(&cursor, out);
    read_gap(&cursor, out);
    read_certificate(&cursor, out);
    out->compute_ns = cursor_int64(&cursor);
    return cursor_end(&cursor);
}

size_t wire_write_pair_query(const struct pair_query *query, unsigned char out[QUERY_BYTES_MAX])
{
    struct writer writer = writer_begin(out, QUERY_BYTES_MAX, __fmb_msgs_pair_query_t_get_hash());
    wire_write_ids(&writer, &query->header);
    writer_double(&writer, query->duration);
    writer_int32(&writer, query->method);
    writer_int32(&writer, query->want);
    wire_write_placement(&writer, &query->placement[0]);
    wire_write_placement(&writer, &query->placement[1]);
    return writer_end(&writer, out);
}

static void write_box(struct writer *writer, const struct pair_result *result)
{
    const int dim = result->answer.has_box ? result->dim : 0;
    writer_int32(writer, 2 * dim);
    for (int side = 0; side < 2; side++)
        for (int axis = 0; axis < dim; axis++)
            writer_double(writer, result->answer.box[side][axis]);
}

size_t wire_write_pair_result(const struct pair_result *result, unsigned char out[QUERY_BYTES_MAX])
{
    struct writer writer = writer_begin(out, QUERY_BYTES_MAX, __fmb_msgs_pair_result_t_get_hash());
    wire_write_ids(&writer, &result->header);
    writer_int64(&writer, result->server_id);
    for (int f = 0; f < 2; f++)
        writer_int64(&writer, result->body_id[f]);
    for (int f = 0; f < 2; f++)
        wire_write_handle(&writer, &result->handle[f]);
    writer_int32(&writer, result->status);
    writer_string(&writer, result->detail);
    writer_int32(&writer, result->method);
    writer_int32(&writer, (int32_t) result->answer.verdict);
    writer_doubles(&writer, result->answer.contact, result->answer.has_contact ? 2 : 0);
    write_box(&writer, result);
    writer_doubles(&writer, result->answer.point, result->answer.has_point ? 1 + result->dim : 0);
    wire_write_gaps(&writer, &result->answer.gap, 1, false, result->names_frames,
                    result->answer.has_gap ? result->dim : 0);
    wire_write_text(&writer, result->certificate);
    writer_int64(&writer, result->compute_ns);
    return writer_end(&writer, out);
}
