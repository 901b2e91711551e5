/* Verdicts of eight pairs at a time: AVX-512. */
#define LANES 8
#define KERNEL_NAME verdicts_avx512
#include "many.h"
