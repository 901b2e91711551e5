/* Messages on stderr. Names and texts of others may be in them: characters that a terminal would
 * obey are written as \xNN. */
#ifndef COMPLAIN_H
#define COMPLAIN_H

#include <stdarg.h>

/* Prints each line of the text after "fmb: ". */
__attribute__((format(printf, 1, 2))) void complain(const char *format, ...);

/* Prints one message after who and ": ". */
void complain_as(const char *who, const char *format, va_list list);

/* Prints a text within a line. */
void complain_text(const char *text);

#endif
