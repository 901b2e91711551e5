/* Boxes with bounds that are a sixteenth of the real ones. */
#define LANES 1
#define INLINED_NOT
#define KERNEL_BOXES
#define BOX_UNIT 0x1p-57
#define KERNEL_NAME boxes_planted
#include "many.h"
