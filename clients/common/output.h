/* What the user wants written: files, and standard output. What goes wrong is said on stderr, with
 * the name. */
#ifndef OUTPUT_H
#define OUTPUT_H

#include <stdbool.h>
#include <stdio.h>

/* Overwrites. NULL after an error. */
FILE *output_open(const char *path);

/* Both: whether all was written. */
bool output_close(FILE *file, const char *path);
bool output_flush(void); /* standard output */

#endif
