/* Describes an event log: describe-log FILE prints a line of JSON for each event, read with
 * liblcm's own reader, and results by lcm-gen's own decoders; this program has no code of the
 * service or its clients. Only for trusted logs: other ones may crash liblcm. Exit code 1: the log
 * cannot be opened, or the last event does not end with the file. */
#include "fmb_msgs_pair_result_t.h"
#include "fmb_msgs_scene_result_t.h"

#include <inttypes.h>
#include <lcm/lcm.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static bool ends_with(const char *text, const char *end)
{
    const size_t length = strlen(text), tail = strlen(end);
    return length >= tail && strcmp(text + length - tail, end) == 0;
}

static void describe_pair_result(const lcm_eventlog_event_t *event)
{
    fmb_msgs_pair_result_t result;
    if (fmb_msgs_pair_result_t_decode(event->data, 0, event->datalen, &result) != event->datalen)
        return;
    printf(", \"client\": %" PRId64 ", \"number\": %" PRId64 ", \"server\": %" PRId64,
           result.client_id, result.sequence_number, result.server_id);
    printf(", \"status\": %d, \"method\": %d, \"verdicts\": [%d]", (int) result.status,
           (int) result.method, (int) result.verdict);
    printf(
        ", \"times\": %d, \"boxes\": %d, \"gaps\": %d, \"witnesses\": %d, \"points\": %d, "
        "\"certificate\": %zu",
        (int) result.num_contact, (int) result.num_box, (int) result.num_gap,
        (int) result.num_witness, (int) result.num_point, strlen(result.certificate));
    fmb_msgs_pair_result_t_decode_cleanup(&result);
}

static void describe_scene_result(const lcm_eventlog_event_t *event)
{
    fmb_msgs_scene_result_t result;
    if (fmb_msgs_scene_result_t_decode(event->data, 0, event->datalen, &result) != event->datalen)
        return;
    printf(", \"client\": %" PRId64 ", \"number\": %" PRId64 ", \"server\": %" PRId64,
           result.client_id, result.sequence_number, result.server_id);
    printf(", \"status\": %d, \"method\": %d, \"end\": %d, \"verdicts\": [", (int) result.status,
           (int) result.method, (int) result.end_pair);
    for (int32_t i = 0; i < result.num_verdicts; i++)
        printf("%s%d", i ? "," : "", (int) result.verdicts[i]);
    printf("], \"pairs\": %d, \"times\": %d, \"boxes\": %d, \"gaps\": %d",
           (int) result.num_indices / 2, (int) result.num_times, (int) result.num_boxes,
           (int) result.num_gaps);
    fmb_msgs_scene_result_t_decode_cleanup(&result);
}

/* No channel has characters that JSON escapes. */
static void describe(const lcm_eventlog_event_t *event)
{
    printf("{\"event\": %" PRId64 ", \"utime\": %" PRId64 ", \"channel\": \"%s\", \"size\": %d",
           event->eventnum, event->timestamp, event->channel, (int) event->datalen);
    if (ends_with(event->channel, "FMB_PAIR_RESULT"))
        describe_pair_result(event);
    else if (ends_with(event->channel, "FMB_SCENE_RESULT"))
        describe_scene_result(event);
    printf("}\n");
}

/* liblcm's reader does not distinguish the end of a log from damage. */
static bool is_at_end(const lcm_eventlog_t *log)
{
    struct stat file;
    return fstat(fileno(log->f), &file) == 0 && ftell(log->f) == file.st_size;
}

int main(int argc, char **argv)
{
    lcm_eventlog_t *log = argc == 2 ? lcm_eventlog_create(argv[1], "r") : NULL;
    if (!log) {
        fprintf(stderr, "usage: describe-log FILE, a log that can be read\n");
        return 1;
    }
    lcm_eventlog_event_t *event;
    while ((event = lcm_eventlog_read_next_event(log))) {
        describe(event);
        lcm_eventlog_free_event(event);
    }
    const bool all = is_at_end(log);
    lcm_eventlog_destroy(log);
    return all && fflush(stdout) == 0 ? 0 : 1;
}
