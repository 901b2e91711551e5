#include "wire_frame.h"

#include <string.h>

/* Of what is too short, or of another type: what comes first of both. */
static const char *read_wrong_header(const void *bytes, uint32_t size, int64_t fingerprint,
                                     struct query_header *out)
{
    struct cursor cursor = cursor_begin(bytes, size, fingerprint);
    out->utime = cursor_int64(&cursor);
    out->client_id = cursor_int64(&cursor);
    out->sequence_number = cursor_int64(&cursor);
    return cursor.error;
}

const char *wire_read_header(const void *bytes, uint32_t size, int64_t fingerprint,
                             struct query_header *out)
{
    const unsigned char *at = bytes;
    if (size < 32 || size > INT32_MAX || (int64_t) big_endian_64(at) != fingerprint)
        return read_wrong_header(bytes, size, fingerprint, out);
    out->utime = (int64_t) big_endian_64(at + 8);
    out->client_id = (int64_t) big_endian_64(at + 16);
    out->sequence_number = (int64_t) big_endian_64(at + 24);
    return NULL;
}

/* The first numbers of a list, which may be of any length; 0 beyond them. */
static void read_numbers(struct cursor *cursor, struct query_numbers *out)
{
    memset(out, 0, sizeof *out);
    out->count = cursor_doubles(cursor, out->number, FMB_COMPONENTS_MAX);
}

void wire_read_frame(struct cursor *cursor, struct query_frame *out)
{
    struct cursor own = *cursor;
    out->body_id = cursor_int64(&own);
    out->key = cursor_int64(&own);
    out->shape = cursor_int32(&own);
    read_numbers(&own, &out->origin);
    out->dim = out->origin.count;
    read_numbers(&own, &out->components);
    read_numbers(&own, &out->velocity);
    *cursor = own;
}

void wire_write_frame(struct writer *writer, const struct query_frame *frame)
{
    writer_int64(writer, frame->body_id);
    writer_int64(writer, frame->key);
    writer_int32(writer, frame->shape);
    writer_doubles(writer, frame->origin.number, frame->origin.count);
    writer_doubles(writer, frame->components.number, frame->components.count);
    writer_doubles(writer, frame->velocity.number, frame->velocity.count);
}

size_t wire_frame_bytes(const struct query_frame *frame)
{
    const int numbers = frame->origin.count + frame->components.count + frame->velocity.count;
    return WIRE_FRAME_BYTES_MIN + sizeof(double) * (size_t) numbers;
}
