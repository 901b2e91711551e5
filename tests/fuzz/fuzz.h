/* What all fuzz targets have: the function that a fuzzer calls, and what they say when something is
 * wrong.
 *
 * A target is one file with LLVMFuzzerTestOneInput(). It is linked with libFuzzer, with AFL++, or
 * with replay.c, which gives it the files of its corpus. It holds no state between inputs: a file
 * alone repeats what was found. */
#ifndef FUZZ_H
#define FUZZ_H

#include <stddef.h>
#include <stdint.h>

/* On input: any bytes. Returns 0; does not return where something is wrong. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* In every build, release too. */
#define FUZZ_CHECK(condition) ((condition) ? (void) 0 : fuzz_failed(__FILE__, __LINE__, #condition))

/* Says where and what on stderr, and aborts. */
_Noreturn void fuzz_failed(const char *file, int line, const char *what);

/* The bytes in a block of their own that ends where they end, so that a sanitizer sees what is read
 * beyond. The caller frees it. */
uint8_t *fuzz_copy(const uint8_t *data, size_t size);

/* size bytes, none of them read yet. The caller frees them. */
void *fuzz_room(size_t size);

#endif
