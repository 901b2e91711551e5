/* Verdicts of eight pairs at a time in vectors that every machine has. */
#define LANES 8
#define INLINED_NOT
#define KERNEL_NAME verdicts_wide
#include "many.h"
