/* fmb watch: prints the results on the bus. */
#include "commands.h"

#include "args.h"
#include "complain.h"
#include "listen.h"
#include "report.h"

#include <inttypes.h>
#include <stdio.h>

static const char usage[] =
    "usage: fmb watch [OPTIONS]\n"
    "\n"
    "Prints the results on the bus, of all clients, one line each, until SIGINT or\n"
    "SIGTERM. The result of a pair names the bodies by id (0: anonymous). The result\n"
    "of a scene holds the answers of one datagram, up to the pair that the line\n"
    "names. If the query did not list its pairs, only those that touch, overlap or\n"
    "are near are counted; all others are separated.\n"
    "\n"
    "  --json               one line of JSON for each result, exact, with its\n"
    "                       certificate where it has one; of a scene with its pairs:\n"
    "                       \"placements\" are their two places in the query, or \"pair\"\n"
    "                       is their place in its list, from 0\n"
    "  --count N            end after N results\n" ARGS_COMMON_USAGE
    "\n"
    "Exit codes: 0 ended by a signal or --count, 1 no bus, or the output failed, 2\n"
    "wrong usage.\n";

struct watch {
    bool json;
    long count; /* results until the end; 0: no end */
    struct report_columns columns;
    uint64_t malformed;
    bool enough;
};

/* ---- As JSON ---- */

/* Writes the answer of a pair, whose bodies have ids. */
static void write_pair(struct json_writer *json, const struct fmb_client_result *result,
                       const struct fmb_client_answer *answer)
{
    json_integer(json, "a", result->body_id[0]);
    json_integer(json, "b", result->body_id[1]);
    if (result->status != FMB_OK)
        json_integer(json, "status", result->status);
    report_answer_json(json, result->dim, result->names_frames, answer);
}

/* Number of answers of a result. */
struct counts {
    int64_t verdict[FMB_OVERLAPPING + 1]; /* [0]: without verdict */
};

static struct counts count_answers(const struct fmb_client_result *result)
{
    struct fmb_client_cursor cursor = {0};
    struct fmb_client_answer answer;
    struct counts out = {{0}};
    while (fmb_client_next_answer(result, &cursor, &answer))
        out.verdict[answer.answer.verdict]++;
    return out;
}

/* Writes the pairs of a scene, which have positions in the query, but no ids. */
static void write_scene(struct json_writer *json, const struct fmb_client_result *result)
{
    const struct counts counts = count_answers(result);
    struct fmb_client_cursor cursor = {0};
    struct fmb_client_answer answer;
    json_integer(json, "end_pair", result->end_pair);
    json_integer(json, "overlapping", counts.verdict[FMB_OVERLAPPING]);
    json_integer(json, "touching", counts.verdict[FMB_TOUCHING]);
    json_integer(json, result->names_pairs ? "near" : "separated", counts.verdict[FMB_SEPARATED]);
    if (!result->names_pairs)
        json_integer(json, "undecided", counts.verdict[0]);
    json_begin(json, "pairs", '[');
    while (fmb_client_next_answer(result, &cursor, &answer)) {
        json_begin(json, NULL, '{');
        if (result->names_pairs)
            json_integers(json, "placements", (const int64_t[]){answer.a, answer.b}, 2);
        else
            json_integer(json, "pair", answer.a);
        report_answer_json(json, result->dim, result->names_frames, &answer);
        json_end(json, '}');
    }
    json_end(json, ']');
}

static void print_json(const struct fmb_client_result *result)
{
    struct fmb_client_cursor cursor = {0};
    struct fmb_client_answer answer;
    struct json_writer json = json_object(stdout);
    json_integer(&json, "utime", result->utime);
    json_integer(&json, "client_id", result->client_id);
    json_integer(&json, "sequence_number", result->sequence_number);
    json_integer(&json, "server_id", result->server_id);
    json_integer(&json, "compute_ns", result->compute_ns);
    if (result->is_pair && fmb_client_next_answer(result, &cursor, &answer)) {
        write_pair(&json, result, &answer);
    } else if (result->status == FMB_OK) {
        write_scene(&json, result);
    } else {
        json_integer(&json, "status", result->status);
        json_string(&json, "error", result->text);
    }
    json_object_end(&json);
}

/* ---- For people ---- */

static void print_scene(const struct fmb_client_result *result)
{
    const struct counts counts = count_answers(result);
    const int64_t separated = counts.verdict[FMB_SEPARATED];
    printf("up to pair %" PRId64 ": %" PRId64 " overlapping, %" PRId64 " touching",
           result->end_pair, counts.verdict[FMB_OVERLAPPING], counts.verdict[FMB_TOUCHING]);
    if (!result->names_pairs || separated > 0)
        printf(", %" PRId64 " %s", separated, result->names_pairs ? "near" : "separated");
    if (counts.verdict[0] > 0)
        printf(", %" PRId64 " not decided", counts.verdict[0]);
}

static void print_text(const struct fmb_client_result *result, struct report_columns *columns)
{
    struct fmb_client_cursor cursor = {0};
    struct fmb_client_answer answer;
    printf("%16" PRId64 " #%-6" PRId64 " %6.1f us  ", result->client_id, result->sequence_number,
           1e-3 * (double) result->compute_ns);
    if (result->is_pair)
        printf("%4" PRId64 " %4" PRId64 "  ", result->body_id[0], result->body_id[1]);
    if (result->status != FMB_OK)
        printf("not decided: %s", result->text);
    else if (!result->is_pair)
        print_scene(result);
    else if (fmb_client_next_answer(result, &cursor, &answer))
        report_answer_text(stdout, result->dim, &answer.answer, columns);
    putchar('\n');
}

/* ---- The command ---- */

static void on_result(void *user, const struct fmb_client_result *result)
{
    struct watch *watch = user;
    if (watch->enough)
        return;
    if (watch->json)
        print_json(result);
    else
        print_text(result, &watch->columns);
    if (fflush(stdout) != 0 || --watch->count == 0)
        watch->enough = true;
}

static void on_malformed(void *user, const char *what)
{
    struct watch *watch = user;
    (void) what;
    watch->malformed++;
}

int cmd_watch(int argc, char **argv)
{
    struct watch watch = {.columns = report_columns()};
    const struct args_option own[] = {
        {"json", ARGS_FLAG, .out = &watch.json},
        {"count", ARGS_INTEGER, &watch.count, .low = 1, .high = INT32_MAX},
        {.name = NULL},
    };
    struct args args = {"watch", usage, own, .operand = NULL};
    const struct fmb_client_watcher watcher = {
        .result = on_result, .malformed = on_malformed, .user = &watch};
    int code = args_parse(&args, argc, argv);
    if (code != ARGS_RUN)
        return code;
    const enum listen_end end = listen_until(&args.bus, &watcher, &watch.enough, -1);
    if (watch.malformed > 0)
        complain("%" PRIu64 " messages could not be read", watch.malformed);
    if (ferror(stdout))
        perror("fmb: standard output");
    return end == LISTEN_FAILED || ferror(stdout) ? ARGS_FAILED : ARGS_ANSWERED;
}
