/* Parts that messages share: header, placement, handles, geometry, gaps. Private to wire_*.c. */
#ifndef WIRE_PLACEMENT_H
#define WIRE_PLACEMENT_H

#include "cursor.h"
#include "wire.h"
#include "writer.h"

/* The fields that all queries and results begin with, after the fingerprint. */
static inline void wire_read_ids(struct cursor *cursor, struct query_header *out)
{
    out->utime = cursor_int64(cursor);
    out->client_id = cursor_int64(cursor);
    out->sequence_number = cursor_int64(cursor);
}

static inline void wire_write_ids(struct writer *writer, const struct query_header *header)
{
    writer_int64(writer, header->utime);
    writer_int64(writer, header->client_id);
    writer_int64(writer, header->sequence_number);
}

/* Reads the same of a message, and ignores the remainder. */
const char *wire_read_header(const void *bytes, uint32_t size, int64_t fingerprint,
                             struct query_header *out);

void wire_read_placement(struct cursor *cursor, struct placement *out);

void wire_write_placement(struct writer *writer, const struct placement *placement);

void wire_read_handle(struct cursor *cursor, struct handle *out);

void wire_write_handle(struct writer *writer, const struct handle *handle);

/* A count of bytes and the handles in them: all are read, the first max are stored. Returns the
 * number of handles. */
int32_t wire_read_handles(struct cursor *cursor, struct handle *out, int max);

void wire_write_handles(struct writer *writer, const struct handle *handles, int32_t count);

/* The fields dim to numbers. On output: *frames and *numbers are their counts. */
void wire_read_geometry(struct cursor *cursor, struct geometry *out, int32_t *dim, int32_t *frames,
                        int32_t *numbers);

/* The lists of gaps: bounds, directions, witnesses. There are gaps of all verdicts or of none, and
 * witnesses of as many as the message type has, whether they are separated or not. Returns the
 * dimension; 0: there are none. */
int wire_read_gaps(struct cursor *cursor, const unsigned char *verdict, int32_t count,
                   int32_t witnesses, struct fmb_gap *out);

/* dim is 0 where there are none. */
void wire_write_gaps(struct writer *writer, const struct fmb_gap *gap, int32_t count,
                     int32_t witnesses, int dim);

#endif
