/* fmb query: reads scenes and prints the answers to their pairs. */
#include "commands.h"

#include "answers.h"
#include "args.h"
#include "complain.h"
#include "json.h"
#include "output.h"
#include "progress.h"
#include "report.h"
#include "svg.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char usage[] =
    "usage: fmb query [OPTIONS] [FILE]\n"
    "\n"
    "Decides the pairs of the scenes in FILE, and prints the answers in the order of\n"
    "the pairs. Without FILE, or where it is '-', reads standard input.\n"
    "\n"
    "  --local          decide in this process; without it, the service on the bus\n"
    "                   decides\n"
    "  --json           one line of JSON for each scene, exact; without it, tables\n"
    "                   for people, rounded\n"
    "  --box            give the box of the intersection too\n"
    "  --gap            give the signed distance too: how far apart the bodies are,\n"
    "                   or minus how deep they overlap, as two bounds; with --json\n"
    "                   also the direction that proves the lower one, and the nearest\n"
    "                   points\n"
    "  --certificate    give a proof of each verdict too. It is checked here with the\n"
    "                   numbers of the scene alone; a verdict without a valid proof\n"
    "                   counts as not decided. The service then decides each pair by\n"
    "                   a query of its own, which takes longer\n"
    "  --svg FILE       draw the scenes into FILE; implies --box\n"
    "  --force          overwrite FILE of --svg even if it is no picture\n"
    "  --method NAME    how to decide: certified (the default: never wrong, and\n"
    "                   fast); exact (boxes and intervals to the last bit); or fmb or\n"
    "                   sat, which are inexact, for comparison\n"
    "  --timeout SECONDS    longest time before a query is sent again (0.5); the\n"
    "                       first repeats come after milliseconds\n"
    "  --retries N          give a query up after N + 1 timeouts (5)\n" ARGS_COMMON_USAGE
    "\n"
    "A scene. A body has frames, or is itself one: a box of full size, or components\n"
    "from an origin. Pairs are all but those to ignore, unless \"pairs\": [[1,2]] lists\n"
    "them. name, orientation [w,x,y,z] (of any length), velocity, duration (default\n"
    "1) and margin are optional. With a margin, pairs that touch or overlap, or are\n"
    "no farther apart, have gaps:\n"
    "  {\"dim\": 3, \"duration\": 1.0, \"margin\": 0.001,\n"
    "   \"bodies\": [{\"id\": 1, \"name\": \"table\", \"shape\": \"box\", \"size\": [2,1,0.25],\n"
    "               \"position\": [0,0,0.125]},\n"
    "              {\"id\": 2, \"position\": [0.5,0,0.5], \"orientation\": [1,0,0,1],\n"
    "               \"velocity\": [0,0,-0.1],\n"
    "               \"frames\": [{\"shape\": \"box\", \"size\": [0.1,0.1,0.2],\n"
    "                           \"position\": [0,0,0.1]},\n"
    "                          {\"shape\": \"tetrahedron\", \"origin\": [0,0,0],\n"
    "                           \"components\": [[1,0,0],[0,1,0],[0,0,1]]}]},\n"
    "              {\"id\": 3, \"shape\": \"cuboid\", \"origin\": [0,0,0],\n"
    "               \"components\": [[1,0,0],[0,1,0],[0,0,1]]}],\n"
    "   \"ignore\": [[1,3]]}\n"
    "\n"
    "Exit codes: 0 answered; 1 a pair could not be decided, or no service answered; 2\n"
    "wrong usage, or input that cannot be read or is not a scene.\n";

struct query_options {
    bool local, json, box, gap, certificate;
    const struct fmb_method *method; /* NULL: the default, of this process or of the service */
    struct output_options svg;
    double timeout;
    long retries;
};

/* ---- Options --------------------------------------------------------------------------------- */

static bool take_method(const struct args *args, void *out)
{
    const struct fmb_method **method = out;
    *method = fmb_method_by_name(optarg);
    return *method ||
           args_error(args, "--method: there are certified, exact, fmb and sat, not '%s'", optarg);
}

/* ---- Answers --------------------------------------------------------------------------------- */

struct query_run {
    const struct query_options *options;
    const struct args_bus *bus_options;
    const char *input_name;
    const struct fmb_scene *scene;
    struct report *report[2]; /* the printed one, and the picture or NULL */
    struct answers_bus *bus;  /* NULL: not opened yet */
    struct progress progress;
    bool undecided; /* a pair has no verdict */
};

static void take_answer(void *user, const struct fmb_client_answer *answer)
{
    struct query_run *run = user;
    struct fmb_client_answer checked = *answer;
    char refutation[VERIFY_TEXT_MAX];
    if (run->options->certificate && answer->status == FMB_OK)
        verify_answer(run->scene, run->options->local ? "the" : "the service's", &checked,
                      refutation);
    for (int i = 0; i < 2 && run->report[i]; i++)
        run->report[i]->pair(run->report[i], &checked);
    run->undecided = run->undecided || checked.status != FMB_OK;
    progress_to(&run->progress, run->progress.done + 1, run->progress.total);
}

