/* Options of the campaigns. Errors are one line on stderr and a hint. */
#ifndef OPTIONS_H
#define OPTIONS_H

#include <getopt.h>
#include <stdbool.h>
#include <stdint.h>

#include "family.h"

/* Exit codes: FOUND, a method was wrong that never must be. */
enum { EXIT_NONE_WRONG = 0, EXIT_FOUND = 1, EXIT_USAGE = 2 };

enum { OPTIONS_FAMILIES_MAX = 200 };

struct options {
    long pairs;
    long workers;
    long every; /* one cell in so many of each family */
    uint64_t seed;
    const char *json; /* NULL: none */
    const struct family *family[OPTIONS_FAMILIES_MAX];
    int families; /* 0: all */
};

struct options_program {
    const char *name;
    const struct option *options; /* the values are OPTION_ ones; ends with 0s */
    void (*help)(void);
    long pairs;                                 /* default */
    const struct family *(*list)(size_t index); /* NULL: family_all_at() */
};

enum {
    OPTION_PAIRS = 1,
    OPTION_SEED,
    OPTION_WORKERS,
    OPTION_EVERY,
    OPTION_FAMILY,
    OPTION_JSON,
    OPTION_HELP
};

/* On output: OPTIONS_RUN and *out, or the exit code where nothing is to be run. */
enum { OPTIONS_RUN = -1 };
int options_parse(const struct options_program *program, int argc, char **argv,
                  struct options *out);

#endif
