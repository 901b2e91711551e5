/* Whether two scenes are the same, to the bit. */
#ifndef SAME_SCENE_H
#define SAME_SCENE_H

#include "scene.h"

/* Frames, poses, names, window, margin, label, and which pairs are decided, in their order. */
bool same_scene(struct owned_scene *left, struct owned_scene *right);

#endif
