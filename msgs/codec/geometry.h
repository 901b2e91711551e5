/* Reads encoded bodies frame by frame. No shared state. */
#ifndef GEOMETRY_H
#define GEOMETRY_H

#include "query.h"

/* A shape as messages number it: one of enum fmb_shape, given by origin and components, or by its
 * vertices. */
struct geometry_shape {
    int shape; /* enum fmb_shape; 0: there is no such shape */
    bool by_vertices, has_radius;
};

/* Convert to and from a value of placement_t.shapes. In: geometry_code(): a known shape that may
 * be given in this way. */
struct geometry_shape geometry_shape(int code);
int geometry_code(struct geometry_shape shape);

/* Returns how many numbers a frame has in a body: the radius, if it has one, and either origin or
 * centre and components, or the vertices. 0: there is no such shape in this dimension.
 *
 * In:  code      a value of placement_t.shapes
 *      vertices  the number of vertices; read for hulls only: other shapes have a fixed number
 */
int64_t geometry_number_count(int dim, int code, int32_t vertices);

/* A body that is given by its handle. In: dim from 0 to 3. */
struct body_view geometry_named(int dim, const struct handle *handle);

/* One frame of a body, in body coordinates. */
struct geometry_frame {
    int shape; /* enum fmb_shape */
    bool by_vertices;
    double radius;               /* 0: none; not checked */
    size_t count;                /* of its numbers, without the radius */
    const unsigned char *number; /* [count], encoded, not checked */
};

/* Decodes the numbers of a frame, as fmb_frame_make() and fmb_frame_make_vertices() take them. */
void geometry_numbers(const struct geometry_frame *frame, double *out);

/* Iterator over the frames of a body. */
struct geometry_reader {
    int dim;                                     /* not checked */
    int32_t frames_left;                         /* 0 or more; not checked */
    int32_t counts_left;                         /* 0 or more; not checked */
    int32_t numbers_left;                        /* 0 or more; not checked */
    const unsigned char *shape, *count, *number; /* the next ones, encoded */
};

/* Begins at the first frame. On input: a body that wire.h has decoded, or one that was written with
 * its counts. Its bytes must outlive the reader. */
struct geometry_reader geometry_begin(const struct body_view *body);

/* Reads the next frame. Returns false if there are no more; or if there is no such shape in this
 * dimension, or its number of vertices is wrong, or too few counts or numbers are left. Counts and
 * numbers that are left after the last frame are ignored. */
bool geometry_next(struct geometry_reader *reader, struct geometry_frame *out);

#endif
