/* The second pass for two pairs at a time: SSE2, and every machine but x86-64. */
#define LANES 2
#define INLINED_NOT
#define KERNEL_SECOND
#define KERNEL_NAME second_two
#include "many.h"
