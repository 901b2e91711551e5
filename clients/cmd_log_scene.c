/* fmb log scene: prints a query of a log as a scene that can be queried again. */
#include "commands.h"

#include "allocate.h"
#include "answer.h"
#include "args.h"
#include "complain.h"
#include "log_query.h"
#include "progress.h"
#include "scene_json.h"
#include "logged_query.h"

#include <inttypes.h>
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
    "                       query, or the result of one\n"
    "  --offset BYTES       the event at this offset in the file, where numbers\n"
    "                       repeat\n"
    "  --client C, --sequence S  the query with these ids\n"
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

struct log_scene_options {
    struct log_query_options query;
    bool has_event, has_offset, has_client, has_sequence;
};

struct number {
    int64_t *value;
    bool *given;
    int64_t low;
};

static bool take_number(const struct args *args, void *out)
{
    const struct number *number = out;
    long value;
    if (!args_integer(args, number->low, INT64_MAX, &value))
        return false;
    *number->value = value;
    *number->given = true;
    return true;
}

static bool check_options(const struct args *args, struct log_scene_options *options)
{
    const bool ids = options->has_client || options->has_sequence;
    if (options->has_client != options->has_sequence)
        return args_error(args, "--client goes with --sequence");
    if (options->has_event + options->has_offset + ids != 1)
        return args_error(args, "expected --event, --offset, or --client with --sequence");
    options->query.by = options->has_event    ? LOG_QUERY_NUMBER
                        : options->has_offset ? LOG_QUERY_OFFSET
                                              : LOG_QUERY_IDS;
    return true;
}

/* ---- Whether the service accepts the query ---- */

/* Adds the bodies that the query names by handle to the cache, as far as the service accepts them.
 */
static void keep_bodies(struct answerer *answerer, struct logged_query *query)
{
    int32_t count;
    const struct placement *placement = logged_query_placements(query, &count);
    struct cache *cache = answerer_cache(answerer);
    struct handle handle;
    for (int32_t i = 0; i < count; i++) {
        if (!placement_by_handle(&placement[i]) || !scene_takes(&placement[i].geometry))
            continue;
        const struct cached *kept = cache_intern(cache, 0, &placement[i].geometry, &handle);
        if (kept)
            cache_release(cache, kept);
    }
}

/* A query is accepted even if its method cannot decide the pair. */
static bool accepts_pair(struct answerer *answerer, const struct log_query *query,
                         char detail[QUERY_TEXT_MAX])
{
    struct answer_job *job = answer_job_create();
    if (!job)
        allocate_failed();
    answer_job_begin(job, ANSWER_PAIR, query->bytes, query->size);
    while (!answer_job_step(job, answerer))
        continue;
    const struct pair_result *result = answer_job_pair_result(job);
    snprintf(detail, QUERY_TEXT_MAX, "%s", result->detail);
    const bool accepted = result->status == FMB_OK || result->status == FMB_CANNOT_DECIDE;
    answer_job_destroy(job);
    return accepted;
}

/* The query is accepted if its first pairs are answered. */
static bool accepts_scene(struct answerer *answerer, const struct log_query *query,
                          char detail[QUERY_TEXT_MAX])
{
    struct answer_job *job = answer_job_create();
    if (!job)
        allocate_failed();
    bool accepted = answer_job_begin(job, ANSWER_SCENE, query->bytes, query->size) == NULL;
    while (accepted && !answer_job_has_answers(job) && !answer_job_step(job, answerer))
        continue;
    if (accepted && !answer_job_has_answers(job)) {
        const struct scene_result *result = answer_job_scene_result(job);
        accepted = result->status == FMB_OK;
        snprintf(detail, QUERY_TEXT_MAX, "%s", result->detail);
    }
    answer_job_destroy(job);
    return accepted;
}

static bool is_accepted(struct log_query *query, char detail[QUERY_TEXT_MAX])
{
    const struct answerer_options options = {.frames = FMB_FRAMES_MAX, .secret = {1, 1}};
    struct answerer *answerer = answerer_create(&options);
    if (!answerer)
        allocate_failed();
    struct logged_query *any = &query->query;
    keep_bodies(answerer, any);
    const bool accepted = any->kind == LOG_PAIR_QUERY ? accepts_pair(answerer, query, detail)
                                                      : accepts_scene(answerer, query, detail);
    answerer_destroy(answerer);
    return accepted;
}

