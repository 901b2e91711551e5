/* Projects the world to the paper.
 *
 * 2D: the plane, y up. 3D: an axonometric projection, seen from the front, right and above, z up.
 * Both have the same scale along all axes. Numbers may have any size: coordinates are limited to an
 * eighth of the largest double, so that sums of a few are finite, and mapped to [-1, 1] about the
 * middle of the visible region. What lies outside, such as an infinite end of a box, is clipped. */
#ifndef VIEW_H
#define VIEW_H

#include "fmb.h"

/* ---- The corners and faces of a frame, in doubles: for pictures only ---- */

enum { OUTLINE_CORNERS_MAX = 8, OUTLINE_FACES_MAX = 6, OUTLINE_FACE_CORNERS_MAX = 4 };

struct outline_face {
    int count;                            /* of corners */
    int corner[OUTLINE_FACE_CORNERS_MAX]; /* indices, around the face */
};

struct outline {
    int corner_count, face_count;                    /* in 2D: one face, the frame itself */
    bool flat;                                       /* no face is turned away from the viewer */
    double corner[OUTLINE_CORNERS_MAX][FMB_DIM_MAX]; /* world; z = 0 in 2D; limited */
    double centre[FMB_DIM_MAX];                      /* of the corners */
    const struct outline_face *face;
};

/* Returns frame `index` of a body at a time, in seconds. */
struct outline outline_make(const struct fmb_placement *placement, unsigned index, double time);

/* Returns an axis-aligned box. */
struct outline outline_box(int dim, const double low[FMB_DIM_MAX], const double high[FMB_DIM_MAX]);

/* ---- The view ---- */

/* The visible region: in the world, and of its projection, right and up on the paper. */
struct view_bounds {
    double low[FMB_DIM_MAX], high[FMB_DIM_MAX];
    double paper_low[2], paper_high[2];
};

struct view_bounds view_nothing(void);
void view_add(struct view_bounds *bounds, const struct outline *outline, int dim);
void view_join(struct view_bounds *bounds, const struct view_bounds *other);

struct paper {
    double x, y, width, height; /* pixels */
};

struct view {
    int dim;
    double centre[FMB_DIM_MAX], radius;         /* world; radius > 0 */
    double low[FMB_DIM_MAX], high[FMB_DIM_MAX]; /* of the bounds, in [-1, 1] */
    double scale, x, y; /* from the projection to the paper: pixels, y down */
    struct paper paper;
};

/* Returns the view in which the bounds fill the paper. */
struct view view_make(int dim, const struct view_bounds *bounds, struct paper paper);

/* Pixels, y down; depth grows towards the viewer, 0 in 2D. All finite. */
struct point {
    double x, y, depth;
};

/* Returns the projection of a point of the world, clipped to the visible region. */
struct point view_point(const struct view *view, const double world[FMB_DIM_MAX]);

/* The same for a point in unit coordinates, [-1, 1], without clipping. */
struct point view_unit_point(const struct view *view, const double unit[FMB_DIM_MAX]);

/* Returns the cosine, 0 to 1, of the angle between the light and the normal of a face with the
 * corners a, b, c; 0.5 if it has no area. */
double view_light(const struct view *view, const double a[FMB_DIM_MAX], const double b[FMB_DIM_MAX],
                  const double c[FMB_DIM_MAX]);

#endif
