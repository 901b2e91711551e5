/* fmb log scene: prints a query of a log as a scene that can be queried again. */
#include "commands.h"

#include "allocate.h"
#include "args.h"
#include "complain.h"
#include "definitions.h"
#include "input.h"
#include "local_answerer.h"
#include "progress.h"
#include "scene_json.h"

#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
    "  --event N            the query's event, as 'fmb replay' and 'fmb log results'\n"
    "                       print its number. Where numbers repeat, 'fmb log cut'\n"
    "                       copies the log with new ones\n"
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

struct search {
    const struct args *args;
    int64_t number; /* of the event */
    struct input input;
    struct log_channels channels;
    /* The bodies of handles, and the names of bodies, from anywhere in the logs. */
    struct definitions *definitions;
    struct body_names *names;
    int64_t count; /* events with this number in the last log */
    /* Of the first of them: */
    int64_t offset;
    enum log_kind kind;
    uint32_t size;
    unsigned char bytes[LOG_DATA_MAX];
    struct logged_query query;
};

/* ---- Reading the logs ---- */

static void take_event(struct search *search, const struct log_event *event)
{
    const enum log_kind kind = log_kind_of(&search->channels, event);
    definitions_add_message(search->definitions, search->names, kind, event->data,
                            (uint32_t) event->kept);
    if (search->input.log + 1 < search->args->operand_count || event->number != search->number ||
        search->count++ > 0)
        return;
    search->offset = event->offset;
    search->kind = kind;
    search->size = (uint32_t) event->kept;
    memcpy(search->bytes, event->data, event->kept);
}

/* Returns false after an error, which was reported. */
static bool read_logs(struct search *search)
{
    struct input *input = &search->input;
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    if (!input_open(input, search->args->operands, search->args->operand_count))
        return false;
    progress_begin("bytes");
    while ((outcome = input_next(input, &event, &damage)) < LOG_END) {
        if (outcome == LOG_EVENT)
            take_event(search, &event);
        progress_to(input->passed, input_size(input));
    }
    if (outcome == LOG_FAILED)
        complain("%s: %s", search->args->operands[input->log], strerror(errno));
    progress_end();
    return outcome == LOG_END;
}

/* ---- The query ---- */

/* Reports why there is no scene. Returns false. */
__attribute__((format(printf, 2, 3))) static bool refuse(const struct search *search,
                                                         const char *format, ...)
{
    const struct args *args = search->args;
    char why[LOG_WHY_MAX];
    va_list list;
    va_start(list, format);
    vsnprintf(why, sizeof why, format, list);
    va_end(list);
    complain("%s: event %" PRId64 "%s", args->operands[args->operand_count - 1], search->number,
             why);
    return false;
}

/* Decodes the query. Handles are replaced by their bodies. A placement without a name gets the last
 * name that the logs give its body. */
static bool read_query(struct search *search)
{
    struct logged_query *query = &search->query;
    if (search->count == 0)
        return refuse(search, ": there is none");
    if (search->count > 1)
        return refuse(search, " is there %" PRId64 " times: 'fmb log cut' numbers events anew",
                      search->count);
    if (log_kind_is_result(search->kind))
        return refuse(search, ": a result: give the number of its query");
    if (!log_kind_is_query(search->kind))
        return refuse(search, ": not a query of this service (--prefix chooses it)");
    const char *error = logged_query_read(query, search->kind, search->bytes, search->size);
    if (error)
        return refuse(search, ": %s", error);
    for (int32_t i = 0; i < query->placement_count; i++) {
        struct fmb_placement *placed = &query->placement[i].placed;
        if (!placed->name || !*placed->name)
            placed->name = body_names_find(search->names, query->header.client_id, placed->id);
    }
    const int32_t missing = definitions_fill(search->definitions, query);
    return missing < 0 ||
           refuse(search,
                  ": placement %d, body %" PRId64 ", came by a handle that no log here defines",
                  (int) missing, query->placement[missing].placed.id);
}

/* Whether the service accepts the query. A pair that its method cannot decide is accepted. */
static bool check_query(const struct search *search)
{
    if (search->size > QUERY_BYTES_MAX) {
        complain("event %" PRId64 ": the service refuses it: longer than %d bytes", search->number,
                 QUERY_BYTES_MAX);
        return false;
    }
    struct local_answerer *answerer = local_answerer_open(FMB_FRAMES_MAX, search->definitions);
    struct new_result result;
    local_answer(answerer, search->kind, search->bytes, search->size, &result);
    const bool accepted = result.status == FMB_OK ||
                          (search->kind == LOG_PAIR_QUERY && result.status == FMB_CANNOT_DECIDE);
    if (!accepted) {
        struct logged_result *refused = allocate(1, sizeof *refused);
        logged_result_read(refused, search->kind, result.bytes, (uint32_t) result.size);
        complain("event %" PRId64 ": the service refuses it: %s", search->number,
                 refused->head.detail);
        free(refused);
    }
    local_answerer_close(answerer);
    return accepted;
}

/* ---- Reports on stderr ---- */

static void report_ids(const struct logged_query *query, const struct fmb_placement *printed)
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

static void report_command(const struct search *search)
{
    const struct logged_query *query = &search->query;
    const bool is_pair = query->kind == LOG_PAIR_QUERY;
    const int32_t method = is_pair ? query->pair.method : query->scene.method;
    const int32_t want = is_pair ? query->pair.want : query->scene.want;
    fprintf(stderr,
            "fmb: event %" PRId64 " (offset %" PRId64 "), client %" PRId64
            ", sequence number %" PRId64 "; to repeat it: fmb query --local --json",
            search->number, search->offset, query->header.client_id, query->header.sequence_number);
    if (method != 0)
        fprintf(stderr, " --method %s", fmb_method_by_number(method)->name);
    fprintf(stderr, "%s%s%s%s\n", want & FMB_WANT_BOX ? " --box" : "",
            want & FMB_WANT_POINT ? " --point" : "", want & FMB_WANT_GAP ? " --gap" : "",
            is_pair && want & FMB_WANT_CERTIFICATE ? " --certificate" : "");
}

/* ---- The command ---- */

static int print_scene(const struct search *search)
{
    struct owned_scene scene;
    scene_of_query(&search->query, &scene);
    scene_json_write(stdout, &scene);
    report_ids(&search->query, scene.scene.placements);
    report_command(search);
    scene_clear(&scene);
    return output_flush() ? ARGS_ANSWERED : ARGS_USAGE;
}

static int run_scene(const struct args *args, int64_t event)
{
    struct search *search = allocate(1, sizeof *search);
    int code = ARGS_USAGE;
    search->args = args;
    search->number = event;
    search->channels = log_channels(args->bus.prefix);
    search->definitions = definitions_open();
    search->names = body_names_open();
    if (read_logs(search))
        code = read_query(search) && check_query(search) ? print_scene(search) : ARGS_FAILED;
    input_close(&search->input);
    definitions_close(search->definitions);
    body_names_close(search->names);
    free(search);
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
    if (event == not_given && !args_error(&args, "expected --event N"))
        return ARGS_USAGE;
    return run_scene(&args, event);
}
