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

/* ---- Results of pairs ---- */

/* Writes the members that results of pairs and of scenes have in common. */
static struct json_writer begin_json(int64_t utime, int64_t client_id, int64_t sequence_number,
                                     int64_t server_id, int64_t compute_ns)
{
    struct json_writer json = json_object(stdout);
    json_integer(&json, "utime", utime);
    json_integer(&json, "client_id", client_id);
    json_integer(&json, "sequence_number", sequence_number);
    json_integer(&json, "server_id", server_id);
    json_integer(&json, "compute_ns", compute_ns);
    return json;
}

static void print_pair_json(const struct fmb_client_pair_result *result)
{
    const struct fmb_client_answer answer = {.status = result->status,
                                             .text = result->text,
                                             .answer = result->answer,
                                             .certificate = result->certificate};
    struct json_writer json = begin_json(result->utime, result->client_id, result->sequence_number,
                                         result->server_id, result->compute_ns);
    json_integer(&json, "a", result->body_id[0]);
    json_integer(&json, "b", result->body_id[1]);
    if (result->status != FMB_OK)
        json_integer(&json, "status", result->status);
    report_answer_json(&json, result->dim, result->names_frames, &answer);
    json_object_end(&json);
}

/* Prints the start of a line. */
static void print_start(int64_t client_id, int64_t sequence_number, int64_t compute_ns)
{
    printf("%16" PRId64 " #%-6" PRId64 " %6.1f us  ", client_id, sequence_number,
           1e-3 * (double) compute_ns);
}

static void print_pair_text(const struct fmb_client_pair_result *result,
                            struct report_columns *columns)
{
    print_start(result->client_id, result->sequence_number, result->compute_ns);
    printf("%4" PRId64 " %4" PRId64 "  ", result->body_id[0], result->body_id[1]);
    if (result->status == FMB_OK)
        report_answer_text(stdout, result->dim, &result->answer, columns);
    else
        printf("not decided: %s", result->text);
    putchar('\n');
}

/* ---- Results of scenes ---- */

/* Writes the pairs of a result. It has their positions in the query, but no ids. */
static void write_scene_pairs(struct json_writer *json,
                              const struct fmb_client_scene_result *result)
{
    struct fmb_client_cursor cursor = {0};
    struct fmb_client_answer answer;
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

static void print_scene_json(const struct fmb_client_scene_result *result)
{
    struct json_writer json = begin_json(result->utime, result->client_id, result->sequence_number,
                                         result->server_id, result->compute_ns);
    if (result->status != FMB_OK) {
        json_integer(&json, "status", result->status);
        json_string(&json, "error", result->text);
        json_object_end(&json);
        return;
    }
    json_integer(&json, "end_pair", result->end_pair);
    json_integer(&json, "overlapping", result->overlapping);
    json_integer(&json, "touching", result->touching);
    if (result->names_pairs) {
        json_integer(&json, "near", result->separated);
    } else {
        json_integer(&json, "separated", result->separated);
        json_integer(&json, "undecided", result->undecided);
    }
    write_scene_pairs(&json, result);
    json_object_end(&json);
}

static void print_scene_text(const struct fmb_client_scene_result *result)
{
    print_start(result->client_id, result->sequence_number, result->compute_ns);
    if (result->status != FMB_OK) {
        printf("not decided: %s\n", result->text);
        return;
    }
    printf("up to pair %" PRId64 ": %" PRId64 " overlapping, %" PRId64 " touching",
           result->end_pair, result->overlapping, result->touching);
    if (!result->names_pairs || result->separated > 0)
        printf(", %" PRId64 " %s", result->separated, result->names_pairs ? "near" : "separated");
    if (result->undecided > 0)
        printf(", %" PRId64 " not decided", result->undecided);
    putchar('\n');
}

/* ---- The command ---- */

static void count(struct watch *watch)
{
    if (fflush(stdout) != 0 || --watch->count == 0)
        watch->enough = true;
}

static void on_pair(void *user, const struct fmb_client_pair_result *result)
{
    struct watch *watch = user;
    if (watch->enough)
        return;
    if (watch->json)
        print_pair_json(result);
    else
        print_pair_text(result, &watch->columns);
    count(watch);
}

static void on_scene(void *user, const struct fmb_client_scene_result *result)
{
    struct watch *watch = user;
    if (watch->enough)
        return;
    if (watch->json)
        print_scene_json(result);
    else
        print_scene_text(result);
    count(watch);
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
        .pair = on_pair, .scene = on_scene, .malformed = on_malformed, .user = &watch};
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
