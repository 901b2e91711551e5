/* What the benchmark runs on. */
#ifndef MACHINE_H
#define MACHINE_H

#include <stddef.h>

enum { MACHINE_TEXT_MAX = 256 };

/* The name of the processor, or "unknown". */
const char *machine_cpu(char text[MACHINE_TEXT_MAX]);
const char *machine_compiler(void);
int machine_cores(void);

/* Bytes of the cache that is last before memory; 0: not known. */
size_t machine_last_cache(void);

#endif
