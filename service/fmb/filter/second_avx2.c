/* The second pass for four pairs at a time: AVX2. */
#define LANES 4
#define KERNEL_SECOND
#define KERNEL_NAME second_avx2
#include "many.h"
