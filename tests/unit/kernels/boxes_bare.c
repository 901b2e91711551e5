/* Boxes without bounds. */
#define LANES 1
#define INLINED_NOT
#define KERNEL_BOXES
#define BOX_UNIT 0x1p-200
#define KERNEL_NAME boxes_bare
#include "many.h"
