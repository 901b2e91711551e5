#include "input.h"

#include "allocate.h"
#include "complain.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static bool choose(struct input *input, int log, char why[LOG_WHY_MAX])
{
    if (input->reader && input->log == log)
        return true;
    log_close(input->reader);
    input->log = log;
    input->reader = log_open(input->path[log], why);
    if (input->reader && input->size[log] >= 0)
        log_limit(input->reader, input->size[log]);
    return input->reader;
}

bool input_open(struct input *input, char *const *path, int count)
{
    char why[LOG_WHY_MAX];
    *input = (struct input){
        .path = path, .count = count, .size = allocate((size_t) count, sizeof *input->size)};
    for (int log = 0; log < count; log++) {
        input->size[log] = -1;
        if (!choose(input, log, why)) {
            complain("%s: %s", path[log], why);
            return false;
        }
        input->size[log] = log_size(input->reader);
    }
    input_begin(input, 0);
    return true;
}

void input_close(struct input *input)
{
    log_close(input->reader);
    free(input->size);
    *input = (struct input){.count = 0};
}

int64_t input_size(const struct input *input)
{
    int64_t size = 0;
    for (int log = 0; log < input->count; log++)
        size += input->size[log];
    return size;
}

void input_begin(struct input *input, int log)
{
    char why[LOG_WHY_MAX];
    if (choose(input, log, why))
        log_seek(input->reader, 0);
}

enum log_outcome input_next(struct input *input, struct log_event *event, struct log_damage *damage)
{
    enum log_outcome outcome = LOG_FAILED;
    errno = EIO; /* a log that could be opened before */
    while (input->reader && (outcome = log_next(input->reader, event, damage)) == LOG_END &&
           input->log + 1 < input->count)
        input_begin(input, input->log + 1);
    if (!input->reader)
        return LOG_FAILED;
    if (outcome < LOG_END)
        input->passed += outcome == LOG_EVENT ? event->length : damage->length;
    return outcome;
}

bool input_read_again(struct input *input, int log, int64_t offset, unsigned char out[LOG_DATA_MAX],
                      uint32_t *size)
{
    struct log_event event;
    struct log_damage damage;
    char why[LOG_WHY_MAX];
    errno = 0;
    if (choose(input, log, why)) {
        log_seek(input->reader, offset < input->size[log] ? offset : input->size[log]);
        if (log_next(input->reader, &event, &damage) == LOG_EVENT && event.offset == offset) {
            memcpy(out, event.data, event.kept);
            *size = (uint32_t) event.kept;
            return true;
        }
    }
    errno = errno ? errno : EIO; /* it could be read before */
    return false;
}
