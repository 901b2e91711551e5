/* Forced inlining for kernels.
 *
 * A kernel takes constants (shapes, dimension, widths) as arguments. Inlining specializes it for
 * each case and unrolls its loops, which pays for what scenes do most. Where it does not, a file
 * defines INLINED_NOT, and its kernel stays functions and loops. So it does under
 * AddressSanitizer, where inlining would take minutes to compile and find no more errors. */
#ifndef FMB_INLINED_H
#define FMB_INLINED_H

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define INLINED_NEVER
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define INLINED_NEVER
#endif
#if defined(INLINED_NEVER) && !defined(INLINED_NOT)
#define INLINED_NOT
#endif

/* FLATTEN also inlines what a function calls by a pointer that is a constant. */
#ifdef INLINED_NOT
#define FLATTEN
#define INLINE static inline
#define UNROLL(times)
/* Without the constants gcc does not see which axes are set. */
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#else
#define FLATTEN __attribute__((flatten))
#define INLINE static inline __attribute__((always_inline))
#define UNROLL(times) INLINED_PRAGMA(GCC unroll times)
#define INLINED_PRAGMA(text) _Pragma(#text)
#endif

#endif
