/* fmb log scene: prints a query of a log as a scene that can be queried again. */
#include "commands.h"

#include "allocate.h"
#include "args.h"
#include "complain.h"
#include "local_answerer.h"
#include "log_query.h"
#include "progress.h"
#include "scene_json.h"
#include "logged_query.h"

#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>

static const char usage[] =
    "usage: fmb log scene [OPTIONS] LOG...\n"
    "\n"
    "Prints one query of an LCM event log as a scene, exactly, as 'fmb query --local'\n"
    "takes it:\n"
    "\n"
    "  fmb log scene LOG --event 17 | fmb query --local --json --box\n"
    "\n"
    "Of several logs the last one contains the query, and the others are read for\n"
    "definitions of bodies. Bodies that came by handle get their frames back.\n"
    "\n"
    "  --event N            the event with this number, as 'fmb replay' prints it: a\n"
    "                       query, or the result of one. Where numbers repeat, 'fmb\n"
    "                       log cut' copies the log with new ones\n"
    "  -p, --prefix P       the service's channels begin with P\n"
    "  -h, --help\n"
    "\n"
    "A query of all pairs prints no list of pairs; one of some bodies against the\n"
    "others lists them; one with first_pair lists the pairs from there on. Bodies\n"
    "keep their ids. Anonymous bodies, and those whose id is used by an earlier one,\n"
    "get free ids, which are reported on standard error, with the command that\n"
    "repeats the query by its method and wants.\n"
    "\n"
    "Exit codes: 0 printed; 1 there is no such query, the service refuses it, or a\n"
    "handle is not defined; 2 wrong usage, or a log cannot be read.\n";

/* The value of an option that is not given. */
static const long not_given = LONG_MIN;

/* Reports the detail of the result of a query that the service refuses. */
static void report_refusal(const struct log_query *query, const struct new_result *refused)
{
    struct logged_result *result = allocate(1, sizeof *result);
    logged_result_read(result, query->query.kind, refused->bytes, (uint32_t) refused->size);
    complain("event %" PRId64 ": the service refuses it: %s", query->number, result->head.detail);
    free(result);
}

/* Whether the service accepts the query. A pair that its method cannot decide is accepted. */
static bool check_query(const struct log_query *query)
{
    if (query->size > QUERY_BYTES_MAX) {
        complain("event %" PRId64 ": the service refuses it: longer than %d bytes", query->number,
                 QUERY_BYTES_MAX);
        return false;
    }
    struct local_answerer *answerer = local_answerer_open(FMB_FRAMES_MAX, query->definitions);
    struct new_result result;
    local_answer(answerer, query->query.kind, query->bytes, (uint32_t) query->size, &result);
    const bool accepted = result.status == FMB_OK || (query->query.kind == LOG_PAIR_QUERY &&
                                                      result.status == FMB_CANNOT_DECIDE);
    if (!accepted)
        report_refusal(query, &result);
    local_answerer_close(answerer);
    return accepted;
}

/* ---- Reports on stderr ---- */

static void report_ids(struct logged_query *query, const struct fmb_placement *printed)
{
    const struct query_placement *placement = query->placement;
    for (int32_t i = 0; i < query->placement_count; i++) {
        if (placement[i].placed.id == printed[i].id)
            continue;
        if (placement[i].placed.id == 0)
            complain("placement %d, which has no id, is body %" PRId64 "", (int) i, printed[i].id);
        else
            complain("placement %d, one more of body %" PRId64 ", is body %" PRId64 "", (int) i,
                     placement[i].placed.id, printed[i].id);
    }
}

static void report_command(const struct log_query *query)
{
    const struct logged_query *any = &query->query;
    const bool is_pair = any->kind == LOG_PAIR_QUERY;
    const int32_t method = is_pair ? any->pair.method : any->scene.method;
    const int32_t want = is_pair ? any->pair.want : any->scene.want;
    fprintf(stderr,
            "fmb: event %" PRId64 " (offset %" PRId64 "), client %" PRId64
            ", sequence number %" PRId64 "; to repeat it: fmb query --local --json",
            query->number, query->offset, query->key.client_id, query->key.sequence_number);
    if (method != 0)
        fprintf(stderr, " --method %s", fmb_method_by_number(method)->name);
    fprintf(stderr, "%s%s%s%s\n", want & FMB_WANT_BOX ? " --box" : "",
            want & FMB_WANT_POINT ? " --point" : "", want & FMB_WANT_GAP ? " --gap" : "",
            is_pair && want & FMB_WANT_CERTIFICATE ? " --certificate" : "");
}

/* ---- The command ---- */

static int print_scene(struct log_query *query)
{
    struct owned_scene scene;
    scene_of_query(&query->query, &scene);
    scene_json_write(stdout, &scene);
    report_ids(&query->query, scene.scene.placements);
    report_command(query);
    scene_clear(&scene);
    return output_flush() ? ARGS_ANSWERED : ARGS_USAGE;
}

static int run_scene(const struct log_query_options *options)
{
    static const int code_of[] = {[LOG_QUERY_FOUND] = ARGS_ANSWERED,
                                  [LOG_QUERY_NONE] = ARGS_FAILED,
                                  [LOG_QUERY_FAILED] = ARGS_USAGE};
    struct log_query *query = allocate(1, sizeof *query);
    progress_begin("bytes");
    const enum log_query_outcome outcome = log_query(options, query);
    progress_end();
    int code = code_of[outcome];
    if (outcome == LOG_QUERY_FOUND)
        code = check_query(query) ? print_scene(query) : ARGS_FAILED;
    log_query_clear(query);
    free(query);
    return code;
}

int cmd_log_scene(int argc, char **argv)
{
    long event = not_given;
    const struct args_option own[] = {
        {"event", ARGS_INTEGER, &event, .low = LONG_MIN, .high = 0x1p63 - 1024},
        {.name = NULL},
    };
    struct args args = {"log scene",         usage, own, .operand = "LOG", .operands_min = 1,
                        .operands_max = 4096};
    const int code = args_parse(&args, argc, argv);
    if (code != ARGS_RUN)
        return code;
    if (event == not_given) {
        args_error(&args, "expected --event N");
        return ARGS_USAGE;
    }
    return run_scene(&(struct log_query_options){.log = args.operands,
                                                 .log_count = args.operand_count,
                                                 .prefix = args.bus.prefix,
                                                 .event = event});
}
