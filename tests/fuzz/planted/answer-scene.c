/* The first placement that each placement of a scene may meet is left out. */
#include "fmb.h"
#define fmb_tree_ask(tree, frame, from, out, count) \
    fmb_tree_ask(tree, frame, (from) + 1, out, count)
#include "scene_pairs.c"
