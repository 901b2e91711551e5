/* Several logs, read as one: in the order given, as rotation wrote them. */
#ifndef INPUT_H
#define INPUT_H

#include "log_read.h"

struct input {
    struct log_reader **reader; /* owned; [count] */
    int64_t *begin;             /* owned; [count + 1]: bytes of the logs before each */
    int count;
    int log; /* that is being read */
};

/* Opens them all. False: one cannot be opened; why says so, and which. */
bool input_open(struct input *input, char *const *path, int count, char why[LOG_WHY_MAX]);
void input_close(struct input *input);

/* Bytes of all. */
int64_t input_size(const struct input *input);

/* As log_next(); input->log says which log. */
enum log_outcome input_next(struct input *input, struct log_event *event,
                            struct log_damage *damage);

/* Begins anew with the first log. */
void input_rewind(struct input *input);

/* An event that was read before. False: it is not there any more. Then goes on behind it. */
bool input_again(struct input *input, int log, int64_t offset, struct log_event *event);

#endif
