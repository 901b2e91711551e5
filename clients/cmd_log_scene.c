/* fmb log scene: a query of a log, as a scene to ask again. */
#include "commands.h"

#include "answer.h"
#include "allocate.h"
#include "args.h"
#include "log_query.h"
#include "output.h"
#include "progress.h"
#include "scene_json.h"
#include "scene_of_query.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

static const char usage[] =
    "usage: fmb log scene [OPTIONS] LOG...\n"
    "\n"
    "Prints one query of an LCM event log as a scene, exactly, as 'fmb query --local' takes it:\n"
    "\n"
    "  fmb log scene LOG --event 17 | fmb query --local --json --box\n"
    "\n"
    "Of several logs the last one has the query, and those before it are read for the keys that\n"
    "they tell. Frames that came by key get their components back.\n"
    "\n"
    "  --event N            the event of this number, as 'fmb replay' names it: a query, or a\n"
    "                       result, which stands for its query\n"
    "  --offset BYTES       the event that begins there in the file: where numbers repeat\n"
    "  --client C, --sequence S  the query with these ids\n"
    "  -p, --prefix P       the service's channels begin with P\n"
    "  -h, --help\n"
    "\n"
    "All pairs of a scene stay all; those that were asked of some against others are listed; what\n"
    "begins with first_pair, from there on. Bodies keep their ids; anonymous ones, and those "
    "whose\n"
    "id stands before them, get free ones, which standard error tells. So it does the method and\n"
    "the wants, as the command to ask with.\n"
    "\n"
    "Exit codes: 0 printed, 1 there is no such query, the service refuses it, or a key is not\n"
    "told, 2 wrong usage, or a log cannot be read.\n";

struct options {
    struct log_query_options query;
    bool has_event, has_offset, has_client, has_sequence;
};

enum { EVENT = 1, OFFSET, CLIENT, SEQUENCE };

static const struct option own_options[] = {
    {"event", required_argument, NULL, EVENT},
    {"offset", required_argument, NULL, OFFSET},
    {"client", required_argument, NULL, CLIENT},
    {"sequence", required_argument, NULL, SEQUENCE},
    {NULL, 0, NULL, 0},
};

static bool take_number(const struct args *args, int64_t low, int64_t *out, bool *has)
{
    long number;
    if (!args_integer(args, low, INT64_MAX, &number))
        return false;
    *out = number;
    *has = true;
    return true;
}

static bool take_option(const struct args *args, int option, void *out)
{
    struct options *options = out;
    struct log_query_options *query = &options->query;
    switch (option) {
    case EVENT: return take_number(args, INT64_MIN, &query->number, &options->has_event);
    case OFFSET: return take_number(args, 0, &query->offset, &options->has_offset);
    case CLIENT: return take_number(args, INT64_MIN, &query->client_id, &options->has_client);
    case SEQUENCE:
        return take_number(args, INT64_MIN, &query->sequence_number, &options->has_sequence);
    }
    return true;
}

static bool check_options(const struct args *args, struct options *options)
{
    const bool ids = options->has_client || options->has_sequence;
    if (args->operand_count == 0)
        return args_error(args, "expected a LOG");
    if (options->has_client != options->has_sequence)
        return args_error(args, "--client goes with --sequence");
    if (options->has_event + options->has_offset + ids != 1)
        return args_error(args, "which one? --event, --offset, or --client with --sequence");
    options->query.by = options->has_event    ? LOG_QUERY_NUMBER
                        : options->has_offset ? LOG_QUERY_OFFSET
                                              : LOG_QUERY_IDS;
    return true;
}

/* ---- Whether the service takes it ---- */

/* The first pairs show that. */
static bool not_more(void *user)
{
    (void) user;
    return false;
}

/* What the service says to it, without the detail of a pair that its method cannot decide: that is
 * no fault of the query. */
static bool is_taken(struct answerer *answerer, const struct any_query *query,
                     char detail[QUERY_TEXT_MAX])
{
    union {
        struct pair_result pair;
        struct scene_result scene;
    } *result = allocate(1, sizeof *result);
    bool taken;
    if (query->kind == LOG_PAIR_QUERY) {
        answer_pair(answerer, &query->pair, &result->pair);
        taken = result->pair.status == FMB_OK || result->pair.status == FMB_CANNOT_DECIDE;
        snprintf(detail, QUERY_TEXT_MAX, "%s", result->pair.detail);
    } else {
        answer_scene(answerer, &query->scene, &result->scene);
        taken = result->scene.status == FMB_OK;
        snprintf(detail, QUERY_TEXT_MAX, "%s", result->scene.detail);
    }
    free(result);
    return taken;
}

