/* Encodes bodies from the frames that the codec reads. The product has only the client library's
 * encoder, of the frames of its users. */
#ifndef GEOMETRY_WRITE_H
#define GEOMETRY_WRITE_H

#include "geometry.h"

/* Bytes of a geometry of these frames. On input: dim; shapes of that dimension. The other fields of
 * the frames are not read. */
size_t geometry_size(int dim, const struct geometry_frame *frames, int count);

/* Encodes a body. On input: frames as for geometry_size(), with their numbers; out has
 * geometry_size() bytes. Returns this size. */
size_t geometry_write_frames(int dim, const struct geometry_frame *frames, int count,
                             unsigned char *out);

/* The same for one frame. */
size_t geometry_write(int dim, const struct geometry_frame *frame,
                      unsigned char out[GEOMETRY_FRAME_BYTES_MAX]);

#endif
