/* Frames beyond those that a query can have are named. */
#include "query.h"
#define QUERY_FRAMES_MAX (QUERY_FRAMES_MAX + 100)
#include "wire_scene.c"
