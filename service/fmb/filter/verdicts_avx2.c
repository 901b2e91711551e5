/* Verdicts of four pairs at a time: AVX2. */
#define LANES 4
#define KERNEL_NAME verdicts_avx2
#include "many.h"
