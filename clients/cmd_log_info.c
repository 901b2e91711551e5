/* fmb log info: prints the contents of event logs. */
#include "commands.h"

#include "args.h"
#include "complain.h"
#include "log_info.h"
#include "progress.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>

static const char usage[] =
    "usage: fmb log info [OPTIONS] LOG...\n"
    "\n"
    "Reads event logs and prints for each: its size, the time it covers, its channels\n"
    "with their message types, counts and sizes, the last name of each body that has\n"
    "one, and each place that is damaged. A type that does not belong to the service\n"
    "is printed as the fingerprint of its messages.\n"
    "\n"
    "  --json               one line of JSON for each log, with all times in\n"
    "                       microseconds\n"
    "  -h, --help\n"
    "\n"
    "Exit codes: 0 all logs are intact; 1 one is damaged, and what could be read is\n"
    "printed; 2 wrong usage, or a file that cannot be read or is not a log.\n";

/* Reads a log. Returns NULL, or why it could not be read to its end. */
static const char *read_all(struct log_reader *reader, struct log_info *info)
{
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    progress_begin("bytes");
    while ((outcome = log_next(reader, &event, &damage)) < LOG_END) {
        if (outcome == LOG_EVENT)
            log_info_event(info, &event);
        else
            log_info_damage(info, &damage);
        progress_to(outcome == LOG_EVENT ? event.offset : damage.offset, log_size(reader));
    }
    const int error = errno;
    progress_end();
    log_info_end(info);
    if (outcome == LOG_END)
        return NULL;
    return error == ENODATA ? "it has become shorter" : strerror(error);
}

static int complain_of(const char *path, const char *why)
{
    fflush(stdout);
    complain("%s: %s", path, why);
    return ARGS_USAGE;
}

static int report_log(bool json, const char *path, struct log_reader *reader, struct log_info *info)
{
    struct log_report report = {.path = path, .size = log_size(reader), .info = info};
    report.error = read_all(reader, info);
    if (!report.error && info->all.events == 0 && report.size > 0)
        return complain_of(path, "no event log: there is no event in it");
    if (json)
        log_report_json(stdout, &report);
    else
        log_report_text(stdout, &report);
    if (report.error)
        return complain_of(path, report.error);
    return info->damages > 0 ? ARGS_FAILED : ARGS_ANSWERED;
}

static int open_and_report(bool json, const char *path)
{
    char why[LOG_WHY_MAX];
    struct log_reader *reader = log_open(path, why);
    if (!reader)
        return complain_of(path, why);
    struct log_info *info = log_info_open();
    const int code = report_log(json, path, reader, info);
    log_info_close(info);
    log_close(reader);
    return code;
}

int cmd_log_info(int argc, char **argv)
{
    bool json = false;
    const struct args_option own[] = {{"json", ARGS_FLAG, .out = &json}, {.name = NULL}};
    struct args args = {
        "log info", usage, own, .operand = "LOG", .operands_min = 1, .operands_max = INT_MAX};
    int code = args_parse(&args, argc, argv);
    if (code != ARGS_RUN)
        return code;
    code = ARGS_ANSWERED;
    for (int i = 0; i < args.operand_count; i++) {
        if (i > 0 && !json)
            putchar('\n');
        const int one = open_and_report(json, args.operands[i]);
        code = one > code ? one : code;
    }
    return output_flush() || code != ARGS_ANSWERED ? code : ARGS_FAILED;
}
