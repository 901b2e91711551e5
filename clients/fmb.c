/* fmb: the command. A table of commands, and what is said about them. */
#include "args.h"
#include "commands.h"
#include "complain.h"
#include "fmb.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

struct command {
    const char *name;
    const char *help;
    int (*run)(int argc, char **argv);
};

static int cmd_help(int argc, char **argv);

static const struct command commands[] = {
    {"query", "decide the pairs of a scene, by the service or in process (--local)", cmd_query},
    {"watch", "print the results that pass on the bus", cmd_watch},
    {"record", "write what passes on the bus to a log", cmd_record},
    {"status", "print the heartbeat of the service", cmd_status},
    {"replay", "answer the queries of a log again, and compare", cmd_replay},
    {"log", "inspect and cut event logs, extract scenes", cmd_log},
    {"mesh", "decide which faces of two triangle meshes meet", cmd_mesh},
    {"help", "help on a command: fmb help query", cmd_help},
};

enum { COMMAND_COUNT = sizeof commands / sizeof *commands };

static const struct command *find(const char *name)
{
    for (int i = 0; i < COMMAND_COUNT; i++)
        if (strcmp(commands[i].name, name) == 0)
            return &commands[i];
    return NULL;
}

static void print_help(FILE *out)
{
    fputs(
        "usage: fmb COMMAND [OPTIONS]\n"
        "\n"
        "Do two moving frames meet, when, and in which box? Verdicts are exact.\n"
        "\n"
        "Commands:\n",
        out);
    for (int i = 0; i < COMMAND_COUNT; i++)
        fprintf(out, "  %-8s  %s\n", commands[i].name, commands[i].help);
    fputs(
        "\n"
        "'fmb COMMAND --help' lists the options. 'fmb --version' prints the version.\n"
        "Exit codes: 0 answered, 1 failed, 2 wrong usage, or input that cannot be\n"
        "read or is not a scene. Some commands define them further.\n",
        out);
}

static int unknown_command(const char *name)
{
    complain("unknown command '%s'", name);
    fputs("Try 'fmb --help'.\n", stderr);
    return ARGS_USAGE;
}

/* Refuses further arguments of an option or a command that takes none. */
static int too_many(const char *word)
{
    complain("unknown argument '%s'", word);
    fputs("Try 'fmb --help'.\n", stderr);
    return ARGS_USAGE;
}

static int cmd_help(int argc, char **argv)
{
    const bool of_log = argc > 2 && strcmp(argv[1], "log") == 0;
    if (argc > 2 + of_log)
        return too_many(argv[2 + of_log]);
    if (argc < 2 || strcmp(argv[1], "help") == 0 || strcmp(argv[1], "--help") == 0) {
        print_help(stdout);
        return ARGS_ANSWERED;
    }
    const struct command *command = find(argv[1]);
    if (!command)
        return unknown_command(argv[1]);
    char help[] = "--help";
    char *arguments[] = {argv[1], of_log ? argv[2] : help, help, NULL};
    return command->run(2 + of_log, arguments);
}

static bool is_one_of(const char *word, const char *first, const char *second)
{
    return strcmp(word, first) == 0 || strcmp(word, second) == 0;
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        print_help(stderr);
        return ARGS_USAGE;
    }
    bool help = is_one_of(argv[1], "--help", "-h");
    bool version = is_one_of(argv[1], "--version", "-V");
    if ((help || version) && argc > 2)
        return too_many(argv[2]);
    if (help)
        return cmd_help(1, argv);
    if (version) {
        printf("fmb %s\n", fmb_version());
        return ARGS_ANSWERED;
    }
    const struct command *command = find(argv[1]);
    return command ? command->run(argc - 1, argv + 1) : unknown_command(argv[1]);
}
