/* Boxes in fixed-width integers. No shared state. */
#ifndef FMB_LIMBS_BOX_H
#define FMB_LIMBS_BOX_H

#include "prepared.h"

/* Computes the box of two prepared frames in contact, with integers of at most so many limbs.
 * Returns false, with box unspecified, if that does not suffice, or a frame is flat and not a face.
 * Allocates nothing. */
bool limbs_box(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration,
               int limbs_most, double box[2][FMB_DIM_MAX]);

#endif
