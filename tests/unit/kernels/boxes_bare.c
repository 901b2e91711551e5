/* Boxes without bounds. */
#define LANES 1
#define INLINED_NOT
#define BOX_UNIT 0x1p-200
#define KERNEL_NAME boxes_bare
#include "boxes.h"
