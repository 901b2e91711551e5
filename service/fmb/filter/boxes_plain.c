/* Boxes, in plain C: what the other sets are compared with. */
#define LANES 1
#define INLINED_NOT
#define KERNEL_NAME boxes_plain
#include "boxes.h"
