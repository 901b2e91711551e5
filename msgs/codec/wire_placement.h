/* Parts that several message types share: header, placement, handles, geometry, gaps. Readers set
 * the error of the cursor. Private to wire_*.c. */
#ifndef WIRE_PLACEMENT_H
#define WIRE_PLACEMENT_H

#include "cursor.h"
#include "wire.h"
#include "writer.h"

/* The fields with which all queries and results begin, after the fingerprint. */
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

/* Reads the fingerprint and these fields of a message, and ignores the remainder. Returns NULL, or
 * what is wrong. */
const char *wire_read_header(const void *bytes, uint32_t size, int64_t fingerprint,
                             struct query_header *out);

void wire_read_placement(struct cursor *cursor, struct query_placement *out);

void wire_write_placement(struct writer *writer, const struct query_placement *placement);

void wire_read_handle(struct cursor *cursor, struct handle *out);

void wire_write_handle(struct writer *writer, const struct handle *handle);

/* Reads a count of bytes, and the handles in them. The first max are stored. Returns the number of
 * handles of the message, which may exceed max. */
int32_t wire_read_handles(struct cursor *cursor, struct handle *out, int max);

void wire_write_handles(struct writer *writer, const struct handle *handles, int32_t count);

/* Read and write a body: its handle, and the fields dim to numbers. On output: *out, whose bytes
 * point into the message. The counts are not checked for consistency. */
void wire_read_body(struct cursor *cursor, struct body_view *out);
void wire_write_body(struct writer *writer, const struct body_view *body);

/* Writes a text; NULL is "". */
static inline void wire_write_text(struct writer *writer, const char *text)
{
    writer_string(writer, text ? text : "");
}

/* Whether the time is finite and at least 0, and no coordinate is NaN; coordinates may be infinite.
 * In: point: a time and count - 1 coordinates. */
bool wire_is_point(const double *point, int count);

/* Reads the lists of gaps: bounds, directions, witnesses, frames. There is a gap for each of count
 * verdicts, or for none. padded: whether a gap without witness points has NaN in their place, as in
 * scenes; if not, count is 1, and the list of witnesses is empty for such a gap. *names_frames:
 * whether frames are present. Returns the dimension of the gaps; 0: there are none. */
int wire_read_gaps(struct cursor *cursor, const unsigned char *verdict, int32_t count, bool padded,
                   bool *names_frames, struct fmb_gap *out);

/* Writes the lists of gaps. On input: as above; dim 0: there are none. */
void wire_write_gaps(struct writer *writer, const struct fmb_gap *gap, int32_t count, bool padded,
                     bool names_frames, int dim);

#endif
