/* Boxes of four pairs at a time: AVX2. */
#define LANES 4
#define INLINED_NOT
#define KERNEL_NAME boxes_avx2
#include "boxes.h"
