/* Writes LCM's event logs (log_read.h says what one is), through LCM's own functions: what they
 * write every LCM tool can read. They say little of what goes wrong; here no error of a file stays
 * unsaid. Errors are errno's numbers, log_write_complain() says them to people.
 *
 * What was appended is in memory until log_flush() or log_finish(). After the first error nothing
 * more is written: the file ends with an event that is cut off, if that, and all before it are
 * good. */
#ifndef LOG_WRITE_H
#define LOG_WRITE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct log_writer;

/* On input: force: a file that is there already is overwritten; without it that is an error,
 * EEXIST. On output: an empty log, to be closed by the caller with log_finish(); NULL: errno. */
struct log_writer *log_create(const char *path, bool force);

/* On input: utime: when it was received, microseconds since 1970; channel: channel_length bytes,
 * from 1 to LOG_CHANNEL_MAX - 1; size bytes of data, up to INT32_MAX. The events of a log are
 * numbered by LCM, from 0. On output: false: errno. */
bool log_append(struct log_writer *writer, int64_t utime, const char *channel,
                size_t channel_length, const void *data, size_t size);

/* Hands all that was appended to the system: then it stays, whatever becomes of this process. */
bool log_flush(struct log_writer *writer);

/* Bytes of the file, counted with what is still in memory; after an error those that it has. */
int64_t log_written(const struct log_writer *writer);

/* How many of them an event takes. */
int64_t log_event_bytes(size_t channel_length, size_t size);

/* Closes, and waits until the disk has it all: some errors are only heard then. On output: 0, or
 * the error, also where it was met before. writer may be NULL. */
int log_finish(struct log_writer *writer);

/* The same for one who cannot wait: hands all to the system and closes; log_reach_disk() is to be
 * called later with *disk, and waits for what the disk does not have yet. */
int log_finish_soon(struct log_writer *writer, int *disk);
int log_reach_disk(int disk); /* -1: there is nothing to wait for */

/* Says on stderr why a log cannot be written, and what to do about it. */
void log_write_complain(const char *path, int error);

#endif
