/* The inverse of a frame in integers. */
#ifndef FMB_INVERSE_H
#define FMB_INVERSE_H

#include "fmb.h"

/* Computes the inverse of a frame of dim components, the exact ones, component + remainder. Every
 * entry is the largest double that is not above the exact one, infinite beyond the range of
 * doubles. Returns false if the frame is exactly flat and has no inverse. */
bool inverse_set(struct fmb_frame *frame);

#endif
