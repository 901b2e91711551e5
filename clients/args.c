#include "args.h"

#include "bus.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void args_restart(void)
{
    optind = 1;
    opterr = 0;
}

bool args_error(const char *command, const char *format, ...)
{
    va_list list;
    fprintf(stderr, "fmb %s: ", command);
    va_start(list, format);
    vfprintf(stderr, format, list);
    va_end(list);
    fprintf(stderr, "\nTry 'fmb %s --help'.\n", command);
    return false;
}

/* A long option stands in argv[optind - 1]; of short ones, which may share a word, getopt keeps
 * the letter. */
bool args_refuse(const char *command, int option, char **argv)
{
    const char letter[] = {'-', (char) optopt, '\0'};
    bool is_long = strncmp(argv[optind - 1], "--", 2) == 0;
    const char *name = is_long ? argv[optind - 1] : letter;
    if (option == ':')
        return args_error(command, "option '%s' needs a value", name);
    if (is_long && optopt != 0)
        return args_error(command, "option '%s' takes no value", name);
    return args_error(command, "unknown option '%s'", name);
}

bool args_number(const char *command, const char *option, const char *text, double low, double high,
                 double *out)
{
    char *end;
    *out = strtod(text, &end);
    if (end != text && !*end && *out >= low && *out <= high)
        return true;
    return args_error(command, "%s: expected a number from %g to %g, found '%s'", option, low, high,
                      text);
}

bool args_integer(const char *command, const char *option, const char *text, long low, long high,
                  long *out)
{
    char *end;
    errno = 0;
    *out = strtol(text, &end, 10);
    if (end != text && !*end && errno == 0 && *out >= low && *out <= high)
        return true;
    return args_error(command, "%s: expected an integer from %ld to %ld, found '%s'", option, low,
                      high, text);
}

bool args_prefix(const char *command, const char *text, struct args_bus *out)
{
    if (!bus_prefix_ok(text))
        return args_error(command, "--prefix: expected at most %d letters, digits, '_' or '-'",
                          BUS_PREFIX_MAX);
    out->prefix = text;
    return true;
}

const char *args_bus_name(const struct args_bus *bus)
{
    const char *url = bus->url ? bus->url : getenv("LCM_DEFAULT_URL");
    return url && *url ? url : "the usual bus of this host";
}
