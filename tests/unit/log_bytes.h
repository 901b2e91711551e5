/* Logs in memory, and a file to read them from. */
#ifndef LOG_BYTES_H
#define LOG_BYTES_H

#include <stddef.h>
#include <stdint.h>

enum { LOG_BYTES_MAX = 1 << 22, LOG_BYTES_EVENTS_MAX = 1 << 16 };

struct log_bytes {
    size_t size, count;
    size_t begin[LOG_BYTES_EVENTS_MAX]; /* [event], of those that were added as good ones */
    size_t end[LOG_BYTES_EVENTS_MAX];
    unsigned char bytes[LOG_BYTES_MAX];
};

/* All of these add to the end of the log. */

/* A header without data. What it states of lengths need not be true of what is added next. */
void log_bytes_header(struct log_bytes *log, int64_t number, int64_t utime, uint32_t channel_length,
                      uint32_t data_size);
void log_bytes_add(struct log_bytes *log, const void *bytes, size_t size);

/* A good event. */
void log_bytes_event(struct log_bytes *log, int64_t utime, const char *channel, const void *data,
                     size_t size);

/* The path of a file with these bytes. There is only one: it replaces the one before. */
const char *log_bytes_file(const void *bytes, size_t size);

/* Of that file, to make it what it is not. */
int log_bytes_descriptor(void);

#endif
