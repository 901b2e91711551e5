/* The instruction sets that the filter is compiled for. */
#ifndef FMB_FILTER_INSTRUCTIONS_H
#define FMB_FILTER_INSTRUCTIONS_H

#include <stdbool.h>

/* BEST: the best one that this machine supports, detected at run time. */
enum instructions {
    INSTRUCTIONS_BEST = 0,
    INSTRUCTIONS_PLAIN = 1,
    INSTRUCTIONS_TWO = 2, /* two lanes: SSE2, and every machine but x86-64 */
    INSTRUCTIONS_AVX2 = 3,
    INSTRUCTIONS_AVX512 = 4
};

/* Returns "best", "plain", "two", "avx2" or "avx512"; NULL for any other number. */
const char *instructions_name(int instructions);

/* Returns whether the kernels are compiled for these instructions and this machine has them. */
bool instructions_supported(int instructions);

#endif
