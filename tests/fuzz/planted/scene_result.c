/* Pairs may name placements beyond the capacity of a query. */
#include "query.h"
#define QUERY_PLACEMENTS_MAX (QUERY_PLACEMENTS_MAX + 100)
#include "wire_scene.c"
