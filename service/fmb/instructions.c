/* Which instruction set the filter runs on: asked of the machine at each call, so that nothing is
 * kept. */
#include "run.h"

#define RUN_DECLARE(name) extern run_function *const run_##name[RUN_KINDS], *const run_times_##name[RUN_KINDS];

RUN_DECLARE(plain)
#if defined(__x86_64__)
RUN_DECLARE(sse2)
RUN_DECLARE(avx2)
RUN_DECLARE(avx512)
extern run_alone_function *const run_alone_sse2[RUN_KINDS], *const run_alone_avx2[RUN_KINDS],
    *const run_times_alone_sse2[RUN_KINDS], *const run_times_alone_avx2[RUN_KINDS];

static bool has(int instructions)
{
    switch (instructions) {
    case FMB_PLAIN:
    case FMB_SSE2: return true;
    case FMB_AVX2: return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    case FMB_AVX512:
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512vl");
    }
    return false;
}

static run_function *const *const verdicts[] = {
    [FMB_PLAIN] = run_plain, [FMB_SSE2] = run_sse2, [FMB_AVX2] = run_avx2, [FMB_AVX512] = run_avx512};
static run_function *const *const times[] = {[FMB_PLAIN] = run_times_plain,
                                             [FMB_SSE2] = run_times_sse2,
                                             [FMB_AVX2] = run_times_avx2,
                                             [FMB_AVX512] = run_times_avx512};

run_alone_function *const *run_verdicts_alone(void)
{
    return has(FMB_AVX2) ? run_alone_avx2 : run_alone_sse2;
}

run_alone_function *const *run_times_alone(void)
{
    return has(FMB_AVX2) ? run_times_alone_avx2 : run_times_alone_sse2;
}

#else

static bool has(int instructions)
{
    return instructions == FMB_PLAIN;
}

static run_function *const *const verdicts[] = {[FMB_PLAIN] = run_plain};
static run_function *const *const times[] = {[FMB_PLAIN] = run_times_plain};

extern run_alone_function *const run_alone_plain[RUN_KINDS],
    *const run_times_alone_plain[RUN_KINDS];

run_alone_function *const *run_verdicts_alone(void)
{
    return run_alone_plain;
}

run_alone_function *const *run_times_alone(void)
{
    return run_times_alone_plain;
}

#endif

static int best(void)
{
    for (int instructions = FMB_AVX512; instructions > FMB_PLAIN; instructions--)
        if (has(instructions))
            return instructions;
    return FMB_PLAIN;
}

bool fmb_instructions_supported(int instructions)
{
    return instructions == FMB_BEST || has(instructions);
}

run_function *const *run_verdicts(int instructions)
{
    const int which = instructions == FMB_BEST ? best() : instructions;
    return has(which) ? verdicts[which] : NULL;
}

run_function *const *run_times(int instructions)
{
    const int which = instructions == FMB_BEST ? best() : instructions;
    return has(which) ? times[which] : NULL;
}
