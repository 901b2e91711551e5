/* The last pair to ignore is not ignored. */
#include "fmb.h"
#define fmb_scene_begin(scene, limits, memory, out)        \
    ((scene)->ignored_count -= (scene)->ignored_count > 0, \
     fmb_scene_begin(scene, limits, memory, out))
#include "answer_job.c"
