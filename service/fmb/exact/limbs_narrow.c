/* Integers of up to 512 bits, which take no memory but the stack. */
#define LIMBS_MAX LIMBS_NARROW
#define LIMBS_ALLOCATES 0
#define LIMBS_FUNCTIONS limbs_narrow
#include "limbs_functions.h"
