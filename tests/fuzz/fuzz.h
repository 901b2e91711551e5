/* What all fuzz targets share: the function that a fuzzer calls, and checks that abort.
 *
 * A target is one file with LLVMFuzzerTestOneInput(). It is linked with libFuzzer, with AFL++, or
 * with replay.c, which gives it the files of its corpus. It keeps no state between inputs, so that
 * one file reproduces a finding. */
#ifndef FUZZ_H
#define FUZZ_H

#include <stddef.h>
#include <stdint.h>

/* On input: any bytes. Returns 0, or aborts where a check fails. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Checks in every build, release too. */
#define FUZZ_CHECK(condition) ((condition) ? (void) 0 : fuzz_failed(__FILE__, __LINE__, #condition))

/* Prints the place and the condition on stderr, and aborts. */
_Noreturn void fuzz_failed(const char *file, int line, const char *what);

/* A copy whose block ends with the last byte, so that a sanitizer detects reads beyond it. The
 * caller frees it. */
uint8_t *fuzz_copy(const uint8_t *data, size_t size);

/* size uninitialised bytes; aborts where there is no memory. The caller frees them. */
void *fuzz_room(size_t size);

#endif
