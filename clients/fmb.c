/* fmb: the command. Tables of its commands, and of those of fmb log; their help. */
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

/* A program with commands, or a command with commands of its own. */
struct menu {
    const char *name;               /* "fmb log" */
    const char *usage, *notes;      /* what its help prints before and after the commands */
    const struct command *commands; /* ends with one without a name */
};

static int cmd_help(int argc, char **argv);
static int cmd_log(int argc, char **argv);

static const struct command commands[] = {
    {"query", "decide the pairs of a scene, by the service or in process (--local)", cmd_query},
    {"watch", "print the results that pass on the bus", cmd_watch},
    {"record", "write what passes on the bus to a log", cmd_record},
    {"status", "print the heartbeat of the service", cmd_status},
    {"replay", "answer the queries of a log again, and compare", cmd_replay},
    {"log", "inspect and cut event logs, print results and scenes", cmd_log},
    {"scene", "print a URDF robot as a scene, or one for each row of joint values", cmd_scene},
    {"mesh", "decide which faces of two triangle meshes meet", cmd_mesh},
    {"help", "help on a command: fmb help query", cmd_help},
    {.name = NULL},
};

static const struct command log_commands[] = {
    {"info", "what is in a log, and whether all of it is whole", cmd_log_info},
    {"cut", "copy a part of a log into a new one, or repair one", cmd_log_cut},
    {"scene", "print a query of a log as a scene", cmd_log_scene},
    {"results", "print the results of a log, as a table, JSON or CSV", cmd_log_results},
    {.name = NULL},
};

static const struct menu fmb = {
    "fmb",
    "usage: fmb COMMAND [OPTIONS]\n"
    "\n"
    "Decides exactly whether rigid bodies meet, when, and in which box.\n",
    "'fmb COMMAND --help' lists the options. 'fmb --version' prints the version.\n"
    "Exit codes: 0 answered, 1 failed, 2 wrong usage, or input that cannot be\n"
    "read or is not a scene. Some commands define them further.\n",
    commands};

static const struct menu fmb_log = {
    "fmb log",
    "usage: fmb log COMMAND [OPTIONS] LOG...\n"
    "\n"
    "Inspects LCM event logs, as lcm-logger and LCM's file provider write them, and\n"
    "copies parts of them. Logs may be damaged: intact events are read, damage is\n"
    "reported with its offset.\n",
    "'fmb log COMMAND --help' lists the options.\n", log_commands};

static void print_help(const struct menu *menu, FILE *out)
{
    fprintf(out, "%s\nCommands:\n", menu->usage);
    for (const struct command *command = menu->commands; command->name; command++)
        fprintf(out, "  %-8s  %s\n", command->name, command->help);
    fprintf(out, "\n%s", menu->notes);
}

/* what: "command", or "argument" after an option or a command that takes none. */
static int refuse(const struct menu *menu, const char *what, const char *word)
{
    fprintf(stderr, "%s: unknown %s '", menu->name, what);
    complain_text(word);
    fprintf(stderr, "'\nTry '%s --help'.\n", menu->name);
    return ARGS_USAGE;
}

static int run_command(const struct menu *menu, int argc, char **argv)
{
    for (const struct command *command = menu->commands; command->name; command++)
        if (strcmp(command->name, argv[0]) == 0)
            return command->run(argc, argv);
    return refuse(menu, "command", argv[0]);
}

static bool is_one_of(const char *word, const char *first, const char *second)
{
    return strcmp(word, first) == 0 || strcmp(word, second) == 0;
}

static int cmd_help(int argc, char **argv)
{
    const bool of_log = argc > 2 && strcmp(argv[1], "log") == 0;
    if (argc > 2 + of_log)
        return refuse(&fmb, "argument", argv[2 + of_log]);
    if (argc < 2 || is_one_of(argv[1], "help", "--help")) {
        print_help(&fmb, stdout);
        return ARGS_ANSWERED;
    }
    char help[] = "--help";
    char *arguments[] = {argv[1], of_log ? argv[2] : help, help, NULL};
    return run_command(&fmb, 2 + of_log, arguments);
}

static int cmd_log(int argc, char **argv)
{
    const bool help = argc > 1 && strcmp(argv[1], "help") == 0;
    if (argc < 2) {
        print_help(&fmb_log, stderr);
        return ARGS_USAGE;
    }
    if (argc == 3 && help) {
        char option[] = "--help";
        char *arguments[] = {argv[2], option, NULL};
        return run_command(&fmb_log, 2, arguments);
    }
    if (argc == 2 && (help || is_one_of(argv[1], "--help", "-h"))) {
        print_help(&fmb_log, stdout);
        return ARGS_ANSWERED;
    }
    return run_command(&fmb_log, argc - 1, argv + 1);
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        print_help(&fmb, stderr);
        return ARGS_USAGE;
    }
    bool help = is_one_of(argv[1], "--help", "-h");
    bool version = is_one_of(argv[1], "--version", "-V");
    if ((help || version) && argc > 2)
        return refuse(&fmb, "argument", argv[2]);
    if (help)
        return cmd_help(1, argv);
    if (version) {
        printf("fmb %s\n", fmb_version());
        return ARGS_ANSWERED;
    }
    return run_command(&fmb, argc - 1, argv + 1);
}
