#include "bench_options.h"

#include "instruction_sets.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

static const char *const sections[] = {"cells", "box",   "contacts", "poses", "gaps",
                                       "hulls", "radii", "turns",    "worst"};

enum { SECTIONS = sizeof sections / sizeof *sections };

static void help(void)
{
    printf(
        "Usage: bench [OPTION]...\n\n"
        "What a verdict costs, by kind of pair and by method. One thread, on one CPU, its own "
        "time;\n"
        "methods in turn within each block, medians of blocks. Minutes.\n\n"
        "  --section NAME       one section only:");
    for (int i = 0; i < SECTIONS; i++)
        printf(" %s", sections[i]);
    printf(
        "\n"
        "  --instructions NAME  of the batch: best plain two avx2 avx512\n"
        "  --json FILE          writes what is measured there too\n"
        "  --quick              little of everything, to see that it works\n"
        "  --help               prints this\n\n");
    contender_help();
}

static int wrong(const char *what, const char *value)
{
    fprintf(stderr, "bench: %s%s (--help lists the options)\n", what, value);
    return OPTIONS_USAGE;
}

static int set_section(struct bench *bench, const char *name)
{
    for (int i = 0; i < SECTIONS; i++)
        if (strcmp(name, sections[i]) == 0)
            bench->section = sections[i];
    return bench->section ? OPTIONS_RUN : wrong("no section ", name);
}

static int set_instructions(struct bench *bench, const char *name)
{
    for (int set = INSTRUCTIONS_BEST; instructions_name(set); set++)
        if (strcmp(name, instructions_name(set)) == 0) {
            bench->instructions = (enum instructions) set;
            return instructions_supported(set) ? OPTIONS_RUN
                                               : wrong("not here, or not in this build: ", name);
        }
    return wrong("no instructions ", name);
}

static void set_quick(struct bench *bench)
{
    bench->quick = true;
    bench->bodies = 512;
    bench->pairs = 128;
    bench->race = (struct race){2, 2e5};
}

int bench_options(int argc, char **argv, struct bench *bench, const char **json)
{
    enum { SECTION = 1, INSTRUCTIONS, JSON, QUICK, HELP };
    static const struct option options[] = {{"section", required_argument, NULL, SECTION},
                                            {"instructions", required_argument, NULL, INSTRUCTIONS},
                                            {"json", required_argument, NULL, JSON},
                                            {"quick", no_argument, NULL, QUICK},
                                            {"help", no_argument, NULL, HELP},
                                            {NULL, 0, NULL, 0}};
    *bench = (struct bench){.bodies = 8192, .pairs = 4096, .race = {15, 1e7}, .seed = 20240607};
    *json = NULL;
    int outcome = OPTIONS_RUN;
    for (int option;
         outcome == OPTIONS_RUN && (option = getopt_long(argc, argv, "", options, NULL)) != -1;) {
        switch (option) {
        case SECTION: outcome = set_section(bench, optarg); break;
        case INSTRUCTIONS: outcome = set_instructions(bench, optarg); break;
        case JSON: *json = optarg; break;
        case QUICK: set_quick(bench); break;
        case HELP: help(); return 0;
        default: return OPTIONS_USAGE; /* it has been said what is wrong */
        }
    }
    if (outcome == OPTIONS_RUN && optind < argc)
        return wrong("what is ", argv[optind]);
    return outcome;
}
