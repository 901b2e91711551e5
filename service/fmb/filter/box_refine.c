/* Boxes of groups of lanes in which kernel_box.h does not find all: the second pass of the search
 * (box_search.h), and for moving cuboids their edges (box_clip.h). One function for all kinds of
 * pairs, which is seldom called, and not worth what inlining takes. */
#include "kernel_box.h"

void KERNEL_PASTE(refine, KERNEL_NAME)(struct box_refinement *refinement)
{
    const struct kernel_traits given = refinement->traits;
    const struct kernel_traits traits = {.dim = given.dim,
                                         .simplex = {given.simplex[0], given.simplex[1]},
                                         .face = {given.face[0], given.face[1]},
                                         .drifts = given.drifts,
                                         .box = true};
    struct box_search search;
    begin_box(&refinement->pair, traits, &refinement->places, &search);
    refinement->good = search_box(&refinement->pair, traits, &refinement->places, true, &search,
                                  &refinement->left_out, refinement->box);
    const bool clipped_before = !traits.drifts || (traits.simplex[0] && traits.simplex[1]);
    if (is_known(refinement->good, &refinement->pair) || !can_be_clipped(traits) || clipped_before)
        return;
    lanes box[2][3];
    const lanes_mask more = clip_box(&refinement->pair, traits, &refinement->places, &search, box);
    refinement->good = join_boxes(traits, more, box, refinement->good, refinement->box);
}
