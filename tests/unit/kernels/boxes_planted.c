/* Boxes with bounds that are a 64th of the real ones. */
#define LANES 1
#define INLINED_NOT
#define BOX_UNIT 0x1p-59
#define KERNEL_NAME boxes_planted
#include "boxes.h"
