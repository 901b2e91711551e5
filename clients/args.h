/* Parses the options of the commands. Errors are reported on stderr, in one line and a hint. */
#ifndef ARGS_H
#define ARGS_H

#include <getopt.h>
#include <stdbool.h>

/* Exit codes of every command. */
enum { ARGS_ANSWERED = 0, ARGS_FAILED = 1, ARGS_USAGE = 2 };

/* Which bus, which service. */
struct args_bus {
    const char *url;    /* NULL: LCM_DEFAULT_URL, or this host */
    const char *prefix; /* "" for none */
};

/* The options that every command has, for its --help. */
#define ARGS_COMMON_USAGE                                                    \
    "  -l, --lcm-url URL    the bus; else LCM_DEFAULT_URL, else this host\n" \
    "  -p, --prefix P       the service's channels begin with P\n"           \
    "  -h, --help\n"

struct args;

/* Processes one of the command's own options, with the value optarg. Returns false after an error.
 */
typedef bool args_take(const struct args *args, int option, void *out);

enum { ARGS_OPTIONS_MAX = 24 };

struct args {
    const char *command; /* name of the command */
    const char *usage;   /* text of --help */
    /* The command's own options, all long, at most ARGS_OPTIONS_MAX; ends with 0s. A value that is
     * a letter is also the short option; other values are from 1 to 31. */
    const struct option *options;
    args_take *take;
    const char *operand; /* name of the operands in messages: "FILE"; NULL: none allowed */
    int operands_max;
    /* Options may refer to the operand before them: operand_count is its number when take is
     * called. No option may then have the value 1. */
    bool in_order;

    /* Filled in by args_parse(). */
    struct args_bus bus;
    char **operands; /* [operand_count] */
    int operand_count;
    const char *option; /* for take: the name of the long option */
};

/* Returns ARGS_RUN; or the exit code, after --help or an error. out is passed to take. */
enum { ARGS_RUN = -1 };
int args_parse(struct args *args, int argc, char **argv, void *out);

/* Reports an error and the hint. Always returns false. */
bool args_error(const struct args *args, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* For take: reads optarg as a finite number from low to high. Returns false after an error. */
bool args_number(const struct args *args, double low, double high, double *out);
bool args_integer(const struct args *args, long low, long high, long *out);

/* The URL of a bus, for messages. */
const char *args_bus_name(const struct args_bus *bus);

#endif
