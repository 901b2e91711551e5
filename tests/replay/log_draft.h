/* An event log being made in memory, with whatever in it. */
#ifndef LOG_DRAFT_H
#define LOG_DRAFT_H

#include <stddef.h>
#include <stdint.h>

struct log_draft {
    unsigned char *bytes; /* owned */
    size_t size, capacity;
    int64_t events;
};

/* All end the program where there is no memory, or no file. */
void log_draft_event(struct log_draft *log, const char *channel, int64_t utime, const void *data,
                     size_t size);
/* A header without data. The lengths that it states need not be true. */
void log_draft_header(struct log_draft *log, int64_t number, int64_t utime, uint32_t channel_length,
                      uint32_t data_size);
/* Any bytes, as they are. */
void log_draft_raw(struct log_draft *log, const void *bytes, size_t size);
void log_draft_free(struct log_draft *log);

/* A file without a name that holds the bytes. Returns its descriptor, to be closed by the caller;
 * path: what opens it, as long as that is open. */
enum { LOG_DRAFT_PATH_MAX = 64 };
int log_draft_file(const unsigned char *bytes, size_t size, char path[LOG_DRAFT_PATH_MAX]);

#endif
