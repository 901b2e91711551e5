/* The second pass for four pairs at a time: AVX2. */
#define LANES 4
#define KERNEL_EXACT
#define KERNEL_NAME exact_avx2
#include "many.h"
