/* fmb query: reads scenes and prints the answers to their pairs. */
#include "commands.h"

#include "answers.h"
#include "args.h"
#include "complain.h"
#include "json.h"
#include "number.h"
#include "output.h"
#include "progress.h"
#include "page.h"
#include "report.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
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
    "  --csv            one line of CSV for each pair, exact, after a line of column\n"
    "                   names\n"
    "  --contacts       print only the pairs that touch, overlap or are near, and\n"
    "                   those that could not be decided; scenes without such pairs\n"
    "                   have no table\n"
    "  --all            print all pairs in tables too, which otherwise leave out the\n"
    "                   separated pairs of a scene after the first 20\n"
    "  --fail-if WHAT   exit with 3, after all scenes, if a pair is overlapping;\n"
    "                   touching: or only touches; near: or is within the margin\n"
    "  --box            give the box of the intersection too\n"
    "  --point          give a point of each contact too, and a time at which both\n"
    "                   bodies contain it\n"
    "  --gap            give the signed distance too: how far apart the bodies are,\n"
    "                   or minus how deep they overlap, as two bounds; with --json\n"
    "                   also the direction that proves the lower one, and the nearest\n"
    "                   or deepest points\n"
    "  --certificate    give a proof of each verdict too. It is checked here with the\n"
    "                   numbers of the scene alone; a verdict without a valid proof\n"
    "                   counts as not decided. A pair with a body of several frames\n"
    "                   has a verdict, but no certificate; their number is reported.\n"
    "                   The service decides each pair by a query of its own, which\n"
    "                   takes longer\n"
    "  --html FILE      write a page that plays the scenes into FILE; implies --box\n"
    "  --force          overwrite FILE of --html even if it is no page\n"
    "  --method NAME    how to decide: certified (the default: never wrong, and\n"
    "                   fast); exact (without radii, boxes and intervals to the last\n"
    "                   bit); or fmb or sat, which are inexact, for comparison\n"
    "  --timeout SECONDS    longest time before a query is sent again (0.5); the\n"
    "                       first repeats come after milliseconds\n"
    "  --retries N          give a query up after N + 1 timeouts (5)\n" ARGS_COMMON_USAGE
    "\n"
    "A scene. A body has frames, or is itself one: a box of full size, components\n"
    "from an origin, a \"hull\" of \"vertices\": [[0,0,0],[1,0,0]], a \"sphere\" of\n"
    "\"radius\", or a \"capsule\" of \"radius\" and \"length\" (of its core, along z; in 2D\n"
    "y). A \"radius\" extends any other shape by that much on every side. A \"cylinder\"\n"
    "of \"radius\" and \"length\" (along z) is a hull of \"sides\" (16) that contains it.\n"
    "Pairs are all but those to ignore, unless \"pairs\": [[1,2]] lists them; names may\n"
    "stand for ids there. name, orientation [w,x,y,z] (of any length; or\n"
    "\"orientation_xyzw\"), velocity, duration (default 1) and margin are optional. In\n"
    "place of velocity, \"end\": {\"position\": [0,0,1], \"orientation\": [1,0,0,1]} is\n"
    "the pose at the end of the window: a body turns to it by less than half a turn.\n"
    "With a margin, pairs that touch or overlap, or are no farther apart, have gaps:\n"
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
    "wrong usage, or input that cannot be read or is not a scene; 3 otherwise, if a\n"
    "pair is as --fail-if says.\n";

/* The exit code of --fail-if. */
enum { FAILED_IF = 3 };

struct query {
    /* Options. */
    bool local, json, csv, certificate;
    struct report_rows rows;
    int fail_if;                     /* least severity; 0: not given */
    const struct fmb_method *method; /* NULL: the default, of this process or of the service */
    struct output_options html;
    double timeout;
    long retries;
    struct args_bus bus;
    const char *input; /* name of the file */
    /* The run. */
    struct page *page;           /* NULL: none */
    struct answers_bus *answers; /* NULL: not opened yet */
    const struct fmb_scene *scene;
    int64_t pairs, answered; /* of the scene */
    bool undecided;          /* a pair has no verdict */
    uint64_t unproven;       /* pairs without a certificate because a body has several frames */
    bool has_margin;         /* a scene has a margin */
    int64_t scenes, empty;   /* empty: scenes without a pair to decide */
    bool moves;              /* a body moves in a scene whose duration is not 0 */
    int64_t still_body;      /* first body that would move if the duration were not 0; 0: none */
    int64_t uneven_body;     /* id of the first body that turns_unevenly(); 0: none */
    int worst;               /* severity of all pairs */
    double outside;          /* of all scenes */
};

static bool take_method(const struct args *args, void *out)
{
    const struct fmb_method **method = out;
    *method = fmb_method_by_name(optarg);
    return *method ||
           args_error(args, "--method: there are certified, exact, fmb and sat, not '%s'", optarg);
}

