/* Encodes bodies of frames as they are written down in tests. The product has only the client
 * library's encoder, of the frames of its users. */
#ifndef GEOMETRY_WRITE_H
#define GEOMETRY_WRITE_H

#include "geometry.h"

/* A frame that is no hull, in body coordinates. */
struct plain_frame {
    int shape; /* enum fmb_shape */
    bool by_vertices, has_radius;
    double radius;              /* if it has one */
    double origin[FMB_DIM_MAX]; /* for a box, its centre; by vertices, the first one */
    /* [component * dim + axis]; for a box [axis], its full size; by vertices, the others */
    double components[FMB_COMPONENTS_MAX];
};

/* The numbers of a frame one after the other, as fmb_frame_make() and fmb_frame_make_vertices()
 * take them. Returns how many there are; 0: there is no such shape in this dimension. */
size_t geometry_frame_numbers(int dim, const struct plain_frame *frame,
                              double out[FMB_FRAME_NUMBERS_MAX]);

/* geometry_next() for a frame that is no hull. */
bool geometry_read(struct geometry_reader *reader, struct plain_frame *out);

/* Bytes of a body of these frames. On input: dim; shapes of that dimension. The other fields of the
 * frames are not read. */
size_t geometry_size(int dim, const struct plain_frame *frames, int count);

/* Encodes a body. On input: frames as for geometry_size(), with their numbers; out has
 * geometry_size() bytes. Returns the body, which points to out. */
struct body_view geometry_write_frames(int dim, const struct plain_frame *frames, int count,
                                       unsigned char *out);

/* The same for one frame. */
struct body_view geometry_write(int dim, const struct plain_frame *frame,
                                unsigned char out[GEOMETRY_FRAME_BYTES_MAX]);

/* A body of one hull. On input: [count][dim]; out has GEOMETRY_NONE_BYTES + 5 + 8 * dim * count
 * bytes. */
struct body_view geometry_write_hull(int dim, const double *vertices, int count,
                                     unsigned char *out);

#endif
