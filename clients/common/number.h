/* Numbers as text. */
#ifndef NUMBER_H
#define NUMBER_H

#include <locale.h>
#include <stdint.h>
#include <stdio.h>

enum { NUMBER_TEXT_MAX = 40 };

/* Numbers are read and printed as in the "C" locale, in which programs start. A library may be
 * called by a program that has called setlocale(): it reads and prints numbers between these two
 * functions, which switch the calling thread to "C" and back. number_begin() returns the locale for
 * number_end(). */
locale_t number_begin(void);
void number_end(locale_t before);

/* The fewest of 15, 16 or 17 digits that read back as the same bits: "0.5", "1";
 * "0.10000000000000001" only if "0.1" is another double. Infinite numbers and NaN, which JSON does
 * not have, become "null". Returns text. */
const char *number_exact(double value, char text[NUMBER_TEXT_MAX]);

/* As number_exact(), but infinite numbers become "inf" and "-inf". */
const char *number_or_inf(double value, char text[NUMBER_TEXT_MAX]);

/* Six digits, for people: "0.333333". Returns text. */
const char *number_short(double value, char text[NUMBER_TEXT_MAX]);

/* The ends of an interval, low <= high, for people. They have six digits, or more, up to 17, if it
 * takes more to show three digits of their difference; if they are equal, up to 12, to show three
 * digits after the decimal point. */
void number_ends(double low, double high, char low_text[NUMBER_TEXT_MAX],
                 char high_text[NUMBER_TEXT_MAX]);

/* With a comma between thousands, for people: "4,194,304". Returns text. */
const char *number_grouped(int64_t value, char text[NUMBER_TEXT_MAX]);

/* Prints a count of things: "1 query", "2,500 queries". */
void number_count(FILE *out, int64_t count, const char *one, const char *more);

/* Prints a row of a table of counts on standard output. */
void number_print(const char *name, int64_t count);

#endif
