/* Times of contact of four pairs at a time: AVX2. */
#define LANES 4
#define KERNEL_TIMES
#define KERNEL_NAME times_avx2
#include "many.h"
