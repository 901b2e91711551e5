/* What queries of all types have: a header and frames. For wire_pair.c and wire_scene.c. */
#ifndef WIRE_FRAME_H
#define WIRE_FRAME_H

#include "cursor.h"
#include "wire.h"
#include "writer.h"

/* Bytes of a frame without numbers. */
enum { WIRE_FRAME_BYTES_MIN = 32 };

const char *wire_read_header(const void *bytes, uint32_t size, int64_t fingerprint,
                             struct query_header *out);

/* Numbers beyond the counts are 0. */
void wire_read_frame(struct cursor *cursor, struct query_frame *out);

void wire_write_frame(struct writer *writer, const struct query_frame *frame);

#endif