static bool check_query(const struct log_query *query)
{
    struct answerer *answerer = allocate(1, sizeof *answerer);
    char detail[QUERY_TEXT_MAX];
    answerer->between = not_more;
    answerer->cache = cache_create(2, 1);
    if (!answerer->cache || !answer_prepare(answerer))
        allocate_failed();
    bool taken = query->size <= QUERY_BYTES_MAX;
    if (taken)
        taken = is_taken(answerer, &query->query, detail);
    else
        snprintf(detail, sizeof detail, "longer than %d bytes", QUERY_BYTES_MAX);
    if (!taken)
        fprintf(stderr, "fmb: event %" PRId64 ": the service refuses it: %s\n", query->place.number,
                detail);
    cache_destroy(answerer->cache);
    answer_release(answerer);
    free(answerer);
    return taken;
}

/* ---- What is said beside the scene ---- */

static void tell_ids(struct any_query *query, const struct scene *scene)
{
    int32_t count;
    const struct query_frame *frame = any_query_frames(query, &count);
    for (int32_t i = 0; i < count; i++) {
        if (frame[i].body_id == scene->body[i].id)
            continue;
        if (frame[i].body_id == 0)
            fprintf(stderr, "fmb: frame %d, which has no id, is body %" PRId64 "\n", (int) i,
                    scene->body[i].id);
        else
            fprintf(stderr, "fmb: frame %d, one more of body %" PRId64 ", is body %" PRId64 "\n",
                    (int) i, frame[i].body_id, scene->body[i].id);
    }
}

static void tell_command(const struct log_query *query)
{
    const struct any_query *any = &query->query;
    const bool is_pair = any->kind == LOG_PAIR_QUERY;
    const int32_t method = is_pair ? any->pair.method : any->scene.method;
    const int32_t want = is_pair ? any->pair.want : any->scene.want;
    fprintf(stderr,
            "fmb: event %" PRId64 " (offset %" PRId64 "), client %" PRId64
            ", sequence number %" PRId64 "; to ask it again: fmb query --local --json",
            query->place.number, query->place.offset, query->ids.client_id,
            query->ids.sequence_number);
    if (method != 0)
        fprintf(stderr, " --method %s", fmb_method_by_number(method)->name);
    fprintf(stderr, "%s%s\n", want & QUERY_WANT_BOX ? " --box" : "",
            is_pair && want & QUERY_WANT_CERTIFICATE ? " --certificate" : "");
}

/* ---- The run ---- */

static void on_progress(void *user, int64_t bytes, int64_t of)
{
    struct progress *progress = user;
    progress->total = (uint64_t) of;
    progress_to(progress, (uint64_t) bytes);
}

static int print_scene(struct log_query *query)
{
    struct scene scene;
    scene_of_query(&query->query, &scene);
    scene_json_write(stdout, &scene);
    tell_ids(&query->query, &scene);
    tell_command(query);
    scene_clear(&scene);
    return output_flush() ? ARGS_ANSWERED : ARGS_USAGE;
}

static int run_scene(struct options *options)
{
    static const int code_of[] = {[LOG_QUERY_FOUND] = ARGS_ANSWERED,
                                  [LOG_QUERY_NONE] = ARGS_FAILED,
                                  [LOG_QUERY_FAILED] = ARGS_USAGE};
    struct log_query *query = allocate(1, sizeof *query);
    struct progress progress = progress_begin_bytes(0);
    options->query.progress = on_progress;
    options->query.user = &progress;
    const enum log_query_outcome outcome = log_query(&options->query, query);
    progress_end(&progress);
    int code = code_of[outcome];
    if (outcome == LOG_QUERY_FOUND)
        code = check_query(query) ? print_scene(query) : ARGS_FAILED;
    free(query);
    return code;
}

int cmd_log_scene(int argc, char **argv)
{
    struct args args = {"log scene",         usage, own_options, take_option, .operand = "LOG",
                        .operands_max = 4096};
    struct options options = {.query = {.log = NULL}};
    const int code = args_parse(&args, argc, argv, &options);
    if (code != ARGS_RUN)
        return code;
    if (!check_options(&args, &options))
        return ARGS_USAGE;
    options.query.log = args.operands;
    options.query.log_count = args.operand_count;
    options.query.prefix = args.bus.prefix;
    return run_scene(&options);
}
