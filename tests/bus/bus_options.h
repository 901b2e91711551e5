/* Options of the benchmark of the bus. Errors are one line on stderr and a hint. */
#ifndef OPTIONS_H
#define OPTIONS_H

#include "bus_bench.h"

enum { OPTIONS_RUN = -1, OPTIONS_USAGE = 2 };

/* On output: OPTIONS_RUN, *bench but its JSON, and the file for that or NULL; or the exit code
 * where nothing is to be run. */
int bus_options(int argc, char **argv, struct bus_bench *bench, const char **json);

#endif
