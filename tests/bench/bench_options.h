/* Options of the benchmark. Errors are one line on stderr and a hint. */
#ifndef BENCH_OPTIONS_H
#define BENCH_OPTIONS_H

#include "bench.h"

enum { OPTIONS_RUN = -1, OPTIONS_USAGE = 2 };

/* On output: OPTIONS_RUN, *bench but its JSON, and the file for that or NULL; or the exit code
 * where nothing is to be run. */
int bench_options(int argc, char **argv, struct bench *bench, const char **json);

#endif