/* How close a pair comes: twice the verdict, and 1 more if it is near. */
static int severity(double margin, const struct fmb_answer *answer)
{
    return 2 * (int) answer->verdict + report_is_near(margin, answer);
}

static bool take_fail_if(const struct args *args, void *out)
{
    int *fail_if = out;
    if (*fail_if)
        return args_error(args,
                          "--fail-if: given twice; near includes touching, and both include "
                          "overlapping");
    *fail_if = strcmp(optarg, "overlapping") == 0 ? 2 * FMB_OVERLAPPING
               : strcmp(optarg, "touching") == 0  ? 2 * FMB_TOUCHING
               : strcmp(optarg, "near") == 0      ? 2 * FMB_SEPARATED + 1
                                                  : 0;
    return *fail_if ||
           args_error(args, "--fail-if: there are overlapping, touching and near, not '%s'",
                      optarg);
}

static void take_answer(void *user, const struct fmb_client_answer *answer)
{
    struct query *query = user;
    struct fmb_client_answer checked = *answer;
    char refutation[VERIFY_TEXT_MAX];
    if (query->certificate && answer->status == FMB_OK) {
        if (pair_is_certified(query->scene, (unsigned[]){answer->a, answer->b}))
            verify_answer(query->scene, query->local ? "the" : "the service's", &checked,
                          refutation);
        else
            query->unproven++;
    }
    report_pair(&query->rows, &checked);
    if (query->page)
        page_pair(query->page, query->rows.scene->dim, NULL, &checked);
    query->undecided = query->undecided || checked.status != FMB_OK;
    const int found = severity(query->scene->margin, &checked.answer);
    query->worst = found > query->worst ? found : query->worst;
    progress_to(++query->answered, query->pairs);
}

/* Whether the body turns, and its quaternions at the start and at the end of the window differ in
 * length by more than rounding errors. */
static bool turns_unevenly(const struct fmb_placement *body)
{
    double square[2] = {0, 0}, product = 0, largest = 0;
    for (int i = 0; i < body->orientation_count; i++)
        largest = fmax(largest, fabs(body->orientation[i]));
    for (int i = 0; body->end_count > 0 && i < body->orientation_count; i++) {
        const double q[2] = {body->orientation[i] / largest, body->end_orientation[i] / largest};
        square[0] += q[0] * q[0];
        square[1] += q[1] * q[1];
        product += q[0] * q[1];
    }
    return fabs(square[1] - square[0]) > 1e-12 * square[0] &&
           product * product < (1 - 1e-15) * square[0] * square[1];
}

/* Records what report_limits() reports of a scene. */
static void note_scene(struct query *query, const struct fmb_scene *scene, uint64_t pairs)
{
    query->scenes++;
    query->empty += pairs == 0;
    query->has_margin = query->has_margin || scene->margin > 0;
    for (size_t i = 0; i < scene->placement_count; i++) {
        const struct fmb_placement *body = &scene->placements[i];
        const double *v = body->velocity;
        const bool moving = v[0] != 0 || v[1] != 0 || v[2] != 0;
        query->moves = query->moves || (moving && scene->duration > 0) || body->end_count > 0;
        if (!query->uneven_body && turns_unevenly(body))
            query->uneven_body = body->id;
        if (moving && !query->moves && !query->still_body)
            query->still_body = body->id;
    }
}

/* The bus is opened for the first scene: an invalid one is reported without a bus. Returns false if
 * later scenes need not be queried. */
static bool answer_scene(struct query *query, struct owned_scene *owner)
{
    struct fmb_scene *scene = &owner->scene;
    bool more = true;
    scene->method = query->method;
    scene->want = FMB_WANT_TIMES | (query->rows.box ? FMB_WANT_BOX : 0) |
                  (query->rows.point ? FMB_WANT_POINT : 0) | (query->rows.gap ? FMB_WANT_GAP : 0) |
                  (query->certificate ? FMB_WANT_CERTIFICATE : 0);
    query->scene = scene;
    const uint64_t pairs = scene_count_pairs(owner);
    note_scene(query, scene, pairs);
    report_begin_scene(&query->rows, owner);
    if (query->page)
        page_scene_begin(query->page, scene);
    query->pairs = (int64_t) pairs;
    query->answered = 0;
    if (!isatty(STDOUT_FILENO)) /* there the answers themselves show the progress */
        progress_begin("pairs");
    if (!query->local && !query->answers)
        query->answers = answers_bus_open(&query->bus, query->timeout, (int) query->retries);
    if (query->local)
        answers_local(owner, take_answer, query);
    else
        more = answers_bus_scene(query->answers, owner, take_answer, query);
    progress_end();
    report_end_scene(&query->rows);
    if (query->page)
        page_step_end(query->page);
    return more;
}

