/* Contacts, boxes and points of pairs whose frames may have radii: what can be known of them in
 * rational numbers. */
#ifndef ROUNDED_H
#define ROUNDED_H

#include "fmb.h"
#include "placed_pair.h"

/* What is wrong with a contact whose ends are within the window; NULL: it contains all times at
 * which frames meet, and each end is at most 1e-12 of the window, or one double, too far out. */
const char *rounded_contact_fault(const struct pair *pair, const double contact[2]);

/* What is wrong with a box of numbers; NULL: it contains a sample of the points that the bodies
 * have in common, the cores' own and the extreme ones of a frame that are in the other among them;
 * and it is within the intersection of the boxes of both frames over the contact, for each pair of
 * frames that meet, up to 1e-12 of the largest coordinate and of both reaches, where that is at
 * most 2^1020: sums of larger components may exceed the doubles. The contact is one without a
 * fault. */
const char *rounded_box_fault(const struct pair *pair, const double contact[2],
                              const double box[2][FMB_DIM_MAX]);

/* The same of a time and a point, of bodies with or without radii, that have this verdict; NULL:
 * two frames with this verdict have a point within 1e-12 of the largest coordinate in common, at a
 * time within 1e-12 of the window, or the next double.
 *
 * Of frames with radii that overlap, it is one of these: the point itself; the point moved by that
 * much towards a core; the point between the nearest ones of both cores, in the ratio of the radii.
 * The point is no farther from each frame than that either. */
const char *rounded_point_fault(const struct pair *pair, enum fmb_verdict verdict,
                                const double point[1 + FMB_DIM_MAX]);

#endif
