/* The first of the frames that a frame of a scene may meet is not asked. */
#include "fmb/fmb.h"
#define fmb_tree_ask(tree, frame, from, out, count) \
    fmb_tree_ask(tree, frame, (from) + 1, out, count)
#include "scene_pairs.c"