static bool check_query(struct log_query *query)
{
    char detail[QUERY_TEXT_MAX] = "";
    if (query->size > QUERY_BYTES_MAX)
        snprintf(detail, sizeof detail, "longer than %d bytes", QUERY_BYTES_MAX);
    else if (is_accepted(query, detail))
        return true;
    complain("event %" PRId64 ": the service refuses it: %s", query->number, detail);
    return false;
}

/* ---- Reports on stderr ---- */

static void report_ids(struct logged_query *query, const struct scene *scene)
{
    int32_t count;
    const struct placement *placement = logged_query_placements(query, &count);
    for (int32_t i = 0; i < count; i++) {
        if (placement[i].body_id == scene->body[i].id)
            continue;
        if (placement[i].body_id == 0)
            complain("placement %d, which has no id, is body %" PRId64 "", (int) i,
                     scene->body[i].id);
        else
            complain("placement %d, one more of body %" PRId64 ", is body %" PRId64 "", (int) i,
                     placement[i].body_id, scene->body[i].id);
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
            query->number, query->offset, query->ids.client_id, query->ids.sequence_number);
    if (method != 0)
        fprintf(stderr, " --method %s", fmb_method_by_number(method)->name);
    fprintf(stderr, "%s%s%s\n", want & FMB_WANT_BOX ? " --box" : "",
            want & FMB_WANT_GAP ? " --gap" : "",
            is_pair && want & FMB_WANT_CERTIFICATE ? " --certificate" : "");
}

/* ---- The command ---- */

static int print_scene(struct log_query *query)
{
    struct scene scene;
    scene_of_query(&query->query, &scene);
    scene_json_write(stdout, &scene);
    report_ids(&query->query, &scene);
    report_command(query);
    scene_clear(&scene);
    return output_flush() ? ARGS_ANSWERED : ARGS_USAGE;
}

static int run_scene(struct log_scene_options *options)
{
    static const int code_of[] = {[LOG_QUERY_FOUND] = ARGS_ANSWERED,
                                  [LOG_QUERY_NONE] = ARGS_FAILED,
                                  [LOG_QUERY_FAILED] = ARGS_USAGE};
    struct log_query *query = allocate(1, sizeof *query);
    struct progress progress = progress_begin("bytes", 0);
    options->query.progress = progress_to;
    options->query.user = &progress;
    const enum log_query_outcome outcome = log_query(&options->query, query);
    progress_end(&progress);
    int code = code_of[outcome];
    if (outcome == LOG_QUERY_FOUND)
        code = check_query(query) ? print_scene(query) : ARGS_FAILED;
    log_query_clear(query);
    free(query);
    return code;
}

int cmd_log_scene(int argc, char **argv)
{
    struct log_scene_options options = {.query = {.log = NULL}};
    struct log_query_options *query = &options.query;
    struct number event = {&query->number, &options.has_event, INT64_MIN};
    struct number offset = {&query->offset, &options.has_offset, 0};
    struct number client = {&query->client_id, &options.has_client, INT64_MIN};
    struct number sequence = {&query->sequence_number, &options.has_sequence, INT64_MIN};
    const struct args_option own[] = {
        {"event", ARGS_OTHER, &event, .take = take_number},
        {"offset", ARGS_OTHER, &offset, .take = take_number},
        {"client", ARGS_OTHER, &client, .take = take_number},
        {"sequence", ARGS_OTHER, &sequence, .take = take_number},
        {.name = NULL},
    };
    struct args args = {"log scene",         usage, own, .operand = "LOG", .operands_min = 1,
                        .operands_max = 4096};
    const int code = args_parse(&args, argc, argv);
    if (code != ARGS_RUN)
        return code;
    if (!check_options(&args, &options))
        return ARGS_USAGE;
    options.query.log = args.operands;
    options.query.log_count = args.operand_count;
    options.query.prefix = args.bus.prefix;
    return run_scene(&options);
}
