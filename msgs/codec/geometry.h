/* Reads encoded bodies frame by frame. No shared state. */
#ifndef GEOMETRY_H
#define GEOMETRY_H

#include "query.h"

/* A shape as messages number it: one of enum fmb_shape, given by origin and components, or by its
 * vertices. */
struct geometry_shape {
    int shape; /* enum fmb_shape; 0: there is no such shape */
    bool by_vertices;
};

/* Convert to and from a value of placement_t.shapes. In: geometry_code(): a known shape that may
 * be given in this way. */
struct geometry_shape geometry_shape(int code);
int geometry_code(int shape, bool by_vertices);

/* Number of numbers of a frame in a geometry: of origin or centre, and components; or of its
 * vertices. code: a value of placement_t.shapes. vertices: the number of them; read for hulls only,
 * since that of other shapes is fixed. 0: there is no such shape in this dimension. */
int64_t geometry_number_count(int dim, int code, int32_t vertices);

/* One frame of a geometry, in body coordinates. */
struct geometry_frame {
    int shape; /* enum fmb_shape, no hull; not checked */
    bool by_vertices;
    double origin[FMB_DIM_MAX]; /* for a box, its centre; by vertices, the first one */
    /* [component * dim + axis]; for a box [axis], its full size; by vertices, the others */
    double components[FMB_COMPONENTS_MAX];
};

/* Writes the numbers of a frame one after the other, as fmb_frame_make() and
 * fmb_frame_make_vertices() take them. Returns how many there are; 0: there is no such shape in
 * this dimension. */
size_t geometry_frame_numbers(int dim, const struct geometry_frame *frame,
                              double out[FMB_FRAME_NUMBERS_MAX]);

/* Encodes the geometry of a placement that names its body by handle: dim, and no frames. */
void geometry_write_none(int dim, unsigned char out[GEOMETRY_NONE_BYTES]);

/* Iterator over the frames of a geometry. */
struct geometry_reader {
    int dim;                                     /* not checked */
    int32_t frames_left;                         /* 0 or more; not checked */
    int32_t counts_left;                         /* 0 or more; not checked */
    int32_t numbers_left;                        /* 0 or more; not checked */
    const unsigned char *shape, *count, *number; /* the next ones, encoded */
};

/* Begins at the first frame. On input: a geometry that wire.h has decoded, or that was written by
 * the functions above. It must outlive the reader. */
struct geometry_reader geometry_begin(const struct geometry *geometry);

/* Reads the next frame. Returns false if there are no more; or if it is a hull, or there is no such
 * shape in this dimension, or its number of vertices is wrong, or too few counts or numbers are
 * left. Counts and numbers that are left after the last frame are ignored. */
bool geometry_next(struct geometry_reader *reader, struct geometry_frame *out);

#endif
