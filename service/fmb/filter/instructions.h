/* The instruction sets that the filter is compiled for. */
#ifndef FMB_FILTER_INSTRUCTIONS_H
#define FMB_FILTER_INSTRUCTIONS_H

/* BEST: the best one that this machine supports, detected at run time. */
enum instructions {
    INSTRUCTIONS_BEST = 0,
    INSTRUCTIONS_PLAIN = 1,
    INSTRUCTIONS_TWO = 2, /* two lanes: SSE2, and every machine but x86-64 */
    INSTRUCTIONS_AVX2 = 3,
    INSTRUCTIONS_AVX512 = 4
};

#endif
