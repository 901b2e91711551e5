/* The second pass of boxes (box_search.h), for groups of lanes in which the first does not give
 * all: one function for all kinds of pairs, which is seldom called, and not worth what inlining
 * takes. */
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
}
