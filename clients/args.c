#include "args.h"

#include "fmb_client.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool args_error(const struct args *args, const char *format, ...)
{
    va_list list;
    fprintf(stderr, "fmb %s: ", args->command);
    va_start(list, format);
    vfprintf(stderr, format, list);
    va_end(list);
    fprintf(stderr, "\nTry 'fmb %s --help'.\n", args->command);
    return false;
}

bool args_number(const struct args *args, double low, double high, double *out)
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

/* ---- Options, one after the other ------------------------------------------------------------ */

static const struct option common_options[] = {
    {"lcm-url", required_argument, NULL, 'l'},
    {"prefix", required_argument, NULL, 'p'},
    {"help", no_argument, NULL, 'h'},
    {NULL, 0, NULL, 0},
};

enum { COMMON_OPTIONS = sizeof common_options / sizeof *common_options };

/* The command's own options, then the common ones with the zeros that end them. */
static void join_options(const struct option *own,
                         struct option out[ARGS_OPTIONS_MAX + COMMON_OPTIONS])
{
    int count = 0;
    while (own[count].name && count < ARGS_OPTIONS_MAX)
        count++;
    memcpy(out, own, (size_t) count * sizeof *own);
    memcpy(out + count, common_options, sizeof common_options);
}

/* Of the options that have one, the letters, as getopt wants them; with a '-' before them it tells
 * operands where they stand. */
enum { LETTERS_MAX = 2 * (ARGS_OPTIONS_MAX + COMMON_OPTIONS) + 3 };
static void list_letters(const struct option *options, bool in_order, char out[LETTERS_MAX])
{
    if (in_order)
        *out++ = '-';
    *out++ = ':';
    for (; options->name; options++) {
        if (options->val < ' ')
            continue;
        *out++ = (char) options->val;
        if (options->has_arg == required_argument)
            *out++ = ':';
    }
    *out = '\0';
}

static const char *name_of(const struct option *options, int value)
{
    while (options->name && options->val != value)
        options++;
    return options->name;
}

/* After an option of '?' or ':' from getopt_long(). A long option stands in argv[optind - 1]; of
 * short ones, which may share a word, getopt keeps the letter. */
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

static bool take_prefix(struct args *args)
{
    if (!fmb_client_prefix_ok(optarg))
        return args_error(args, "--prefix: expected at most %d letters, digits, '_' or '-'",
                          FMB_CLIENT_PREFIX_MAX);
    args->bus.prefix = optarg;
    return true;
}

static bool take_option(struct args *args, int option, char **argv, void *out, bool *help)
{
    switch (option) {
    case 'l': args->bus.url = optarg; return true;
    case 'p': return take_prefix(args);
    case 'h': *help = true; return true;
    case '?':
    case ':': return refuse(args, option, argv);
    default: return args->take(args, option, out);
    }
}

/* What stands behind the options. */
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

/* What getopt calls an operand where it tells them in order. */
enum { AN_OPERAND = 1 };

int args_parse(struct args *args, int argc, char **argv, void *out)
{
    struct option options[ARGS_OPTIONS_MAX + COMMON_OPTIONS];
    char letters[LETTERS_MAX];
    bool help = false;
    int option;
    join_options(args->options, options);
    list_letters(options, args->in_order, letters);
    args->bus = (struct args_bus){.prefix = ""};
    args->operands = argv + 1;
    args->operand_count = 0;
    optind = 1;
    opterr = 0;
    while ((option = getopt_long(argc, argv, letters, options, NULL)) != -1) {
        if (args->in_order && option == AN_OPERAND) {
            args->operands[args->operand_count++] = optarg; /* over words that are done with */
            continue;
        }
        args->option = name_of(options, option);
        if (!take_option(args, option, argv, out, &help))
            return ARGS_USAGE;
    }
    memmove(args->operands + args->operand_count, argv + optind,
            (size_t) (argc - optind) * sizeof *argv);
    if (!take_operands(args, args->operand_count + argc - optind))
        return ARGS_USAGE;
    if (!help)
        return ARGS_RUN;
    fputs(args->usage, stdout);
    return ARGS_ANSWERED;
}

const char *args_bus_name(const struct args_bus *bus)
{
    const char *url = bus->url ? bus->url : getenv("LCM_DEFAULT_URL");
    return url && *url ? url : "the usual bus of this host";
}
