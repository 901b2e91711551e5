/* Messages on stderr, each one line. They may contain names and texts from outside, which are
 * escaped (ESCAPE_TERMINAL), line feeds included. */
#ifndef COMPLAIN_H
#define COMPLAIN_H

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>

/* Prints a text after "fmb: ". */
__attribute__((format(printf, 1, 2))) void complain(const char *format, ...);

/* Prints a text after "fmb ", the name of a command and ": ". */
void complain_as(const char *command, const char *format, va_list list);

/* Capacity for a place: the longest path, a line and a name. */
enum { COMPLAIN_PLACE_MAX = 4300 };

/* Prints a text after "fmb: ", a place and ": ". */
void complain_at(const char *place, const char *format, va_list list);

/* Flushes standard output. Returns false after an error, which was reported. */
bool output_flush(void);

#endif
