/* Frames for tests of them. Include cmocka.h first. */
#ifndef FRAME_MAKE_H
#define FRAME_MAKE_H

#include "fmb.h"

#include <string.h>

static const double unit2[4] = {1, 0, 0, 1};
/* More numbers than any frame takes follow its nine. */
static const double unit3[16] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

/* A frame of components, with its origin at 0. */
static inline struct fmb_frame make(int dim, int shape, const double *number)
{
    struct fmb_frame frame;
    memset(&frame, 0xa5, sizeof frame); /* what is not written shows */
    const size_t count = (size_t) (fmb_component_count(dim, shape) * dim);
    assert_int_equal(fmb_frame_make(dim, shape, number, count, &frame), FMB_OK);
    return frame;
}

/* A body of one cuboid. */
static inline struct fmb_body make_body(int dim, const double *number)
{
    struct fmb_body body;
    memset(&body, 0xa5, sizeof body); /* what is not written shows */
    assert_int_equal(fmb_body_make(dim, FMB_CUBOID, number, (size_t) (dim * dim), &body), FMB_OK);
    return body;
}

#endif
