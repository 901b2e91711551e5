/* Forced inlining for kernels.
 *
 * A kernel takes constants (shapes, dimension, widths) as arguments. Inlining specializes it for
 * each case and unrolls its loops. Under AddressSanitizer this would take minutes to compile and
 * find no more errors: there, and if INLINED_NOT is defined, kernels stay ordinary functions and
 * loops. */
#ifndef FMB_INLINED_H
#define FMB_INLINED_H

#ifndef INLINED_NOT
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define INLINED_NOT
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define INLINED_NOT
#endif
#endif

#ifdef INLINED_NOT
#define INLINE static inline
#define UNROLL(times)
#else
#define INLINE static inline __attribute__((always_inline))
#define UNROLL(times) INLINED_PRAGMA(GCC unroll times)
#define INLINED_PRAGMA(text) _Pragma(#text)
#endif

#endif
