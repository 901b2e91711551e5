#include "input.h"

#include "allocate.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void say_which(const char *path, char why[LOG_WHY_MAX])
{
    char reason[LOG_WHY_MAX];
    memcpy(reason, why, sizeof reason);
    snprintf(why, LOG_WHY_MAX, "%.160s: %.90s", path, reason);
}

bool input_open(struct input *input, char *const *path, int count, char why[LOG_WHY_MAX])
{
    *input = (struct input){.reader = allocate((size_t) count, sizeof *input->reader),
                            .begin = allocate((size_t) count + 1, sizeof *input->begin)};
    for (; input->count < count; input->count++) {
        struct log_reader *reader = log_open(path[input->count], why);
        if (!reader) {
            say_which(path[input->count], why);
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

bool input_again(struct input *input, int log, int64_t offset, struct log_event *event)
{
    struct log_damage damage;
    input->log = log;
    log_seek(input->reader[log], offset);
    return log_next(input->reader[log], event, &damage) == LOG_EVENT && event->offset == offset;
}
