/* Checks contacts, boxes and points of pairs whose frames may have radii, as far as rational
 * numbers allow. The exact ends of a contact may be irrational. */
#ifndef ROUNDED_H
#define ROUNDED_H

#include "fmb.h"
#include "placed_pair.h"

/* Returns what is wrong with a contact, or NULL if it contains all times at which frames meet, and
 * each end is at most 1e-12 of the window, or one double, too far out. In: ends within the window.
 */
const char *rounded_contact_fault(const struct pair *pair, const double contact[2]);

/* Returns what is wrong with a box, or NULL if
 *
 *   - it contains a sample of the points that the bodies have in common, which includes the common
 *     points of the cores, and the extreme points of a frame that are in the other frame;
 *   - it is within the smallest box that contains, for each pair of frames that meet, the
 *     intersection of the boxes of both frames over the contact, up to 1e-12 of the largest
 *     coordinate and of both reaches. This is checked only if the largest coordinate is at most
 *     2^1020: sums of larger components may exceed the doubles.
 *
 * In: a contact without a fault; a box without NAN. */
const char *rounded_box_fault(const struct pair *pair, const double contact[2],
                              const double box[2][FMB_DIM_MAX]);

/* Returns what is wrong with a time and a point of bodies, with or without radii, that have this
 * verdict; or NULL if two frames with this verdict have a common point within 1e-12 of the largest
 * coordinate of it, at a time within 1e-12 of the window, or the next double.
 *
 * Coordinates beyond the doubles are infinite; such a point is not checked.
 *
 * Of overlapping frames with radii, three candidates for the common point are tried: the point
 * itself; the point moved by the limit towards a core; and the point between the nearest points of
 * both cores, in the ratio of the radii. The given point must be within the limit of each frame. */
const char *rounded_point_fault(const struct pair *pair, enum fmb_verdict verdict,
                                const double point[1 + FMB_DIM_MAX]);

#endif
