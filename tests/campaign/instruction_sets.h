/* The names of the filter's instruction sets, and which of them this machine has. */
#ifndef INSTRUCTION_SETS_H
#define INSTRUCTION_SETS_H

#include "instructions.h"
#include "kernel.h"

/* Returns "best", "plain", "two", "avx2" or "avx512"; NULL for any other number. */
static inline const char *instructions_name(int instructions)
{
    static const char *const name[] = {"best", "plain", "two", "avx2", "avx512"};
    return instructions >= INSTRUCTIONS_BEST && instructions <= INSTRUCTIONS_AVX512
               ? name[instructions]
               : NULL;
}

static inline bool instructions_supported(int instructions)
{
    struct kernel_set set;
    return kernel_set_of(instructions, &set);
}

#endif
