/* Parses the options of the commands. Errors are reported on stderr, in one line and a hint. */
#ifndef ARGS_H
#define ARGS_H

#include "fmb_client.h"

#include <getopt.h>
#include <stdbool.h>

/* Exit codes of every command. */
enum { ARGS_ANSWERED = 0, ARGS_FAILED = 1, ARGS_USAGE = 2 };

/* The bus and the service that a command queries. */
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

enum args_kind {
    ARGS_FLAG,    /* out: bool, set to true */
    ARGS_TEXT,    /* out: const char * */
    ARGS_NUMBER,  /* out: double, from low to high */
    ARGS_INTEGER, /* out: long, from low to high */
    ARGS_OTHER    /* take processes the value, which is optarg */
};

struct args_option {
    const char *name; /* of the long option */
    enum args_kind kind;
    void *out;
    double low, high;
    bool (*take)(const struct args *args, void *out); /* returns false after an error */
    char letter;                                      /* short option; 0: none */
};

enum { ARGS_OPTIONS_MAX = 24 };

struct args {
    const char *command; /* name of the command */
    const char *usage;   /* text of --help */
    /* The command's own options, at most ARGS_OPTIONS_MAX; ends with an option without a name. */
    const struct args_option *options;
    const char *operand; /* name of an operand in messages: "FILE"; NULL: none are allowed */
    int operands_min, operands_max;

    /* Filled in by args_parse(). When take is called, the operands are those before the option. */
    struct args_bus bus;
    char **operands; /* [operand_count] */
    int operand_count;
    const char *option; /* for take: the name of the long option */
};

/* Returns ARGS_RUN; or the exit code, after --help or an error. */
enum { ARGS_RUN = -1 };
int args_parse(struct args *args, int argc, char **argv);

/* Reports an error and the hint. Always returns false. */
bool args_error(const struct args *args, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* For take: reads optarg as an integer from low to high. Returns false after an error. */
bool args_integer(const struct args *args, long low, long high, long *out);

/* Reads up to `most` finite numbers separated by commas. Returns their number; or 0 if there are
 * more, or the text is not such a list (out may be partly written). */
int args_numbers(const char *text, int most, double out[]);

/* For take: reads optarg as a prefix of channels; out: const char **. Returns false after an error.
 */
bool args_prefix(const struct args *args, void *out);

/* Checks that not both of two options are given; names: "--csv and --json". Returns false after an
 * error. */
bool args_exclude(const struct args *args, bool one, bool other, const char *names);

/* Returns the URL of a bus for messages; valid as long as the options. */
const char *args_bus_name(const struct args_bus *bus);

/* Reports how to start a service on this bus. instead: what to do otherwise, ", or ..."; or "". */
void args_advise_service(const struct args_bus *bus, const char *instead);

/* Opens a client with these options, and the URL and prefix of the bus. Returns NULL after an
 * error, which was reported on stderr. */
struct fmb_client *args_open_client(const struct args_bus *bus, struct fmb_client_options options);

#endif
