/* The same with a bound on rounding that is wrong, which tests must find. */
#define LANES 8
#define INLINED_NOT
#define SLABS_ROUNDING 0x1p-58
#define KERNEL_NAME verdicts_planted
#include "many.h"
