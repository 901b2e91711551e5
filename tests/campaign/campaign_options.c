#include "campaign_options.h"

#include <errno.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "round.h"
#include "workers.h"

/* The seed of the oracle's tests. */
static const uint64_t usual_seed = 20240607;

/* Always false. */
__attribute__((format(printf, 2, 3))) static bool refuse(const struct options_program *program,
                                                         const char *format, ...)
{
    va_list list;
    fprintf(stderr, "%s: ", program->name);
    va_start(list, format);
    vfprintf(stderr, format, list);
    va_end(list);
    fprintf(stderr, "\nTry '%s --help'.\n", program->name);
    return false;
}

static bool take_integer(const struct options_program *program, const char *name, long low,
                         long high, long *out)
{
    char *end;
    errno = 0;
    *out = strtol(optarg, &end, 10);
    if (end != optarg && !*end && errno == 0 && *out >= low && *out <= high)
        return true;
    return refuse(program, "--%s: expected an integer from %ld to %ld, found '%s'", name, low, high,
                  optarg);
}

static bool take_seed(const struct options_program *program, uint64_t *out)
{
    char *end;
    errno = 0;
    *out = strtoull(optarg, &end, 0);
    if (end != optarg && !*end && errno == 0 && *optarg != '-')
        return true;
    return refuse(program, "--seed: expected an integer below 2^64, found '%s'", optarg);
}

/* A name, or the beginning of some up to a dash: "hull-". */
static bool is_named(const struct family *family)
{
    const size_t length = strlen(optarg);
    return strcmp(family->name, optarg) == 0 ||
           (length > 0 && optarg[length - 1] == '-' && strncmp(family->name, optarg, length) == 0);
}

static bool take_family(const struct options_program *program, struct options *out)
{
    const struct family *(*list)(size_t) = program->list ? program->list : family_all_at;
    const int before = out->families;
    for (size_t i = 0; list(i); i++) {
        if (!is_named(list(i)))
            continue;
        if (out->families == OPTIONS_FAMILIES_MAX)
            return refuse(program, "--family: at most %d", OPTIONS_FAMILIES_MAX);
        out->family[out->families++] = list(i);
    }
    return out->families > before || refuse(program, "--family: there is no '%s'", optarg);
}

static bool take(const struct options_program *program, int option, char **argv,
                 struct options *out)
{
    switch (option) {
    case OPTION_PAIRS: return take_integer(program, "pairs", 1, INT_MAX, &out->pairs);
    case OPTION_EVERY: return take_integer(program, "every", 1, INT_MAX, &out->every);
    case OPTION_WORKERS: return take_integer(program, "workers", 1, 256, &out->workers);
    case OPTION_SEED: return take_seed(program, &out->seed);
    case OPTION_FAMILY: return take_family(program, out);
    case OPTION_JSON: out->json = optarg; return true;
    case ':': return refuse(program, "option '%s' needs a value", argv[optind - 1]);
    default: return refuse(program, "unknown option '%s'", argv[optind - 1]);
    }
}

int options_parse(const struct options_program *program, int argc, char **argv, struct options *out)
{
    int option;
    *out = (struct options){
        .pairs = program->pairs, .every = 1, .workers = workers_usual(), .seed = usual_seed};
    opterr = 0;
    while ((option = getopt_long(argc, argv, ":", program->options, NULL)) != -1) {
        if (option == OPTION_HELP) {
            program->help();
            return EXIT_NONE_WRONG;
        }
        if (!take(program, option, argv, out))
            return EXIT_USAGE;
    }
    if (optind < argc) {
        refuse(program, "unknown argument '%s'", argv[optind]);
        return EXIT_USAGE;
    }
    return OPTIONS_RUN;
}
