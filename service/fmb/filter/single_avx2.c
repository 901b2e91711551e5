/* The verdict of a single pair in two lanes, by the instructions of AVX2. */
#define LANES 2
#define KERNEL_NAME single_avx2
#include "single.h"
