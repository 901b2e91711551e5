/* fmb path: proves that a robot meets nothing between the rows of a table. */
#include "commands.h"

#include "allocate.h"
#include "complain.h"
#include "escape.h"
#include "json_write.h"
#include "number.h"
#include "output.h"
#include "path_proof.h"
#include "progress.h"
#include "robot_run.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: fmb path [OPTIONS] ROBOT.urdf --joints-csv FILE\n"
    "\n"
    "Proves that a robot meets nothing on its way from each row of a table to the\n"
    "next, at all times. Between rows, the value of each joint changes linearly:\n"
    "\n"
    "  fmb path robot.urdf --joints-csv path.csv --with world.json --clearance 0.005\n"
    "\n"
    "An edge is the way from one row to the next. Edges are numbered from 1: edge 1\n"
    "goes from scene 1 to scene 2 of 'fmb scene'. Verdicts of an edge:\n"
    "\n"
    "  free       all pairs are at least the clearance apart, at all times\n"
    "  near       no contact, but nearer than --clearance in the stated part\n"
    "  contact    the first contact is within the stated part of the edge\n"
    "  undecided  in the stated part, shorter than 2^-30, neither could be proven\n"
    "\n"
    "The least distance is at least 'clearance', which is proven, and at most\n"
    "'closest', the distance in a pose that was examined. Parts of an edge are\n"
    "fractions, 0 to 1. A path of one row is one pose. The proof does not cover\n"
    "blended corners and tracking errors of a controller beyond the clearance.\n"
    "\n" ROBOT_RUN_USAGE
    "\nProof:\n"
    "  --clearance D        the distance to be proven; else the margin of the world.\n"
    "                       Without both, or 0, the clearance of each edge is found\n"
    "                       to a tenth\n"
    "  --proof FILE         writes what proves the edges that are free or near, and a\n"
    "                       part of the others: 'fmb-check-path FILE' checks it\n"
    "  --check FILE         in place of --joints-csv: compares the robot, the bodies\n"
    "                       and the pairs that a proof is about with those given\n"
    "  --force              overwrites a FILE that is no proof\n"
    "\n"
    "Output:\n"
    "  --json               JSON: a line for each edge, one for the path\n" ROBOT_RUN_OUTPUT_USAGE
    "\n"
    "Bodies that have a velocity are refused.\n"
    "\n"
    "Exit codes: 0 free; 3 contact or near; 1 undecided, or --check differs;\n"
    "2 wrong usage, or a file that cannot be read or is not valid: no edge is\n"
    "printed.\n";

enum { FOUND = 3 }; /* exit code: contact or near */

static const char *const verdicts[] = {
    [FMB_ROBOT_FREE] = "free",
    [FMB_ROBOT_NEAR] = "near",
    [FMB_ROBOT_CONTACT] = "contact",
    [FMB_ROBOT_UNDECIDED] = "undecided",
};

struct path_run {
    struct robot_run run;
    const char *robot_file;
    const struct robot_run_options *options;
    bool json;
    const char *check; /* a proof to be compared; NULL: none */
    struct output_options output;
    struct output *file;     /* of the proof; NULL: none */
    struct path_proof proof; /* if there is a file */
    double clearance;        /* to be proven; 0: none */
    const double *at;        /* values of the joints at the end of the stated part of an edge */
    size_t edges, count[FMB_ROBOT_UNDECIDED + 1];
    double least; /* proven of all edges */
    char *first;  /* owned: a command that shows the first edge that is not free */
};

/* What is known of an edge besides the answer. */
struct edge {
    size_t number;
    const struct joint_row *from, *to; /* rows at its ends: the same row if the path has only one */
};

static const struct fmb_placement *body_of(const struct path_run *run, size_t i)
{
    return &run->run.scene->owner.scene.placements[i];
}

static void write_names(const struct path_run *run, size_t a, size_t b)
{
    for (int k = 0; k < 2; k++) {
        const struct fmb_placement *body = body_of(run, k == 0 ? a : b);
        fputs(k == 0 ? "" : ", ", stdout);
        if (body->name)
            escape_text(stdout, body->name);
        else
            printf("%" PRId64, body->id);
    }
}

/* ---- The command that shows a pose ---- */

