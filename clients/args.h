/* Options of the commands: what is the same for several of them. Errors are one line on stderr
 * and a hint; the caller then exits with ARGS_USAGE. */
#ifndef ARGS_H
#define ARGS_H

#include <stdbool.h>

/* Exit codes of every command. */
enum { ARGS_ANSWERED = 0, ARGS_FAILED = 1, ARGS_USAGE = 2 };

/* Which bus, which service. */
struct args_bus {
    const char *url;    /* NULL: LCM_DEFAULT_URL, or this host */
    const char *prefix; /* "" for none */
};

/* How to begin a getopt_long() that reports nothing itself: its option string begins with ':'. */
void args_restart(void);

/* After an option of '?' or ':' from getopt_long(): says which one is not understood or lacks its
 * value. Always false. */
bool args_refuse(const char *command, int option, char **argv);

/* An error in words, and the hint. Always false. */
bool args_error(const char *command, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* On output: true and *out, a finite number from low to high; or false after an error that names
 * the option. The whole text must be the number. */
bool args_number(const char *command, const char *option, const char *text, double low, double high,
                 double *out);
bool args_integer(const char *command, const char *option, const char *text, long low, long high,
                  long *out);

bool args_prefix(const char *command, const char *text, struct args_bus *out);

/* The URL of a bus as people should see it. */
const char *args_bus_name(const struct args_bus *bus);

#endif
