/* Reads several logs as one, in the order given, for example the parts of a rotated log. One of
 * them is open at a time. */
#ifndef INPUT_H
#define INPUT_H

#include "log_read.h"

struct input {
    char *const *path; /* [count]; not owned */
    int count;
    int64_t *size;             /* owned; [count]: when the input was opened, bytes */
    struct log_reader *reader; /* owned; of the current log; NULL: it cannot be opened any more */
    int log;                   /* index of the current log */
    int64_t passed;            /* bytes read by input_next() */
};

/* Opens the first log, and checks the others. Returns false if one cannot be opened, which was
 * reported on stderr. path must outlive the input. The caller calls input_close() in both cases. */
bool input_open(struct input *input, char *const *path, int count);
void input_close(struct input *input);

/* Total bytes of the logs. */
int64_t input_size(const struct input *input);

/* As log_next(); input->log is the log of the event or damage. Data appended to a log since
 * input_open() are not read. */
enum log_outcome input_next(struct input *input, struct log_event *event,
                            struct log_damage *damage);

/* Continues at the beginning of a log. */
void input_begin(struct input *input, int log);

/* Reads the data of an event that was read before: *size bytes, as many as log_next() keeps.
 * Returns false on error: errno. Fast if the events of one log are read in the order of their
 * offsets. */
bool input_read_again(struct input *input, int log, int64_t offset, unsigned char out[LOG_DATA_MAX],
                      uint32_t *size);

#endif
