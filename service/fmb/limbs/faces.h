/* Two faces in parallel planes, which the slabs of a pair do not decide (slabs.h). No shared
 * state. */
#ifndef FMB_FACES_H
#define FMB_FACES_H

#include "integer.h"
#include "slabs.h"

/* Two faces that stay in one plane, projected along an axis that is not parallel to it: two
 * triangles in 2D with the same verdict and the same times of contact. */
struct faces_projection {
    struct fmb_frame frame[2];
    struct fmb_placement placement[2];
    struct frame_pair pair; /* of these */
};

enum faces_planes {
    FACES_CROSSING, /* the planes are not parallel */
    FACES_SHARED,   /* both are in one plane at all times: the projection is set */
    FACES_UNDECIDED /* neither, or unknown: decided by all slabs, or else by the programs */
};

/* Returns the relation of the planes of two faces.
 *
 * In:  pair        two faces with areas, in range
 *      slabs       the same pair, prepared
 *      span        of the pair: limbs_span_of()
 * Out: projection  set if FACES_SHARED is returned, otherwise unspecified; contains pointers into
 *                  itself and must not be copied */
enum faces_planes faces_planes_of(const struct frame_pair *pair, const struct slabs_pair *slabs,
                                  struct dyadic_span span, struct faces_projection *projection);

#endif
