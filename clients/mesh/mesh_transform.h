/* Transforms a mesh by a sequence of steps. Every coordinate is rounded in a fixed order of
 * operations, so the result has the same bits on every machine. Queries are exact for these bits.
 */
#ifndef MESH_TRANSFORM_H
#define MESH_TRANSFORM_H

#include "mesh.h"

enum mesh_step_kind { MESH_SCALE, MESH_ROTATE, MESH_TRANSLATE };

struct mesh_step {
    enum mesh_step_kind kind;
    int axis;         /* of ROTATE: 0 (x), 1 (y), 2 (z) */
    double number[3]; /* SCALE: factors; TRANSLATE: displacement; ROTATE: [0], degrees */
};

enum { MESH_STEPS_MAX = 32 };

struct mesh_transform {
    int count;
    struct mesh_step step[MESH_STEPS_MAX];
};

/* Applies the steps in order. Rotations follow the right-hand rule; multiples of 90 degrees are
 * exact. Rotations and scales are about the origin. Returns SIZE_MAX; or the index of the first
 * vertex with a coordinate beyond half of the largest double, with which the length of an edge
 * might overflow. */
size_t mesh_transform(const struct mesh_transform *transform, struct mesh *mesh);

#endif
