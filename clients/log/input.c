#include "input.h"

#include "allocate.h"
#include "complain.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

bool input_open(struct input *input, char *const *path, int count)
{
    char why[LOG_WHY_MAX];
    *input = (struct input){.reader = allocate((size_t) count, sizeof *input->reader),
                            .begin = allocate((size_t) count + 1, sizeof *input->begin)};
    for (; input->count < count; input->count++) {
        struct log_reader *reader = log_open(path[input->count], why);
        if (!reader) {
            complain("%s: %s", path[input->count], why);
            input_close(input);
            return false;
        }
        input->reader[input->count] = reader;
        input->begin[input->count + 1] = input->begin[input->count] + log_size(reader);
    }
    return true;
}

void input_close(struct input *input)
{
    for (int i = 0; i < input->count; i++)
        log_close(input->reader[i]);
    free(input->reader);
    free(input->begin);
    *input = (struct input){.count = 0};
}

int64_t input_size(const struct input *input)
{
    return input->begin[input->count];
}

enum log_outcome input_next(struct input *input, struct log_event *event, struct log_damage *damage)
{
    enum log_outcome outcome;
    while ((outcome = log_next(input->reader[input->log], event, damage)) == LOG_END &&
           input->log + 1 < input->count)
        log_rewind(input->reader[++input->log]);
    if (outcome < LOG_END)
        input->passed += outcome == LOG_EVENT ? event->length : damage->length;
    return outcome;
}

void input_rewind(struct input *input)
{
    input->log = 0;
    log_rewind(input->reader[0]);
}

/* ---- Reading events again ---- */

struct event_reader {
    char *const *path;
    int count;
    const char *golden;
    struct log_reader *reader; /* of the current log; NULL: none */
    int log;
};

struct event_reader *event_reader_open(char *const *path, int count, const char *golden)
{
    struct event_reader *rereader = allocate(1, sizeof *rereader);
    *rereader = (struct event_reader){.path = path, .count = count, .golden = golden};
    return rereader;
}

void event_reader_close(struct event_reader *rereader)
{
    if (!rereader)
        return;
    log_close(rereader->reader);
    free(rereader);
}

static bool choose(struct event_reader *rereader, int log)
{
    char why[LOG_WHY_MAX];
    if (rereader->reader && rereader->log == log)
        return true;
    log_close(rereader->reader);
    rereader->log = log;
    rereader->reader =
        log_open(log < rereader->count ? rereader->path[log] : rereader->golden, why);
    return rereader->reader;
}

bool event_reader_read(struct event_reader *rereader, int log, int64_t offset,
                       unsigned char out[LOG_DATA_MAX], uint32_t *size)
{
    struct log_event event;
    struct log_damage damage;
    errno = 0;
    if (!choose(rereader, log))
        return false;
    log_seek(rereader->reader,
             offset < log_size(rereader->reader) ? offset : log_size(rereader->reader));
    if (log_next(rereader->reader, &event, &damage) != LOG_EVENT || event.offset != offset) {
        errno = errno ? errno : EIO; /* it could be read before */
        return false;
    }
    memcpy(out, event.data, event.kept);
    *size = (uint32_t) event.kept;
    return true;
}
