/* Options of the commands: reading them, and what is the same for all of them. Errors are one line
 * on stderr and a hint. */
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

/* Takes one of the command's own options, whose value is optarg. False: after an error. */
typedef bool args_take(const struct args *args, int option, void *out);

enum { ARGS_OPTIONS_MAX = 24 };

struct args {
    const char *command; /* its name */
    const char *usage;   /* what --help prints */
    /* Its own, all long, at most ARGS_OPTIONS_MAX; ends with 0s. A value that is a letter is the
     * short option; others are from 1 to 31. */
    const struct option *options;
    args_take *take;
    const char *operand; /* what may stand behind the options, for people: "FILE"; NULL: nothing */
    int operands_max;
    /* Options may say what they say of the operand before them: take is told how many there were,
     * in operand_count. The command has no option of the value 1 then. */
    bool in_order;

    /* Filled in by args_parse(). */
    struct args_bus bus;
    char **operands; /* [operand_count] */
    int operand_count;
    const char *option; /* for take: the name of the long option */
};

/* On output: ARGS_RUN, or the exit code where nothing is to be run: after --help, and after an
 * error. out is for take. */
enum { ARGS_RUN = -1 };
int args_parse(struct args *args, int argc, char **argv, void *out);

/* An error in words, and the hint. Always false. */
bool args_error(const struct args *args, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* For take. On output: true and *out, a finite number from low to high; or false after an error.
 * The whole value must be the number. */
bool args_number(const struct args *args, double low, double high, double *out);
bool args_integer(const struct args *args, long low, long high, long *out);

/* The URL of a bus as people should see it. */
const char *args_bus_name(const struct args_bus *bus);

#endif
