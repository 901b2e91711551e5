#include "bus_options.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

static const char *const sections[] = {"pairs", "scenes"};

enum { SECTIONS = sizeof sections / sizeof *sections };

static void help(void)
{
    printf(
        "Usage: bench-bus [OPTION]...\n\n"
        "Times of the service from bus to bus, beside an echo that does nothing, in turns.\n"
        "Starts fmbd and the echo itself. Minutes.\n\n"
        "  --section NAME       one section only:");
    for (int i = 0; i < SECTIONS; i++)
        printf(" %s", sections[i]);
    printf(
        "\n"
        "  --json FILE          writes the figures to a file too\n"
        "  --quick              little of everything, to see that it works\n"
        "  --help               prints this\n");
}

static int wrong(const char *what, const char *value)
{
    fprintf(stderr, "bench-bus: %s%s (--help lists the options)\n", what, value);
    return OPTIONS_USAGE;
}

static int set_section(struct bus_bench *bench, const char *name)
{
    for (int i = 0; i < SECTIONS; i++)
        if (strcmp(name, sections[i]) == 0)
            bench->section = sections[i];
    return bench->section ? OPTIONS_RUN : wrong("no section ", name);
}

static void set_quick(struct bus_bench *bench)
{
    bench->quick = true;
    bench->blocks = 2;
    bench->trips = 20;
    bench->scene_trips = 4;
}

int bus_options(int argc, char **argv, struct bus_bench *bench, const char **json)
{
    enum { SECTION = 1, JSON, QUICK, HELP };
    static const struct option options[] = {{"section", required_argument, NULL, SECTION},
                                            {"json", required_argument, NULL, JSON},
                                            {"quick", no_argument, NULL, QUICK},
                                            {"help", no_argument, NULL, HELP},
                                            {NULL, 0, NULL, 0}};
    *bench = (struct bus_bench){.blocks = 60, .trips = 500, .scene_trips = 60, .seed = 20240607};
    *json = NULL;
    int outcome = OPTIONS_RUN;
    for (int option;
         outcome == OPTIONS_RUN && (option = getopt_long(argc, argv, "", options, NULL)) != -1;) {
        switch (option) {
        case SECTION: outcome = set_section(bench, optarg); break;
        case JSON: *json = optarg; break;
        case QUICK: set_quick(bench); break;
        case HELP: help(); return 0;
        default: return OPTIONS_USAGE; /* getopt_long() has reported it */
        }
    }
    if (outcome == OPTIONS_RUN && optind < argc)
        return wrong("what is ", argv[optind]);
    return outcome;
}
