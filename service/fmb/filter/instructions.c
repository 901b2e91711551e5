/* Chooses the instruction set of the filter. The machine is queried at each call, so that there is
 * no state. */
#include "instructions.h"

#include "kernel.h"

/* The largest of enum instructions that is used, as a number, since the preprocessor does not
 * know the enum. Tests build programs that use less than their machine has; 1, plain C only, is
 * what machines other than x86-64 have. Kernels of AVX2 and AVX-512 are linked only if this is
 * larger than 2. */
#ifndef INSTRUCTIONS_MOST
#define INSTRUCTIONS_MOST 4
#endif
_Static_assert(INSTRUCTIONS_PLAIN == 1 && INSTRUCTIONS_SSE2 == 2 && INSTRUCTIONS_AVX512 == 4,
               "INSTRUCTIONS_MOST is a number of the enum");

#define KERNEL_DECLARE(name)                                   \
    extern kernel_function *const kernel_##name[KERNEL_KINDS], \
        *const kernel_exact_##name[KERNEL_KINDS], *const kernel_times_##name[KERNEL_KINDS];
#define KERNEL_DECLARE_SINGLE(name)                                          \
    extern kernel_single_function *const kernel_single_##name[KERNEL_KINDS], \
        *const kernel_exact_single_##name[KERNEL_KINDS],                     \
            *const kernel_times_single_##name[KERNEL_KINDS];
#define KERNEL_SET(name, boxes)                                                 \
    {                                                                           \
        kernel_##name, kernel_exact_##name, kernel_times_##name, kernel_##boxes \
    }

KERNEL_DECLARE(plain)
kernel_box_function kernel_boxes_plain, kernel_boxes_two, kernel_boxes_avx2;

#if defined(__x86_64__) && INSTRUCTIONS_MOST > 1
KERNEL_DECLARE(sse2)
KERNEL_DECLARE_SINGLE(sse2)
#if INSTRUCTIONS_MOST > 2
KERNEL_DECLARE(avx2)
KERNEL_DECLARE(avx512)
KERNEL_DECLARE_SINGLE(avx2)
#define KERNEL_SINGLE_BEST(kind) (has(INSTRUCTIONS_AVX2) ? kind##_single_avx2 : kind##_single_sse2)
#else
#define KERNEL_SINGLE_BEST(kind) kind##_single_sse2
#endif
#else
KERNEL_DECLARE_SINGLE(plain)
#define KERNEL_SINGLE_BEST(kind) kind##_single_plain
#endif

static const struct kernel_set sets[] = {
#if defined(__x86_64__) && INSTRUCTIONS_MOST > 1
    [INSTRUCTIONS_PLAIN] = KERNEL_SET(plain, boxes_plain),
    [INSTRUCTIONS_SSE2] = KERNEL_SET(sse2, boxes_two),
#if INSTRUCTIONS_MOST > 2
    [INSTRUCTIONS_AVX2] = KERNEL_SET(avx2, boxes_avx2),
    [INSTRUCTIONS_AVX512] = KERNEL_SET(avx512, boxes_avx2),
#endif
#else
    [INSTRUCTIONS_PLAIN] = KERNEL_SET(plain, boxes_two),
#endif
};

static bool has(int instructions)
{
    if (instructions > INSTRUCTIONS_MOST)
        return false;
    switch (instructions) {
    case INSTRUCTIONS_PLAIN: return true;
#ifdef __x86_64__
    case INSTRUCTIONS_SSE2: return true;
    case INSTRUCTIONS_AVX2: return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    case INSTRUCTIONS_AVX512:
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512vl");
#endif
    }
    return false;
}

kernel_single_function *const *kernel_verdicts_single(void)
{
    return KERNEL_SINGLE_BEST(kernel);
}

kernel_single_function *const *kernel_exact_single(void)
{
    return KERNEL_SINGLE_BEST(kernel_exact);
}

kernel_single_function *const *kernel_times_single(void)
{
    return KERNEL_SINGLE_BEST(kernel_times);
}

static int best(void)
{
    for (int instructions = INSTRUCTIONS_AVX512; instructions > INSTRUCTIONS_PLAIN; instructions--)
        if (has(instructions))
            return instructions;
    return INSTRUCTIONS_PLAIN;
}

kernel_box_function *kernel_boxes_single(void)
{
    return sets[best()].boxes;
}

const char *instructions_name(int instructions)
{
    switch (instructions) {
    case INSTRUCTIONS_BEST: return "best";
    case INSTRUCTIONS_PLAIN: return "plain";
    case INSTRUCTIONS_SSE2: return "sse2";
    case INSTRUCTIONS_AVX2: return "avx2";
    case INSTRUCTIONS_AVX512: return "avx512";
    }
    return NULL;
}

bool instructions_supported(int instructions)
{
    return instructions == INSTRUCTIONS_BEST || has(instructions);
}

bool kernel_set_of(int instructions, struct kernel_set *out)
{
    const int which = instructions == INSTRUCTIONS_BEST ? best() : instructions;
    if (!has(which))
        return false;
    *out = sets[which];
    return true;
}
