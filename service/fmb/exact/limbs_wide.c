/* Integers wide enough for every pair. */
#define LIMBS_MAX LIMBS_WIDE
#define LIMBS_ALLOCATES 1
#define LIMBS_FUNCTIONS limbs_wide
#include "limbs_functions.h"
