/* fmb: the command. Tables of its commands, and of those of fmb log; their help. */
#include "args.h"
#include "commands.h"
#include "escape.h"
#include "fmb.h"
#include "json.h"
#include "progress.h"

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

static int cmd_log(int argc, char **argv);

static const struct command commands[] = {
    {"query", "decide the pairs of a scene, by the service or in process (--local)", cmd_query},
    {"watch", "print the results that pass on the bus", cmd_watch},
    {"record", "write what passes on the bus to a log", cmd_record},
    {"status", "print the heartbeat of the service", cmd_status},
    {"replay", "answer the queries of a log again, and compare", cmd_replay},
    {"log", "inspect and cut event logs, print results and scenes", cmd_log},
    {"scene", "print a URDF robot as a scene, or one for each row of joint values", cmd_scene},
    {"path", "prove that a robot meets nothing between rows of joint values", cmd_path},
    {"mesh", "decide which faces of two triangle meshes meet", cmd_mesh},
    {"help", "help on a command: fmb help query", NULL}, /* run_menu() */
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
    escape_text(stderr, word);
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

static bool is_help(const char *word)
{
    return strcmp(word, "help") == 0 || is_one_of(word, "--help", "-h");
}

/* argv[0]: the name of the menu. "help log cut" becomes "log cut --help". */
static int run_menu(const struct menu *menu, int argc, char **argv)
{
    static char option[] = "--help";
    if (argc < 2) {
        print_help(menu, stderr);
        return ARGS_USAGE;
    }
    if (!is_help(argv[1]))
        return run_command(menu, argc - 1, argv + 1);
    if (argc == 2 || is_help(argv[2])) {
        print_help(menu, stdout);
        return ARGS_ANSWERED;
    }
    if (strcmp(argv[1], "help") != 0)
        return refuse(menu, "argument", argv[2]);
    memmove(argv + 1, argv + 2, (size_t) (argc - 2) * sizeof *argv);
    argv[argc - 1] = option;
    return run_menu(menu, argc, argv);
}

static int cmd_log(int argc, char **argv)
{
    return run_menu(&fmb_log, argc, argv);
}

int main(int argc, char **argv)
{
    progress_allow();
    json_exit_without_memory();
    if (argc < 2 || !is_one_of(argv[1], "--version", "-V"))
        return run_menu(&fmb, argc, argv);
    if (argc > 2)
        return refuse(&fmb, "argument", argv[2]);
    printf("fmb %s\n", fmb_version());
    return ARGS_ANSWERED;
}
