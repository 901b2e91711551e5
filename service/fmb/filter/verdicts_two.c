/* Verdicts of two pairs at a time: SSE2, and every machine but x86-64. */
#define LANES 2
#define KERNEL_NAME verdicts_two
#include "many.h"