/* Writes a word for a shell. */
static void write_word(FILE *out, const char *word)
{
    static const char plain[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
    putc(' ', out);
    if (*word && word[strspn(word, plain)] == '\0') {
        fputs(word, out);
        return;
    }
    putc('\'', out);
    for (; *word; word++)
        fputs(*word == '\'' ? "'\\''" : (const char[]){*word, '\0'}, out);
    putc('\'', out);
}

static void write_option(FILE *out, const char *option, const char *word)
{
    fprintf(out, " --%s", option);
    write_word(out, word);
}

static void write_command(const struct path_run *run, FILE *out)
{
    const struct robot_run_options *options = run->options;
    const struct robot *tree = &run->run.robot->tree;
    const double *base = options->robot.base;
    char number[NUMBER_TEXT_MAX], *values, word[2 * QUERY_NAME_MAX + 16];
    size_t size;
    fputs("fmb scene", out);
    write_word(out, run->robot_file);
    FILE *list = open_memstream(&values, &size);
    if (!list)
        allocate_failed();
    for (size_t j = 0; j < tree->joint_count; j++)
        if (tree->joints[j].type != ROBOT_FIXED)
            fprintf(list, "%s%s=%s",
                    ftello(list) > 0 ? "," : "--joints=", tree->joints[j].name->name,
                    number_exact(run->at[j], number));
    fclose(list);
    write_word(out, values);
    free(values);
    for (size_t i = 0; i < options->world_count; i++)
        write_option(out, "with", options->world[i]);
    for (size_t i = 0; i < options->ignored_count; i++) {
        snprintf(word, sizeof word, "%s,%s", options->ignored[i][0], options->ignored[i][1]);
        write_option(out, "ignore", word);
    }
    if (options->robot.srdf)
        write_option(out, "srdf", options->robot.srdf);
    if (options->robot.package_path)
        write_option(out, "package-path", options->robot.package_path);
    for (int i = 0; i < 6 && memcmp(base, (double[6]){0}, 6 * sizeof *base) != 0; i++)
        fprintf(out, "%s%s", i == 0 ? " --base=" : ",", number_exact(base[i], number));
    if (options->sides != ENCLOSURE_SIDES)
        fprintf(out, " --sides %ld", options->sides);
    if (options->robot.excess > 0)
        fprintf(out, " --excess %s", number_exact(options->robot.excess, number));
    fputs(options->objects ? " --objects" : "", out);
    fputs(" --limit-slack inf | fmb query --local --contacts --gap", out);
}

/* ---- Output ---- */

static void write_pair(const struct path_run *run, struct json_writer *json, size_t a, size_t b)
{
    json_integer(json, "a", body_of(run, a)->id);
    json_integer(json, "b", body_of(run, b)->id);
    json_begin(json, "names", '[');
    json_string(json, NULL, body_of(run, a)->name);
    json_string(json, NULL, body_of(run, b)->name);
    json_end(json, ']');
}

static void write_json(const struct path_run *run, const struct edge *edge,
                       const struct fmb_robot_edge *answer)
{
    const struct robot *tree = &run->run.robot->tree;
    struct json_writer json = json_object(stdout);
    json_integer(&json, "edge", (int64_t) edge->number);
    if (!isnan(edge->from->time))
        json_number(&json, "time",
                    edge->from->time + answer->at[0] * (edge->to->time - edge->from->time));
    if (edge->from->label)
        json_string(&json, "label", edge->from->label);
    json_string(&json, "verdict", verdicts[answer->verdict]);
    if (answer->verdict != FMB_ROBOT_FREE)
        json_numbers(&json, "at", answer->at, 2);
    if (answer->verdict == FMB_ROBOT_FREE || answer->verdict == FMB_ROBOT_NEAR)
        json_number(&json, "clearance", answer->clearance);
    json_number(&json, "closest", answer->closest);
    if (answer->has_pair)
        write_pair(run, &json, answer->a, answer->b);
    if (answer->verdict != FMB_ROBOT_FREE) {
        json_begin(&json, "joints", '{');
        for (size_t j = 0; j < tree->joint_count; j++)
            if (tree->joints[j].type != ROBOT_FIXED)
                json_number(&json, tree->joints[j].name->name, run->at[j]);
        json_end(&json, '}');
    }
    json_object_end(&json);
}

static void write_row(const struct path_run *run, const struct edge *edge,
                      const struct fmb_robot_edge *answer)
{
    char text[4][NUMBER_TEXT_MAX], at[2 * NUMBER_TEXT_MAX + 8];
    const bool proven = answer->verdict == FMB_ROBOT_NEAR;
    number_ends(answer->at[0], answer->at[1], text[0], text[1]);
    snprintf(at, sizeof at, strcmp(text[0], text[1]) != 0 ? "%s to %s" : "%s", text[0], text[1]);
    printf("%6zu  %-9s  %-24s  %-11s  %-11s  ", edge->number, verdicts[answer->verdict], at,
           proven ? number_short(answer->clearance, text[2]) : "-",
           number_short(answer->closest, text[3]));
    if (answer->has_pair)
        write_names(run, answer->a, answer->b);
    if (edge->from->label) {
        fputs("  from ", stdout);
        escape_text(stdout, edge->from->label);
    }
    putchar('\n');
}

static void write_edge(struct path_run *run, const struct edge *edge,
                       const struct fmb_robot_edge *answer)
{
    static const char heading[] =
        "  edge  verdict    at                        clearance    closest      pair\n";
    run->count[answer->verdict]++;
    run->least = fmin(run->least, answer->clearance);
    run->at = path_values(run->run.path, answer->at[1]);
    progress_clear();
    if (run->json) {
        write_json(run, edge, answer);
    } else if (answer->verdict != FMB_ROBOT_FREE) {
        if (!run->first) {
            size_t size;
            FILE *out = open_memstream(&run->first, &size);
            if (!out)
                allocate_failed();
            write_command(run, out);
            fclose(out);
            fputs(heading, stdout);
        }
        write_row(run, edge, answer);
    }
    if (run->file)
        path_proof_edge(&run->proof, run->run.path, edge->number, answer);
    progress_to((int64_t) edge->number, (int64_t) run->edges);
}

static const char *verdict_of(const struct path_run *run)
{
    for (int i = FMB_ROBOT_CONTACT; i >= FMB_ROBOT_NEAR; i--)
        if (run->count[i] > 0)
            return verdicts[i];
    return verdicts[run->count[FMB_ROBOT_UNDECIDED] > 0 ? FMB_ROBOT_UNDECIDED : FMB_ROBOT_FREE];
}

/* Pairs that meet and do not move relative to each other. */
static void write_touches(struct path_run *run)
{
    const struct fmb_robot_touch *touches;
    const size_t count = fmb_robot_path_touches(run->run.path, &touches);
    for (size_t i = 0; i < count; i++) {
        const struct fmb_robot_touch *touch = &touches[i];
        run->count[FMB_ROBOT_CONTACT] += touch->verdict == FMB_OVERLAPPING;
        if (run->json) {
            struct json_writer json = json_object(stdout);
            json_string(&json, "rigid", fmb_verdict_name((int) touch->verdict));
            write_pair(run, &json, touch->a, touch->b);
            json_object_end(&json);
            continue;
        }
        printf("%s, at all times, as they do not move relative to each other: ",
               fmb_verdict_name((int) touch->verdict));
        write_names(run, touch->a, touch->b);
        putchar('\n');
    }
}

static void write_end(const struct path_run *run)
{
    const bool proven = run->count[FMB_ROBOT_CONTACT] + run->count[FMB_ROBOT_UNDECIDED] == 0;
    const double lever = fmb_robot_path_lever(run->run.path);
    char text[2][NUMBER_TEXT_MAX];
    if (run->json) {
        struct json_writer json = json_object(stdout);
        json_string(&json, "path", verdict_of(run));
        json_integer(&json, "edges", (int64_t) run->edges);
        json_integer(&json, "pairs", (int64_t) fmb_robot_path_pairs(run->run.path));
        json_integer(&json, "ignored", (int64_t) run->run.path->ignored_count);
        if (proven) {
            json_number(&json, "clearance", run->least);
            json_number(&json, "joint_error", run->least / lever);
        }
        json_object_end(&json);
        return;
    }
    printf("%s: edges: %zu", verdict_of(run), run->edges);
    for (int i = FMB_ROBOT_FREE; i <= FMB_ROBOT_UNDECIDED; i++)
        if (run->count[i] > 0)
            printf(", %s: %zu", verdicts[i], run->count[i]);
    if (proven && run->least < INFINITY)
        printf(
            "; clearance %s: it covers errors of up to %s (radians or lengths) of all joints at "
            "once",
            number_short(run->least * (1 - 1e-5), text[0]),
            number_short(run->least / lever * (1 - 1e-5), text[1]));
    putchar('\n');
    if (run->first)
        printf("The first of them: %s\n", run->first);
}

/* ---- Rows ---- */

static bool set_edge(const struct path_run *run, const struct edge *edge)
{
    return path_set_edge(run->run.path, edge->from->value, edge->to->value) == 0;
}

/* Proves and writes all edges, once they have been checked. */
static bool prove_rows(struct path_run *run, struct joint_table *table)
{
    run->edges = table->row_count > 1 ? table->row_count - 1 : 1;
    struct edge edge = {.from = table->rows, .to = &table->rows[table->row_count > 1]};
    const struct edge first = edge;
    for (size_t i = 0; i < run->edges; i++, edge.from++, edge.to++)
        if (!set_edge(run, &edge)) {
            robot_run_print(joint_table_place(table, edge.to), fmb_robot_path_why(run->run.path));
            return false;
        }
    robot_run_measure(&run->run);
    robot_run_report(&run->run, table);
    progress_begin("edges");
    write_touches(run);
    if (run->file)
        path_proof_pairs(&run->proof, run->run.path);
    edge = first;
    for (size_t i = 0; i < run->edges && !ferror(stdout); i++, edge.from++, edge.to++) {
        struct fmb_robot_edge answer;
        edge.number = i + 1;
        set_edge(run, &edge);
        while (!fmb_robot_path_step(run->run.path, &answer))
            ;
        write_edge(run, &edge, &answer);
    }
    progress_end();
    return true;
}

/* Compares the robot and the world of a proof. */
static bool compare(struct path_run *run)
{
    size_t rows, line;
    const char *why = path_proof_compare(run->check, run->run.path, &rows, &line);
    if (why && line > 0)
        complain("%s: line %zu: %s", run->check, line, why);
    else if (why)
        complain("%s: %s", run->check, why);
    else
        printf(
            "%s is about this robot among these bodies, and a path of %zu rows; 'fmb-check-path "
            "%s' checks what it proves\n",
            run->check, rows, run->check);
    run->count[FMB_ROBOT_UNDECIDED] = why && line > 0;
    return !why || line > 0;
}

static bool prove_table(struct path_run *run)
{
    struct joint_table table;
    struct joints *joints = &run->run.joints;
    if (fmb_robot_path_begin(run->run.scene, run->clearance, &run->run.path) != 0) {
        robot_run_print("", fmb_robot_path_why(run->run.path));
        return false;
    }
    if (run->check)
        return compare(run);
    if (!output_open(&run->output, &run->file))
        return false;
    run->run.path->recorded = run->file != NULL;
    if (run->file && !path_proof_begin(run->file->file, &run->proof)) {
        output_complain(run->output.path, ENOMEM);
        return false;
    }
    bool good = joint_table_read(run->options->table, joints, &table) && joints_check(joints);
    if (run->file)
        path_proof_bodies(&run->proof, run->run.path);
    for (size_t i = 0; run->file && i < table.row_count; i++)
        path_proof_row(&run->proof, run->run.path, table.rows[i].value);
    good = good && prove_rows(run, &table);
    joint_table_clear(&table);
    if (run->file && !path_proof_end(&run->proof)) {
        complain("%s: the proof could not be written", run->output.path);
        good = false;
    }
    good = output_close(run->file, good) && good;
    if (good)
        write_end(run);
    return good;
}

static int prove_file(struct path_run *run)
{
    bool good = robot_run_begin(run->options, run->robot_file, &run->run);
    if (good) {
        if (run->clearance < 0)
            run->clearance = run->run.scene->owner.scene.margin;
        good = prove_table(run);
    }
    robot_run_end(&run->run);
    free(run->first);
    good = output_flush() && good;
    return !good                                                            ? ARGS_USAGE
           : run->count[FMB_ROBOT_CONTACT] + run->count[FMB_ROBOT_NEAR] > 0 ? FOUND
           : run->count[FMB_ROBOT_UNDECIDED] > 0                            ? ARGS_FAILED
                                                                            : ARGS_ANSWERED;
}

int cmd_path(int argc, char **argv)
{
    struct robot_run_options options = ROBOT_RUN_DEFAULTS;
    struct output_rules rules = {.input_count = 1};
    struct path_run run = {.options = &options,
                           .clearance = -1,
                           .least = INFINITY,
                           .output = {.kind = OUTPUT_PROOF, .rules = &rules}};
    const struct args_option own[] = {
        ROBOT_RUN_OPTIONS(options),
        {"clearance", ARGS_NUMBER, &run.clearance, .high = DBL_MAX},
        {"json", ARGS_FLAG, .out = &run.json},
        {"proof", ARGS_OTHER, &run.output.path, .take = robot_run_take_once},
        {"check", ARGS_OTHER, &run.check, .take = robot_run_take_once},
        {"force", ARGS_FLAG, .out = &rules.force},
        {.name = NULL},
    };
    struct args args = {"path",           usage, own, .operand = "ROBOT.urdf", .operands_min = 1,
                        .operands_max = 1};
    int code = robot_run_parse(&args, argc, argv, &options);
    if (code == ARGS_RUN && !options.table == !run.check) {
        args_error(&args, "expected one of --joints-csv FILE and --check FILE");
        code = ARGS_USAGE;
    }
    if (code == ARGS_RUN && !args_exclude(&args, run.check, run.output.path, "--check and --proof"))
        code = ARGS_USAGE;
    rules.input = args.operands;
    rules.other_input = options.table;
    if (code == ARGS_RUN && !output_check(&run.output))
        code = ARGS_USAGE;
    if (code == ARGS_RUN) {
        run.robot_file = args.operands[0];
        code = prove_file(&run);
    }
    free(options.world);
    free(options.ignored);
    return code;
}
