/* What queries of all types have: a header and frames. For wire_pair.c and wire_scene.c. */
#ifndef WIRE_FRAME_H
#define WIRE_FRAME_H

#include "cursor.h"
#include "wire.h"

#include "fmb_msgs_frame_t.h"

/* Bytes of a frame without numbers. */
enum { WIRE_FRAME_BYTES_MIN = 32 };

const char *wire_read_header(const void *bytes, uint32_t size, int64_t fingerprint,
                             struct query_header *out);

void wire_read_frame(struct cursor *cursor, struct query_frame *out);

/* For the generated encoders, which do not know const. Points into the frame. */
fmb_msgs_frame_t wire_frame_message(const struct query_frame *frame);

#endif
