/* The second pass, in plain C: what the other sets are compared with. */
#define LANES 1
#define INLINED_NOT
#define KERNEL_SECOND
#define KERNEL_NAME second_plain
#include "many.h"
