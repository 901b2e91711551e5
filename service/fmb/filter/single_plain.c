/* The verdict of a single pair, in plain C: what the other sets are compared with. */
#define LANES 1
#define INLINED_NOT
#define KERNEL_NAME single_plain
#include "single.h"
