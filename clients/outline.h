/* The corners and faces of a frame, to be drawn. Doubles as they come: nothing is decided here. */
#ifndef OUTLINE_H
#define OUTLINE_H

#include "scene.h"

enum { OUTLINE_CORNERS_MAX = 8, OUTLINE_FACES_MAX = 6, OUTLINE_FACE_CORNERS_MAX = 4 };

struct outline_face {
    int count;                            /* of corners */
    int corner[OUTLINE_FACE_CORNERS_MAX]; /* indices, around the face */
};

struct outline {
    int corner_count, face_count;                    /* in 2D: one face, the frame itself */
    double corner[OUTLINE_CORNERS_MAX][FMB_DIM_MAX]; /* world; z = 0 in 2D; infinite where beyond
                                                        the largest double */
    double centre[FMB_DIM_MAX];                      /* of the corners */
    const struct outline_face *face;
};

/* Frame `index` of a body at this time, in seconds. */
struct outline outline_make(const struct scene_body *body, unsigned index, double time);

/* The same of an axis-aligned box. */
struct outline outline_box(int dim, const double low[FMB_DIM_MAX], const double high[FMB_DIM_MAX]);

#endif
