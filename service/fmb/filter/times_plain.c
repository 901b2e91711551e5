/* Times of contact, in plain C: what the other sets are compared with. */
#define LANES 1
#define INLINED_NOT
#define KERNEL_TIMES
#define KERNEL_NAME times_plain
#include "many.h"
