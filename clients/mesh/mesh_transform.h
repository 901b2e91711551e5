/* Where a mesh is put: steps, each applied to what the ones before it left. Every coordinate is
 * rounded as it is computed, in one fixed order of operations, so that the mesh that comes out is
 * the same bits on every machine. What is asked of it afterwards is exact for these bits. */
#ifndef MESH_TRANSFORM_H
#define MESH_TRANSFORM_H

#include "mesh.h"

enum mesh_step_kind { MESH_SCALE, MESH_ROTATE, MESH_TRANSLATE, MESH_MIRROR };

struct mesh_step {
    enum mesh_step_kind kind;
    int axis;         /* of ROTATE and MIRROR: 0, 1, 2 */
    double number[3]; /* SCALE: factors; TRANSLATE: the way; ROTATE: [0], degrees */
};

enum { MESH_STEPS_MAX = 32 };

struct mesh_transform {
    int count;
    struct mesh_step step[MESH_STEPS_MAX];
};

/* About an axis, by the rule of the right hand; by multiples of 90 degrees exactly. About the
 * origin, as mirrors (x becomes -x) and scales are.
 * On output: the index of the first vertex with a coordinate beyond half of the largest double, so
 * that edges might be longer than doubles go; SIZE_MAX if there is none. */
size_t mesh_transform(const struct mesh_transform *transform, struct mesh *mesh);

#endif
