/* Boxes of two pairs at a time: SSE2, and every machine but x86-64. */
#define LANES 2
#define INLINED_NOT
#define KERNEL_NAME boxes_two
#include "boxes.h"
