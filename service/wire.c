#include "wire.h"

#include "fmb_msgs_pair_query_t.h"
#include "fmb_msgs_pair_result_t.h"
#include "fmb_msgs_status_t.h"

#include <assert.h>
#include <float.h>
#include <string.h>

static_assert(WIRE_RESULT_BYTES_MAX < 65000, "a result is one datagram");

/* The numbers of the messages are those of the engine. */
static_assert((int) FMB_CUBOID == FMB_MSGS_FRAME_T_SHAPE_CUBOID &&
                  (int) FMB_TETRAHEDRON == FMB_MSGS_FRAME_T_SHAPE_TETRAHEDRON &&
                  (int) FMB_FACE == FMB_MSGS_FRAME_T_SHAPE_FACE,
              "shapes");
static_assert((int) FMB_SEPARATED == FMB_MSGS_PAIR_RESULT_T_VERDICT_SEPARATED &&
                  (int) FMB_TOUCHING == FMB_MSGS_PAIR_RESULT_T_VERDICT_TOUCHING &&
                  (int) FMB_OVERLAPPING == FMB_MSGS_PAIR_RESULT_T_VERDICT_OVERLAPPING,
              "verdicts");
static_assert((int) QUERY_WANT_BOX == FMB_MSGS_PAIR_QUERY_T_WANT_BOX &&
                  (int) QUERY_WANT_CERTIFICATE == FMB_MSGS_PAIR_QUERY_T_WANT_CERTIFICATE,
              "wants");
