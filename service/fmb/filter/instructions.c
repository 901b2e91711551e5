/* Chooses the instruction set of the filter. The machine is queried at each call, so that there is
 * no state. */
#include "instructions.h"

#include "kernel.h"

#include <assert.h>

/* The largest of enum instructions that is used, as a number, since the preprocessor does not
 * know the enum. Tests build programs that use less than their machine has. Kernels of AVX2 and
 * AVX-512 are linked only if this is larger than 2. */
#ifndef INSTRUCTIONS_MOST
#ifdef __x86_64__
#define INSTRUCTIONS_MOST 4
#else
#define INSTRUCTIONS_MOST 2
#endif
#endif
static_assert(INSTRUCTIONS_PLAIN == 1 && INSTRUCTIONS_TWO == 2 && INSTRUCTIONS_AVX512 == 4,
              "INSTRUCTIONS_MOST is a number of the enum");

#define KERNEL_DECLARE(name)                                                                 \
    extern kernel_function *const kernel_verdicts_##name[KERNEL_KINDS],                      \
        *const kernel_second_##name[KERNEL_KINDS], *const kernel_times_##name[KERNEL_KINDS]; \
    extern kernel_single_function *const kernel_single_##name[KERNEL_KINDS];
KERNEL_DECLARE(plain)
KERNEL_DECLARE(two)
KERNEL_DECLARE(avx2)
extern kernel_function *const kernel_verdicts_avx512[KERNEL_KINDS];
kernel_box_function kernel_boxes_plain, kernel_boxes_two, kernel_boxes_avx2;

/* AVX-512 is worth its kernels for verdicts alone. */
static const struct kernel_set sets[] = {
    [INSTRUCTIONS_PLAIN] = {kernel_verdicts_plain, kernel_second_plain, kernel_times_plain,
                            kernel_boxes_plain, kernel_single_plain},
#if INSTRUCTIONS_MOST >= 2
    [INSTRUCTIONS_TWO] = {kernel_verdicts_two, kernel_second_two, kernel_times_two,
                          kernel_boxes_two, kernel_single_two},
#endif
#if INSTRUCTIONS_MOST > 2
    [INSTRUCTIONS_AVX2] = {kernel_verdicts_avx2, kernel_second_avx2, kernel_times_avx2,
                           kernel_boxes_avx2, kernel_single_avx2},
    [INSTRUCTIONS_AVX512] = {kernel_verdicts_avx512, kernel_second_avx2, kernel_times_avx2,
                             kernel_boxes_avx2, kernel_single_avx2},
#endif
};

static bool has(int instructions)
{
    if (instructions > INSTRUCTIONS_MOST)
        return false;
    switch (instructions) {
    case INSTRUCTIONS_PLAIN:
    case INSTRUCTIONS_TWO: return true;
#ifdef __x86_64__
    case INSTRUCTIONS_AVX2: return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    case INSTRUCTIONS_AVX512:
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512vl");
#endif
    }
    return false;
}

static int best(void)
{
    for (int instructions = INSTRUCTIONS_AVX512; instructions > INSTRUCTIONS_PLAIN; instructions--)
        if (has(instructions))
            return instructions;
    return INSTRUCTIONS_PLAIN;
}

const struct kernel_set *kernel_set_best(void)
{
    return &sets[best()];
}

bool kernel_set_of(int instructions, struct kernel_set *out)
{
    const int which = instructions == INSTRUCTIONS_BEST ? best() : instructions;
    if (!has(which))
        return false;
    *out = sets[which];
    return true;
}
