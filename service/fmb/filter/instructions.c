/* Which instruction set the filter runs on: asked of the machine at each call, so that nothing is
 * kept. */
#include "run.h"

/* The best that is ever used, of enum fmb_instructions, which the preprocessor does not know. Tests
 * build programs that know less than their machine has; one that knows plain C alone is what other
 * machines have. Kernels of AVX2 and AVX-512 are linked only if this is larger than 2. */
#ifndef INSTRUCTIONS_MOST
#define INSTRUCTIONS_MOST 4
#endif
_Static_assert(FMB_PLAIN == 1 && FMB_SSE2 == 2 && FMB_AVX512 == 4,
               "INSTRUCTIONS_MOST is a number of the enum");

#define RUN_DECLARE(name)                                                                     \
    extern run_function *const run_##name[RUN_KINDS], *const run_exact_##name[RUN_KINDS],     \
                                                          *const run_times_##name[RUN_KINDS], \
                                                              *const run_boxes_##name[RUN_KINDS];
#define RUN_DECLARE_ALONE(name)                                    \
    extern run_single_function *const run_alone_##name[RUN_KINDS], \
        *const run_exact_alone_##name[RUN_KINDS], *const run_times_alone_##name[RUN_KINDS];
#define RUN_SET(name)                                                    \
    {                                                                    \
        run_##name, run_exact_##name, run_times_##name, run_boxes_##name \
    }

RUN_DECLARE(plain)

#if defined(__x86_64__) && INSTRUCTIONS_MOST > 1
RUN_DECLARE(sse2)
RUN_DECLARE_ALONE(sse2)
#if INSTRUCTIONS_MOST > 2
RUN_DECLARE(avx2)
RUN_DECLARE(avx512)
RUN_DECLARE_ALONE(avx2)
#define RUN_ALONE_BEST(kind) (has(FMB_AVX2) ? kind##_alone_avx2 : kind##_alone_sse2)
#else
#define RUN_ALONE_BEST(kind) kind##_alone_sse2
#endif
#else
RUN_DECLARE_ALONE(plain)
#define RUN_ALONE_BEST(kind) kind##_alone_plain
#endif

static const struct run_set sets[] = {
    [FMB_PLAIN] = RUN_SET(plain),
#if defined(__x86_64__) && INSTRUCTIONS_MOST > 1
    [FMB_SSE2] = RUN_SET(sse2),
#if INSTRUCTIONS_MOST > 2
    [FMB_AVX2] = RUN_SET(avx2),
    [FMB_AVX512] = RUN_SET(avx512),
#endif
#endif
};

static bool has(int instructions)
{
    if (instructions > INSTRUCTIONS_MOST)
        return false;
    switch (instructions) {
    case FMB_PLAIN: return true;
#ifdef __x86_64__
    case FMB_SSE2: return true;
    case FMB_AVX2: return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    case FMB_AVX512:
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512vl");
#endif
    }
    return false;
}

run_single_function *const *run_verdicts_single(void)
{
    return RUN_ALONE_BEST(run);
}

run_single_function *const *run_exact_single(void)
{
    return RUN_ALONE_BEST(run_exact);
}

run_single_function *const *run_times_single(void)
{
    return RUN_ALONE_BEST(run_times);
}

static int best(void)
{
    for (int instructions = FMB_AVX512; instructions > FMB_PLAIN; instructions--)
        if (has(instructions))
            return instructions;
    return FMB_PLAIN;
}

run_function *const *run_boxes_single(void)
{
    return sets[best() < FMB_AVX2 ? best() : FMB_AVX2].boxes;
}

bool fmb_instructions_supported(int instructions)
{
    return instructions == FMB_BEST || has(instructions);
}

bool run_set_of(int instructions, struct run_set *out)
{
    const int which = instructions == FMB_BEST ? best() : instructions;
    if (!has(which))
        return false;
    *out = sets[which];
    return true;
}
