/* Reads several logs as one, in the order given, for example the parts of a rotated log. */
#ifndef INPUT_H
#define INPUT_H

#include "log_read.h"

struct input {
    struct log_reader **reader; /* owned; [count] */
    int64_t *begin; /* owned; [count + 1]: total size of the logs before this one, bytes */
    int count;
    int log;        /* index of the current log */
    int64_t passed; /* bytes read by input_next() */
};

/* Opens all logs. Returns false if one cannot be opened, which was reported on stderr. The caller
 * calls input_close() after success. */
bool input_open(struct input *input, char *const *path, int count);
void input_close(struct input *input);

/* Total bytes of the logs. */
int64_t input_size(const struct input *input);

/* As log_next(); input->log is the log of the event or damage. */
enum log_outcome input_next(struct input *input, struct log_event *event,
                            struct log_damage *damage);

/* Returns to the beginning of the first log. */
void input_rewind(struct input *input);

/* Reads events a second time, by offset: unmatched queries and results keep only their position. */
struct event_reader;

/* In: path[count]: logs, not copied; golden: path of another log, which has index count, or NULL.
 * Exits with status 1 if memory is exhausted. */
struct event_reader *event_reader_open(char *const *path, int count, const char *golden);
void event_reader_close(struct event_reader *rereader); /* may be NULL */

/* Reads the data of an event that was read before: *size bytes, as many as log_next() keeps.
 * Returns false on error: errno. Fast if the events of one log are read in the order of their
 * offsets. */
bool event_reader_read(struct event_reader *rereader, int log, int64_t offset,
                       unsigned char out[LOG_DATA_MAX], uint32_t *size);

#endif