#define X(name, number, text) \
    static_assert((int) FMB_##name == FMB_MSGS_PAIR_RESULT_T_STATUS_##name, text);
FMB_STATUS_MAP(X)
#undef X

/* ---- Reading ------------------------------------------------------------------------- */

/* A walk over bytes. The first error ends it: everything read after it is 0. */
struct cursor {
    const unsigned char *at;
    uint64_t left;
    const char *error;
};

static const char too_short[] = "shorter than its fields";

static bool take(struct cursor *cursor, uint64_t size, const unsigned char **bytes)
{
    if (!cursor->error && size > cursor->left)
        cursor->error = too_short;
    if (cursor->error)
        return false;
    *bytes = cursor->at;
    cursor->at += size;
    cursor->left -= size;
    return true;
}

static uint64_t read_unsigned(struct cursor *cursor, int size)
{
    const unsigned char *bytes;
    uint64_t value = 0;
    if (take(cursor, (uint64_t) size, &bytes))
        for (int i = 0; i < size; i++)
            value = value << 8 | bytes[i];
    return value;
}

static int64_t read_int64(struct cursor *cursor)
{
    return (int64_t) read_unsigned(cursor, 8);
}

static int32_t read_int32(struct cursor *cursor)
{
    return (int32_t) (uint32_t) read_unsigned(cursor, 4);
}

static double read_double(struct cursor *cursor)
{
    uint64_t bits = read_unsigned(cursor, 8);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* A count of things of at least size bytes each: they must be there. */
static int32_t read_count(struct cursor *cursor, uint64_t size)
{
    int32_t count = read_int32(cursor);
    if (!cursor->error && count < 0)
        cursor->error = "negative count";
    if (!cursor->error && (uint64_t) count * size > cursor->left)
        cursor->error = too_short;
    return cursor->error ? 0 : count;
}

/* The first max of count doubles that follow; all of them are walked. */
static void read_doubles(struct cursor *cursor, int32_t count, double *out, int max)
{
    for (int i = 0; i < count && i < max; i++)
        out[i] = read_double(cursor);
    const unsigned char *rest;
    if (count > max)
        take(cursor, (uint64_t) (count - max) * sizeof(double), &rest);
}

static void read_numbers(struct cursor *cursor, struct query_numbers *out)
{
    out->count = read_count(cursor, sizeof(double));
    read_doubles(cursor, out->count, out->number, FMB_COMPONENTS_MAX);
}

/* A string, where it stands in the message. Returns its length, without the final 0; after an
 * error 0, and *bytes is left alone. */
static size_t take_string(struct cursor *cursor, const unsigned char **bytes)
{
    int32_t size = read_count(cursor, 1);
    const unsigned char *at;
    if (!take(cursor, (uint64_t) size, &at))
        return 0;
    if (size == 0 || memchr(at, 0, (size_t) size) != at + size - 1) {
        cursor->error = "string without an end, or with two";
        return 0;
    }
    *bytes = at;
    return (size_t) size - 1;
}

/* ASCII; other bytes could do things to a terminal. */
static bool is_printable(unsigned char byte)
{
    return byte >= ' ' && byte < 0x7f;
}

/* A string; what does not fit into size bytes is cut, and what is not printable becomes '?'. */
static void read_string(struct cursor *cursor, char *out, size_t size)
{
    const unsigned char *bytes = NULL;
    size_t length = take_string(cursor, &bytes);
    size_t kept = length < size ? length : size - 1;
    for (size_t i = 0; i < kept; i++)
        out[i] = is_printable(bytes[i]) ? (char) bytes[i] : '?';
    out[kept] = '\0';
}

static struct cursor begin_reading(const void *bytes, uint32_t size, int64_t fingerprint)
{
    struct cursor cursor = {.at = bytes, .left = size};
    if (size > INT32_MAX)
        cursor.error = "size out of range";
    else if (read_int64(&cursor) != fingerprint && !cursor.error)
        cursor.error = "another message type, or another version of it";
    return cursor;
}

static const char *end_reading(const struct cursor *cursor)
{
    if (cursor->error)
        return cursor->error;
    return cursor->left ? "longer than its fields" : NULL;
}

static void read_frame(struct cursor *cursor, struct query_frame *frame)
{
    frame->body_id = read_int64(cursor);
    frame->key = read_int64(cursor);
    frame->shape = read_int32(cursor);
    read_numbers(cursor, &frame->origin);
    frame->dim = frame->origin.count;
    read_numbers(cursor, &frame->components);
    read_numbers(cursor, &frame->velocity);
}

const char *wire_read_pair_query(const void *bytes, uint32_t size, struct pair_query *out)
{
    struct cursor cursor = begin_reading(bytes, size, __fmb_msgs_pair_query_t_get_hash());
    memset(out, 0, sizeof *out);
    out->utime = read_int64(&cursor);
    out->client_id = read_int64(&cursor);
    out->sequence_number = read_int64(&cursor);
    out->duration = read_double(&cursor);
    out->method = read_int32(&cursor);
    out->want = read_int32(&cursor);
    read_frame(&cursor, &out->frame[0]);
    read_frame(&cursor, &out->frame[1]);
    return end_reading(&cursor);
}

/* Lower ends of all axes, then the upper ends. */
static void read_box(struct cursor *cursor, struct pair_result *out)
{
    int32_t count = read_count(cursor, sizeof(double));
    double ends[2 * FMB_DIM_MAX] = {0};
    read_doubles(cursor, count, ends, 2 * FMB_DIM_MAX);
    if (!cursor->error && count != 0 && count != 4 && count != 6)
        cursor->error = "a box of neither 4 nor 6 numbers";
    out->dim = count / 2;
    out->answer.has_box = count > 0;
    for (int side = 0; side < 2 && !cursor->error; side++)
        for (int axis = 0; axis < out->dim; axis++)
            out->answer.box[side][axis] = ends[side * out->dim + axis];
    for (int axis = 0; axis < FMB_DIM_MAX && !cursor->error; axis++)
        if (!(out->answer.box[0][axis] <= out->answer.box[1][axis]))
            cursor->error = "a box that is no box";
}

static void read_contact(struct cursor *cursor, struct fmb_answer *out)
{
    int32_t count = read_count(cursor, sizeof(double));
    read_doubles(cursor, count, out->contact, 2);
    if (!cursor->error && count != 0 && count != 2)
        cursor->error = "a contact interval of neither 0 nor 2 numbers";
    if (!cursor->error &&
        !(0 <= out->contact[0] && out->contact[0] <= out->contact[1] && out->contact[1] <= DBL_MAX))
        cursor->error = "a contact interval that is no interval";
    out->has_contact = count > 0;
}

static void read_certificate(struct cursor *cursor, struct pair_result *out)
{
    const unsigned char *bytes = NULL;
    size_t length = take_string(cursor, &bytes);
    if (length == 0)
        return;
    if (out->status != FMB_OK)
        cursor->error = "a certificate without a verdict";
    if (length >= QUERY_CERTIFICATE_MAX)
        cursor->error = "a certificate that is too long";
    for (size_t i = 0; i < length && !cursor->error; i++)
        if (!is_printable(bytes[i]))
            cursor->error = "a certificate that is not printable";
    out->certificate = (const char *) bytes;
}

const char *wire_read_pair_result(const void *bytes, uint32_t size, struct pair_result *out)
{
    struct cursor cursor = begin_reading(bytes, size, __fmb_msgs_pair_result_t_get_hash());
    memset(out, 0, sizeof *out);
    out->utime = read_int64(&cursor);
    out->client_id = read_int64(&cursor);
    out->sequence_number = read_int64(&cursor);
    out->server_id = read_int64(&cursor);
    for (int f = 0; f < 2; f++)
        out->body_id[f] = read_int64(&cursor);
    for (int f = 0; f < 2; f++)
        out->key[f] = read_int64(&cursor);
    out->status = read_int32(&cursor);
    read_string(&cursor, out->detail, sizeof out->detail);
    out->method = read_int32(&cursor);
    int32_t verdict = read_int32(&cursor);
    if (!cursor.error && (out->status == FMB_OK) != (fmb_verdict_name(verdict) != NULL))
        cursor.error = "verdict and status do not go together";
    out->answer.verdict = (enum fmb_verdict) verdict;
    read_contact(&cursor, &out->answer);
    read_box(&cursor, out);
    read_certificate(&cursor, out);
    out->compute_ns = read_int64(&cursor);
    return end_reading(&cursor);
}

/* A counted list of numbers, of which the first max are kept. */
static void read_int64s(struct cursor *cursor, int64_t *out, int max)
{
    int32_t count = read_count(cursor, sizeof(int64_t));
    for (int i = 0; i < count; i++) {
        int64_t number = read_int64(cursor);
        if (i < max)
            out[i] = number;
    }
}

const char *wire_read_status(const void *bytes, uint32_t size, struct wire_status *out)
{
    struct cursor cursor = begin_reading(bytes, size, __fmb_msgs_status_t_get_hash());
    memset(out, 0, sizeof *out);
    out->utime = read_int64(&cursor);
    out->server_id = read_int64(&cursor);
    read_string(&cursor, out->version, sizeof out->version);
#define X(name) out->name = read_int64(&cursor);
    WIRE_COUNTERS_BEFORE(X)
    read_int64s(&cursor, out->results, FMB_STATUS_COUNT);
    WIRE_COUNTERS_AFTER(X)
#undef X
    read_int64s(&cursor, NULL, 0); /* more */
    return end_reading(&cursor);
}

/* ---- Writing: by the generated encoders ------------------------------------------------ */

/* What an encoder returns: -1 where there is no room. */
static size_t written(int size)
{
    assert(size > 0);
    return (size_t) size;
}

/* The generated structs do not know const. */
static fmb_msgs_frame_t message_of_frame(const struct query_frame *frame)
{
    return (fmb_msgs_frame_t){
        .body_id = frame->body_id,
        .key = frame->key,
        .shape = frame->shape,
        .dim = frame->origin.count,
        .origin = (double *) frame->origin.number,
        .num_components = frame->components.count,
        .components = (double *) frame->components.number,
        .num_velocity = frame->velocity.count,
        .velocity = (double *) frame->velocity.number,
    };
}

size_t wire_write_pair_query(const struct pair_query *query, unsigned char out[WIRE_BYTES_MAX])
{
    fmb_msgs_pair_query_t message = {
        .utime = query->utime,
        .client_id = query->client_id,
        .sequence_number = query->sequence_number,
        .duration = query->duration,
        .method = query->method,
        .want = query->want,
        .a = message_of_frame(&query->frame[0]),
        .b = message_of_frame(&query->frame[1]),
    };
    return written(fmb_msgs_pair_query_t_encode(out, 0, WIRE_BYTES_MAX, &message));
}

size_t wire_write_pair_result(const struct pair_result *result,
                              unsigned char out[WIRE_RESULT_BYTES_MAX])
{
    double box[2 * FMB_DIM_MAX];
    int dim = result->answer.has_box ? result->dim : 0;
    for (int side = 0; side < 2; side++)
        for (int axis = 0; axis < dim; axis++)
            box[side * dim + axis] = result->answer.box[side][axis];
    fmb_msgs_pair_result_t message = {
        .utime = result->utime,
        .client_id = result->client_id,
        .sequence_number = result->sequence_number,
        .server_id = result->server_id,
        .body_a = result->body_id[0],
        .body_b = result->body_id[1],
        .key_a = result->key[0],
        .key_b = result->key[1],
        .status = result->status,
        .detail = (char *) result->detail,
        .method = result->method,
        .verdict = (int32_t) result->answer.verdict,
        .num_contact = result->answer.has_contact ? 2 : 0,
        .contact = (double *) result->answer.contact,
        .num_box = 2 * dim,
        .box = box,
        .certificate = (char *) (result->certificate ? result->certificate : ""),
        .compute_ns = result->compute_ns,
    };
    return written(fmb_msgs_pair_result_t_encode(out, 0, WIRE_RESULT_BYTES_MAX, &message));
}

size_t wire_write_status(const struct wire_status *status, unsigned char out[WIRE_BYTES_MAX])
{
    fmb_msgs_status_t message = {.utime = status->utime,
                                 .server_id = status->server_id,
                                 .version = (char *) status->version,
                                 .num_results = FMB_STATUS_COUNT,
                                 .results = (int64_t *) status->results,
#define X(name) .name = status->name,
                                 WIRE_COUNTERS_BEFORE(X) WIRE_COUNTERS_AFTER(X)
#undef X
    };
    return written(fmb_msgs_status_t_encode(out, 0, WIRE_BYTES_MAX, &message));
}
