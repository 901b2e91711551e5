/* What a tree of boxes stands for: boxes of two meshes sorted along one axis. */
#ifndef SWEEP_H
#define SWEEP_H

#include "mesh.h"

/* How many pairs of faces, one of each mesh, have boxes with a point in common. */
uint64_t sweep_pairs(const struct mesh *a, const struct mesh *b);

#endif
