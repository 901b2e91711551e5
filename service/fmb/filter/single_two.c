/* The verdict of a single pair in two lanes: SSE2, and every machine but x86-64. */
#define LANES 2
#define KERNEL_NAME single_two
#include "single.h"