/* The bus is opened for the first scene: an invalid one is reported without a bus. Returns false if
 * later scenes need not be queried. */
static bool answer_scene(struct query_run *run, struct owned_scene *owner)
{
    const struct query_options *options = run->options;
    struct fmb_scene *scene = &owner->scene;
    bool more = true;
    scene->method = options->method;
    scene->want = FMB_WANT_TIMES | (options->box ? FMB_WANT_BOX : 0) |
                  (options->gap ? FMB_WANT_GAP : 0) |
                  (options->certificate ? FMB_WANT_CERTIFICATE : 0);
    run->scene = scene;
    for (int i = 0; i < 2 && run->report[i]; i++) {
        run->report[i]->scene = owner;
        run->report[i]->begin(run->report[i]);
    }
    run->progress = progress_begin("pairs", (int64_t) scene_count_pairs(owner));
    if (isatty(STDOUT_FILENO)) /* the answers themselves show the progress */
        run->progress.enabled = false;
    if (!options->local && !run->bus)
        run->bus = answers_bus_open(run->bus_options, options->timeout, (int) options->retries);
    if (options->local)
        answers_local(owner, take_answer, run);
    else
        more = answers_bus_scene(run->bus, owner, take_answer, run);
    progress_end(&run->progress);
    for (int i = 0; i < 2 && run->report[i]; i++)
        run->report[i]->end(run->report[i]);
    return more;
}

static int answer_scenes(struct query_run *run, int fd)
{
    struct json_reader *reader = json_open(fd);
    struct owned_scene scene;
    enum json_outcome outcome;
    bool more = true;
    while (more && (outcome = json_next(reader, &scene)) == JSON_SCENE) {
        more = answer_scene(run, &scene);
        scene_clear(&scene);
    }
    const bool wrong = more && outcome != JSON_END;
    if (wrong)
        complain("%s: %s", run->input_name, json_error(reader));
    json_close(reader);
    if (wrong)
        return ARGS_USAGE;
    return !more || run->undecided ? ARGS_FAILED : ARGS_ANSWERED;
}

/* ---- Files ----------------------------------------------------------------------------------- */

static bool write_picture(const struct query_options *options, const struct svg *svg)
{
    struct output *output;
    if (!output_open(&options->svg, &output))
        return false;
    if (output)
        svg_write(svg, output->file);
    return output_close(output, true);
}

/* file: NULL for standard input. */
static int run_query(const struct query_options *options, const struct args_bus *bus,
                     const char *file, int fd)
{
    struct report_json json = report_json(stdout);
    struct report_text text = report_text(stdout, options->box, options->gap);
    struct svg *svg = options->svg.path ? svg_open() : NULL;
    struct query_run run = {
        .options = options,
        .bus_options = bus,
        .input_name = file ? file : "standard input",
        .report = {options->json ? &json.report : &text.report, svg ? svg_report(svg) : NULL}};
    int code = answer_scenes(&run, fd);
    if (run.bus)
        answers_bus_close(run.bus);
    bool good = code == ARGS_USAGE || write_picture(options, svg);
    svg_close(svg);
    good = output_flush() && good;
    return good || code != ARGS_ANSWERED ? code : ARGS_FAILED;
}

int cmd_query(int argc, char **argv)
{
    struct output_rules rules = {.force = false};
    struct query_options options = {
        .svg = {.kind = OUTPUT_PICTURE, .rules = &rules}, .timeout = 0.5, .retries = 5};
    const struct args_option own[] = {
        {"local", ARGS_FLAG, .out = &options.local},
        {"json", ARGS_FLAG, .out = &options.json},
        {"box", ARGS_FLAG, .out = &options.box},
        {"gap", ARGS_FLAG, .out = &options.gap},
        {"certificate", ARGS_FLAG, .out = &options.certificate},
        {"method", ARGS_OTHER, &options.method, .take = take_method},
        {"svg", ARGS_TEXT, .out = &options.svg.path},
        {"force", ARGS_FLAG, .out = &rules.force},
        {"timeout", ARGS_NUMBER, &options.timeout, .low = 0.001, .high = 3600},
        {"retries", ARGS_INTEGER, &options.retries, .high = 1000},
        {.name = NULL},
    };
    struct args args = {"query", usage, own, .operand = "FILE", .operands_max = 1};
    int code = args_parse(&args, argc, argv);
    if (code != ARGS_RUN)
        return code;
    options.box = options.box || options.svg.path;
    const bool named = args.operand_count > 0 && strcmp(args.operands[0], "-") != 0;
    const char *file = named ? args.operands[0] : NULL;
    int fd = file ? open(file, O_RDONLY) : STDIN_FILENO;
    if (fd < 0) {
        complain("%s: %s", file, strerror(errno));
        return ARGS_USAGE;
    }
    rules.other_input = file ? file : "/dev/stdin";
    code = output_check(&options.svg) ? run_query(&options, &args.bus, file, fd) : ARGS_USAGE;
    if (file)
        close(fd);
    return code;
}
