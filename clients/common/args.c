#include "args.h"

#include "complain.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool args_error(const struct args *args, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    complain_as(args->command, format, list);
    va_end(list);
    fprintf(stderr, "Try 'fmb %s --help'.\n", args->command);
    return false;
}

static bool take_number(const struct args *args, double low, double high, double *out)
{
    char *end;
    *out = strtod(optarg, &end);
    if (end != optarg && !*end && *out >= low && *out <= high)
        return true;
    return args_error(args, "--%s: expected a number from %g to %g, found '%s'", args->option, low,
                      high, optarg);
}

bool args_integer(const struct args *args, long low, long high, long *out)
{
    char *end;
    errno = 0;
    *out = strtol(optarg, &end, 10);
    if (end != optarg && !*end && errno == 0 && *out >= low && *out <= high)
        return true;
    return args_error(args, "--%s: expected an integer from %ld to %ld, found '%s'", args->option,
                      low, high, optarg);
}

int args_numbers(const char *text, int most, double out[])
{
    for (int count = 0; count < most; text++) {
        char *end;
        out[count] = strtod(text, &end);
        if (end == text || !isfinite(out[count++]))
            return 0;
        if (*end != ',')
            return *end ? 0 : count;
        text = end;
    }
    return 0;
}

bool args_exclude(const struct args *args, bool one, bool other, const char *names)
{
    return !(one && other) || args_error(args, "%s exclude each other", names);
}

/* ---- Options --------------------------------------------------------------------------------- */

bool args_prefix(const struct args *args, void *out)
{
    const char **prefix = out;
    if (!fmb_client_prefix_ok(optarg))
        return args_error(args, "--%s: expected at most %d letters, digits, '_' or '-'",
                          args->option, FMB_CLIENT_PREFIX_MAX);
    *prefix = optarg;
    return true;
}

/* The options for getopt_long(). */
enum { COMMON_OPTIONS = 3, ALL_MAX = ARGS_OPTIONS_MAX + COMMON_OPTIONS };
struct getopt_options {
    struct option option[ALL_MAX + 1];
    char letters[2 * ALL_MAX + 3];
};

enum { FIRST = 256 }; /* value of the first option, if it has no letter */

/* A '-' before the letters makes getopt_long() return operands in order, as AN_OPERAND. */
enum { AN_OPERAND = 1 };

static void list_options(const struct args_option *options, struct getopt_options *out)
{
    char *letter = out->letters + 2;
    *out = (struct getopt_options){.letters = "-:"};
    for (int i = 0; options[i].name; i++) {
        const bool has_value = options[i].kind != ARGS_FLAG;
        const int value = options[i].letter ? options[i].letter : FIRST + i;
        out->option[i] = (struct option){options[i].name, has_value, NULL, value};
        if (!options[i].letter)
            continue;
        *letter++ = options[i].letter;
        if (has_value)
            *letter++ = ':';
    }
}

/* Reports an option that getopt_long() refused with '?' or ':'. A long option is argv[optind - 1].
 * Short ones may share a word, but optopt is the letter. */
static bool refuse(const struct args *args, int option, char **argv)
{
    const char letter[] = {'-', (char) optopt, '\0'};
    bool is_long = strncmp(argv[optind - 1], "--", 2) == 0;
    const char *name = is_long ? argv[optind - 1] : letter;
    if (option == ':')
        return args_error(args, "option '%s' needs a value", name);
    if (is_long && optopt != 0)
        return args_error(args, "option '%s' takes no value", name);
    return args_error(args, "unknown option '%s'", name);
}

static bool take_option(struct args *args, const struct args_option *option)
{
    args->option = option->name;
    switch (option->kind) {
    case ARGS_FLAG: *(bool *) option->out = true; return true;
    case ARGS_TEXT: *(const char **) option->out = optarg; return true;
    case ARGS_NUMBER: return take_number(args, option->low, option->high, option->out);
    case ARGS_INTEGER:
        return args_integer(args, (long) option->low, (long) option->high, option->out);
    default: return option->take(args, option->out);
    }
}

/* Checks the number of operands. */
static bool take_operands(struct args *args, int count)
{
    args->operand_count = count;
    if (!args->operand && count > 0)
        return args_error(args, "unknown argument '%s'", args->operands[0]);
    if (count > args->operands_max && args->operands_max == 1)
        return args_error(args, "expected one %s, found '%s' too", args->operand,
                          args->operands[1]);
    if (count > args->operands_max)
        return args_error(args, "expected at most %d %ss", args->operands_max, args->operand);
    return true;
}

int args_parse(struct args *args, int argc, char **argv)
{
    bool help = false;
    const struct args_option common[COMMON_OPTIONS] = {
        {"lcm-url", ARGS_TEXT, &args->bus.url, .letter = 'l'},
        {"prefix", ARGS_OTHER, &args->bus.prefix, .take = args_prefix, .letter = 'p'},
        {"help", ARGS_FLAG, &help, .letter = 'h'},
    };
    struct args_option options[ALL_MAX + 1] = {{0}};
    struct getopt_options list;
    int own = 0, option;
    for (; args->options[own].name && own < ARGS_OPTIONS_MAX; own++)
        options[own] = args->options[own];
    memcpy(options + own, common, sizeof common);
    list_options(options, &list);
    args->bus = (struct args_bus){.prefix = ""};
    args->operands = argv + 1;
    args->operand_count = 0;
    optind = 1;
    opterr = 0;
    while ((option = getopt_long(argc, argv, list.letters, list.option, NULL)) != -1) {
        int i = 0;
        while (list.option[i].name && list.option[i].val != option)
            i++;
        if (option == AN_OPERAND)
            args->operands[args->operand_count++] = optarg; /* overwrites words already read */
        else if (list.option[i].name ? !take_option(args, &options[i])
                                     : !refuse(args, option, argv))
            return ARGS_USAGE;
    }
    memmove(args->operands + args->operand_count, argv + optind,
            (size_t) (argc - optind) * sizeof *argv);
    if (!take_operands(args, args->operand_count + argc - optind))
        return ARGS_USAGE;
    if (help) {
        fputs(args->usage, stdout);
        return ARGS_ANSWERED;
    }
    if (args->operand_count < args->operands_min &&
        !args_error(args, "expected a %s", args->operand))
        return ARGS_USAGE;
    return ARGS_RUN;
}

/* Returns NULL for the default bus. */
static const char *bus_url(const struct args_bus *bus)
{
    const char *url = bus->url ? bus->url : getenv("LCM_DEFAULT_URL");
    return url && *url ? url : NULL;
}

const char *args_bus_name(const struct args_bus *bus)
{
    const char *url = bus_url(bus);
    return url ? url : "the usual bus of this host";
}

void args_advise_service(const struct args_bus *bus, const char *instead)
{
    const char *url = bus_url(bus), *prefix = bus->prefix;
    complain("start one with 'fmbd%s%s%s%s%s &'%s", url ? " --lcm-url \"" : "", url ? url : "",
             url ? "\"" : "", *prefix ? " --prefix " : "", prefix, instead);
}

struct fmb_client *args_open_client(const struct args_bus *bus, struct fmb_client_options options)
{
    char why[FMB_CLIENT_WHY_MAX];
    options.url = bus->url;
    options.prefix = bus->prefix;
    struct fmb_client *client = fmb_client_open(&options, why, sizeof why);
    if (!client)
        complain("%s", why);
    return client;
}
