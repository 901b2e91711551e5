/* The second pass, in plain C: what the other sets are compared with. */
#define LANES 1
#define INLINED_NOT
#define KERNEL_EXACT
#define KERNEL_NAME exact_plain
#include "many.h"
