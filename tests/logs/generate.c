/* Makes the hard logs of the regression set, and larger ones for benchmarks:
 *
 *   generate KIND FILE              a log of the kind; the same bytes on every machine
 *   generate --list                 the kinds, one a line
 *   generate --instructions         the instruction sets of this program and its machine
 *   generate --blast pairs N FILE   N pair queries, with their results
 *   generate --blast scenes N FILE  N scenes of some 14,000 listed pairs each
 *
 * Exit codes: 0 made, 1 not, 2 wrong options. */
#include "blast.h"
#include "instruction_sets.h"
#include "kinds.h"
#include "query.h"

#include <errno.h>
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MADE = 0, FAILED = 1, USAGE = 2 };

static const struct kind kinds[] = {
    {"hard-2d", "the campaigns' hard pairs in 2D", kind_hard_plane},
    {"hard-3d", "the campaigns' hard pairs in 3D, at rest", kind_hard_space},
    {"hard-3d-moving", "the campaigns' hard pairs in 3D, moving", kind_hard_moving},
    {"turns", "pairs that turn, of whole numbers", kind_turns},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

static const char usage[] =
    "usage: generate KIND FILE\n"
    "       generate --blast pairs|scenes N [OPTIONS] FILE\n"
    "       generate --list | --instructions | --help\n"
    "\n"
    "Writes an event log of LCM: queries of a kind, with the results that the\n"
    "service gives. The same bytes on every machine.\n"
    "\n"
    "  --blast WHAT N  N different queries, of pairs or of scenes of 100 bodies\n"
    "  --seed N        of what is drawn (1)\n"
    "  --bodies N      pairs of N bodies, half of them 2D (8192)\n"
    "  --dim 2|3       pairs of this dimension only\n"
    "  --static        pairs at rest only\n"
    "  --moving        pairs that move only\n"
    "  --whole         pairs of whole bodies only\n"
    "  --by-handle     pairs by handle, as soon as it is known\n"
    "  --compound      pairs of bodies of 1 to 8 frames\n"
    "  --box           pairs with boxes\n"
    "  --point         pairs with points\n"
    "  --certificate   pairs with certificates\n"
    "  --gap           pairs with gaps\n"
    "  --list          prints the kinds\n"
    "  --instructions  prints the instruction sets that this program knows and\n"
    "                  this machine has, the best one last\n";

struct options {
    const char *what; /* of a blast; NULL: none */
    struct blast blast;
};

enum {
    BLAST = 1,
    SEED,
    BODIES,
    DIM,
    STATIC,
    MOVING,
    WHOLE,
    BY_HANDLE,
    COMPOUND,
    BOX,
    POINT,
    CERTIFICATE,
    GAP,
    LIST,
    INSTRUCTIONS,
    HELP
};

static const struct option long_options[] = {{"blast", required_argument, NULL, BLAST},
                                             {"seed", required_argument, NULL, SEED},
                                             {"bodies", required_argument, NULL, BODIES},
                                             {"dim", required_argument, NULL, DIM},
                                             {"static", no_argument, NULL, STATIC},
                                             {"moving", no_argument, NULL, MOVING},
                                             {"whole", no_argument, NULL, WHOLE},
                                             {"by-handle", no_argument, NULL, BY_HANDLE},
                                             {"compound", no_argument, NULL, COMPOUND},
                                             {"box", no_argument, NULL, BOX},
                                             {"point", no_argument, NULL, POINT},
                                             {"certificate", no_argument, NULL, CERTIFICATE},
                                             {"gap", no_argument, NULL, GAP},
                                             {"list", no_argument, NULL, LIST},
                                             {"instructions", no_argument, NULL, INSTRUCTIONS},
                                             {"help", no_argument, NULL, HELP},
                                             {0}};

static bool refuse(const char *what, const char *word)
{
    fprintf(stderr, "generate: %s '%s'\nTry 'generate --help'.\n", what, word);
    return false;
}

static bool read_integer(const char *word, int64_t low, int64_t high, int64_t *out)
{
    char *end;
    errno = 0;
    *out = strtoll(word, &end, 10);
    if (end != word && !*end && errno == 0 && *out >= low && *out <= high)
        return true;
    return refuse("no number that will do:", word);
}

static bool take(int option, char **argv, struct options *out)
{
    int64_t number = 0;
    switch (option) {
    case BLAST: out->what = optarg; return true;
    case SEED:
        if (!read_integer(optarg, 0, INT64_MAX, &number))
            return false;
        out->blast.seed = (uint64_t) number;
        return true;
    case BODIES:
        if (!read_integer(optarg, 2, BLAST_BODIES, &number))
            return false;
        out->blast.bodies = (int) number;
        return true;
    case DIM:
        if (!read_integer(optarg, 2, 3, &number))
            return false;
        out->blast.dim = (int) number;
        return true;
    case STATIC: out->blast.moving = 0; return true;
    case MOVING: out->blast.moving = 1; return true;
    case WHOLE: out->blast.by_handle = 0; return true;
    case BY_HANDLE: out->blast.by_handle = 1; return true;
    case COMPOUND: out->blast.compound = true; return true;
    case BOX: out->blast.want |= FMB_WANT_BOX; return true;
    case POINT: out->blast.want |= FMB_WANT_POINT; return true;
    case CERTIFICATE: out->blast.want |= FMB_WANT_CERTIFICATE; return true;
    case GAP: out->blast.want |= FMB_WANT_GAP; return true;
    default: return refuse("wrong option", argv[optind - 1]);
    }
}

static int list(void)
{
    for (int i = 0; i < KINDS; i++)
        printf("%-14s  %s\n", kinds[i].name, kinds[i].summary);
    return MADE;
}

static int print_instructions(void)
{
    for (int set = INSTRUCTIONS_PLAIN; set <= INSTRUCTIONS_AVX512; set++)
        if (instructions_supported(set))
            printf("%s\n", instructions_name(set));
    return MADE;
}

/* ---- Making ---- */

static int make(const char *path, enum tape_order order,
                bool (*run)(struct tape *tape, const void *context), const void *context)
{
    struct tape *tape = tape_open(path, order);
    if (!tape) {
        fprintf(stderr, "generate: %s: %s\n", path, strerror(errno));
        return FAILED;
    }
    const bool ran = run(tape, context);
    if (tape_close(tape) && ran)
        return MADE;
    fprintf(stderr, "generate: %s: cannot be written in full\n", path);
    return FAILED;
}

static bool run_kind(struct tape *tape, const void *context)
{
    const struct kind *kind = context;
    return kind->run(tape);
}

static bool run_blast(struct tape *tape, const void *context)
{
    const struct options *options = context;
    return (strcmp(options->what, "pairs") == 0 ? blast_pairs : blast_scenes)(tape,
                                                                              &options->blast);
}

static int make_kind(const char *name, const char *path)
{
    for (int i = 0; i < KINDS; i++)
        if (strcmp(kinds[i].name, name) == 0)
            return make(path, TAPE_IN_ORDER, run_kind, &kinds[i]);
    refuse("there is no kind", name);
    return USAGE;
}

static int make_blast(struct options *options, const char *count, const char *path)
{
    if (strcmp(options->what, "pairs") != 0 && strcmp(options->what, "scenes") != 0) {
        refuse("--blast: neither pairs nor scenes:", options->what);
        return USAGE;
    }
    if (!read_integer(count, 1, INT64_MAX, &options->blast.count))
        return USAGE;
    return make(path, TAPE_AS_PUT, run_blast, options);
}

int main(int argc, char **argv)
{
    struct options options = {.blast = {.seed = 1, .moving = -1, .by_handle = -1}};
    int option;
    opterr = 0;
    while ((option = getopt_long(argc, argv, "", long_options, NULL)) != -1) {
        if (option == HELP) {
            fputs(usage, stdout);
            return MADE;
        }
        if (option == LIST)
            return list();
        if (option == INSTRUCTIONS)
            return print_instructions();
        if (!take(option, argv, &options))
            return USAGE;
    }
    if (argc - optind != 2) {
        fputs(usage, stderr);
        return USAGE;
    }
    return options.what ? make_blast(&options, argv[optind], argv[optind + 1])
                        : make_kind(argv[optind], argv[optind + 1]);
}
