/* fmb log: commands of its own for event logs. A table of them, and what is said about them. */
#include "commands.h"

#include "args.h"
#include "complain.h"

#include <stdio.h>
#include <string.h>

struct subcommand {
    const char *name;
    const char *help;
    int (*run)(int argc, char **argv);
};

static const struct subcommand commands[] = {
    {"info", "what is in a log, and whether all of it is whole", cmd_log_info},
    {"cut", "copy a part of a log into a new one, or repair one", cmd_log_cut},
    {"scene", "print a query of a log as a scene", cmd_log_scene},
};

enum { COMMAND_COUNT = sizeof commands / sizeof *commands };

static void print_help(FILE *out)
{
    fputs(
        "usage: fmb log COMMAND [OPTIONS] LOG...\n"
        "\n"
        "Inspects LCM event logs, as lcm-logger and LCM's file provider write them, and\n"
        "copies parts of them. Logs may be damaged: intact events are read, damage is\n"
        "reported with its offset.\n"
        "\n"
        "Commands:\n",
        out);
    for (int i = 0; i < COMMAND_COUNT; i++)
        fprintf(out, "  %-8s  %s\n", commands[i].name, commands[i].help);
    fputs("\n'fmb log COMMAND --help' lists the options.\n", out);
}

static bool is_help(const char *word)
{
    return strcmp(word, "help") == 0 || strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0;
}

int cmd_log(int argc, char **argv)
{
    if (argc < 2) {
        print_help(stderr);
        return ARGS_USAGE;
    }
    if (argc == 3 && strcmp(argv[1], "help") == 0) {
        char option[] = "--help";
        char *arguments[] = {argv[0], argv[2], option, NULL};
        return cmd_log(argc, arguments);
    }
    if (argc == 2 && is_help(argv[1])) {
        print_help(stdout);
        return ARGS_ANSWERED;
    }
    for (int i = 0; i < COMMAND_COUNT; i++)
        if (strcmp(commands[i].name, argv[1]) == 0)
            return commands[i].run(argc - 1, argv + 1);
    fputs("fmb log: unknown command '", stderr);
    complain_text(argv[1]);
    fputs("'\nTry 'fmb log --help'.\n", stderr);
    return ARGS_USAGE;
}
