/* Computes pairs by their vertices in numbers that carry bounds on their errors, and compares these
 * with the bounds of service/fmb/support: what check_gap() does for gaps. */
#ifndef CHECKED_HULLS_H
#define CHECKED_HULLS_H

#ifdef __cplusplus
extern "C" {
#endif

/* The fields of a frame and of its placement. */
struct checked_vertices {
    int shape, dim, count, flat, orientation_count;
    const double *vertices;
    unsigned vertex_count, vertex_stride, spanning[4];
    double origin[3], component[3][3], slack, reach;
    double position[3], velocity[3], orientation[4];
    int end_count;
    double end_position[3], end_orientation[4];
};

void check_hulls(const struct checked_vertices pair[2], double duration);

/* Checks a pair in which a placement has an end: poses, boxes and polynomials over intervals, with
 * the bounds of service/fmb/turn and of motion.h. */
void check_turns(const struct checked_vertices pair[2], double duration);

#ifdef __cplusplus
}
#endif

#endif
