#define SLABS_UNBOUNDED
#define slabs_filter unbounded_filter
#define slabs_list unbounded_list
#define slabs_prepare unbounded_prepare
#define slabs_refine unbounded_refine
#define slab_inequalities unbounded_inequalities

#include "../../service/fmb/slabs.c"
