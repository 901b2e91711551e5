/* The list of slabs of a pair (slabs.h), walked for LANES pairs at once. */
#ifndef FMB_WALK_H
#define FMB_WALK_H

#include "walk_plane.h"
#include "walk_space.h"

INLINE void walk_begin(struct walk_found *found)
{
    found->surely = lanes_of(-1);
    found->possibly = lanes_of(-INFINITY);
    found->enter[0] = found->enter[1] = lanes_of(-1);
    found->leave[0] = found->leave[1] = lanes_of(1);
}

INLINE void walk(const struct walk_pair *pair, const struct walk_kind kind,
                 struct walk_found *found)
{
    if (kind.dim == 2) {
        walk_plane(pair, kind, found);
        return;
    }
    ask_axes(pair, kind, found);
    if (!is_enough(kind, found))
        walk_space(pair, kind, found);
}

#endif
