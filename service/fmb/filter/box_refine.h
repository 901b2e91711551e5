/* The last ways to find boxes, of groups of lanes that kernel_box.h leaves open: the second pass of
 * search_box(), then clip_box() for moving pairs with a cuboid. One function for all kinds of
 * pairs: it is called seldom, and inlining it would not pay. */
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
    if (all_good(refinement->good, &refinement->pair) ||
        !(can_be_clipped(traits) && is_clipped_last(traits)))
        return;
    lanes box[2][3];
    const lanes_mask more = clip_box(&refinement->pair, traits, &refinement->places, &search, box);
    refinement->good = join_boxes(traits, more, box, refinement->good, refinement->box);
}
