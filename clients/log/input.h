/* Reads several logs as one, in the order given, as rotation wrote them. */
#ifndef INPUT_H
#define INPUT_H

#include "log_read.h"

struct input {
    struct log_reader **reader; /* owned; [count] */
    int64_t *begin;             /* owned; [count + 1]: total bytes of the logs before */
    int count;
    int log;        /* index of the current log */
    int64_t passed; /* bytes that input_next() has read */
};

/* Opens all logs. False: one cannot be opened; why names it and the reason. */
bool input_open(struct input *input, char *const *path, int count, char why[LOG_WHY_MAX]);
void input_close(struct input *input);

/* Total bytes of the logs. */
int64_t input_size(const struct input *input);

/* As log_next(); input->log is the log of the event or damage. */
enum log_outcome input_next(struct input *input, struct log_event *event,
                            struct log_damage *damage);

/* Returns to the beginning of the first log. */
void input_rewind(struct input *input);

/* Reads events of logs a second time, since unmatched queries and results only keep their offset.
 */
struct again;

/* On input: paths of logs, not copied; golden: path of another log, with index count, or NULL.
 * Exits with status 1 if memory is exhausted. */
struct again *again_open(char *const *path, int count, const char *golden);
void again_close(struct again *again); /* may be NULL */

/* Reads the data of an event at an offset where one was read before: *size bytes, as many as
 * log_next() keeps. False: errno. Fast for events of one log in the order of their offsets. */
bool again_read(struct again *again, int log, int64_t offset, unsigned char out[LOG_DATA_MAX],
                uint32_t *size);

#endif