static int answer_scenes(struct query *query, int fd)
{
    struct json_reader *reader = json_open(fd);
    struct owned_scene scene;
    enum json_outcome outcome;
    bool more = true;
    while (more && (outcome = json_next(reader, &scene)) == JSON_SCENE) {
        more = answer_scene(query, &scene);
        query->outside = fmax(query->outside, scene.outside);
        scene_clear(&scene);
    }
    const bool wrong = more && outcome != JSON_END;
    if (wrong)
        complain("%s: %s", query->input, json_error(reader));
    json_close(reader);
    if (wrong)
        return ARGS_USAGE;
    if (!more || query->undecided)
        return ARGS_FAILED;
    return query->fail_if && query->worst >= query->fail_if ? FAILED_IF : ARGS_ANSWERED;
}

/* Reports what the answers do not show. */
static void report_limits(const struct query *query)
{
    char text[NUMBER_TEXT_MAX];
    scene_report_outside(query->input, query->outside);
    if (query->unproven > 0)
        complain("no certificate for %s of the pairs: a body has several frames",
                 number_grouped((int64_t) query->unproven, text));
    if (query->fail_if == 2 * FMB_SEPARATED + 1 && query->scene && !query->has_margin)
        complain("--fail-if near: no scene has a \"margin\", so no separated pair is near");
    if (query->still_body && !query->moves)
        complain("body %" PRId64 " has a velocity, but \"duration\" is 0: nothing moves",
                 query->still_body);
    if (query->uneven_body)
        complain("body %" PRId64
                 " turns unevenly: its orientations at the start and at the end of "
                 "the window have different lengths",
                 query->uneven_body);
    if (query->empty > 0 && query->scenes == 1)
        complain("the scene has no pair to decide");
    else if (query->empty > 0)
        complain("%" PRId64 " of %" PRId64 " scenes have no pair to decide", query->empty,
                 query->scenes);
}

static int run_query(struct query *query, int fd)
{
    report_begin(&query->rows);
    if (query->html.path)
        query->page = page_open(&(struct page_options){.kind = PAGE_SCENES, .title = query->input});
    int code = answer_scenes(query, fd);
    report_end(&query->rows);
    if (code != ARGS_USAGE)
        report_limits(query);
    if (query->answers)
        answers_bus_close(query->answers);
    bool good = code == ARGS_USAGE || page_save(query->page, &query->html);
    page_close(query->page);
    good = output_flush() && good;
    return good || code == ARGS_USAGE ? code : ARGS_FAILED;
}

int cmd_query(int argc, char **argv)
{
    struct output_rules rules = {.force = false};
    struct query query = {.html = {.kind = OUTPUT_PAGE, .rules = &rules},
                          .timeout = 0.5,
                          .retries = 5,
                          .rows = {.printer.out = stdout}};
    const struct args_option own[] = {
        {"local", ARGS_FLAG, .out = &query.local},
        {"json", ARGS_FLAG, .out = &query.json},
        {"csv", ARGS_FLAG, .out = &query.csv},
        {"contacts", ARGS_FLAG, .out = &query.rows.contacts},
        {"all", ARGS_FLAG, .out = &query.rows.all},
        {"fail-if", ARGS_OTHER, &query.fail_if, .take = take_fail_if},
        {"box", ARGS_FLAG, .out = &query.rows.box},
        {"point", ARGS_FLAG, .out = &query.rows.point},
        {"gap", ARGS_FLAG, .out = &query.rows.gap},
        {"certificate", ARGS_FLAG, .out = &query.certificate},
        {"method", ARGS_OTHER, &query.method, .take = take_method},
        {"html", ARGS_TEXT, .out = &query.html.path},
        {"force", ARGS_FLAG, .out = &rules.force},
        {"timeout", ARGS_NUMBER, &query.timeout, .low = 0.001, .high = 3600},
        {"retries", ARGS_INTEGER, &query.retries, .high = 1000},
        {.name = NULL},
    };
    struct args args = {"query", usage, own, .operand = "FILE", .operands_max = 1};
    int code = args_parse(&args, argc, argv);
    if (code != ARGS_RUN)
        return code;
    if (!args_exclude(&args, query.csv, query.json, "--csv and --json") ||
        !args_exclude(&args, query.rows.contacts, query.rows.all, "--contacts and --all"))
        return ARGS_USAGE;
    const bool named = args.operand_count > 0 && strcmp(args.operands[0], "-") != 0;
    const int fd = named ? open(args.operands[0], O_RDONLY) : STDIN_FILENO;
    query.input = named ? args.operands[0] : "standard input";
    if (fd < 0) {
        complain("%s: %s", query.input, strerror(errno));
        return ARGS_USAGE;
    }
    query.rows.box = query.rows.box || query.html.path;
    query.rows.printer.form = query.csv ? REPORT_CSV : query.json ? REPORT_JSON : REPORT_TABLE;
    query.bus = args.bus;
    rules.other_input = named ? query.input : "/dev/stdin";
    code = output_check(&query.html) ? run_query(&query, fd) : ARGS_USAGE;
    if (named)
        close(fd);
    return code;
}
