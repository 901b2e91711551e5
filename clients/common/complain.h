/* Messages on stderr. They may contain names and texts from outside: control characters are written
 * as \xNN. */
#ifndef COMPLAIN_H
#define COMPLAIN_H

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>

/* Prints each line of the text after "fmb: ". */
__attribute__((format(printf, 1, 2))) void complain(const char *format, ...);

/* Prints a text as one line, after "fmb ", the name of a command and ": ". */
void complain_as(const char *command, const char *format, va_list list);

/* Capacity for a place: the longest path, a line and a name. */
enum { COMPLAIN_PLACE_MAX = 4300 };

/* Prints a text as one line, after "fmb: ", a place and ": ": line ends within it become spaces. */
void complain_at(const char *place, const char *format, va_list list);

/* Prints a text within a line. */
void complain_text(const char *text);

/* Flushes standard output. Returns false after an error, which was reported. */
bool output_flush(void);

#endif
