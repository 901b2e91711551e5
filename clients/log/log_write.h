/* Writes LCM event logs (format: log_read.h). Errors are values of errno; output_complain() reports
 * them.
 *
 * Appended events may stay in memory until log_flush() or log_finish(). After the first error
 * nothing more is written, and the file is truncated to its last complete event. Recordings are
 * written in append mode: if another program truncates one, complete events follow, without a hole.
 */
#ifndef LOG_WRITE_H
#define LOG_WRITE_H

#include "output.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct log_writer;

/* Begins a log in an open, empty file (output.h). The writer owns fd; the caller closes the writer
 * with log_finish(). Returns NULL if fd is negative; errno is unchanged. */
struct log_writer *log_begin(int fd);

/* As log_begin(), for an output that the caller closes with output_close() after log_finish().
 * Returns NULL if output is NULL, or after an error, which was reported. */
struct log_writer *log_begin_output(const struct output *output);

/* Appends an event. Events are numbered from 0. In: utime: time of receipt, microseconds since
 * 1970; channel_length from 1 to LOG_CHANNEL_MAX - 1; size up to INT32_MAX. Returns false on error:
 * errno. Exits with status 1 if memory is exhausted: the buffer holds the largest event. */
bool log_append(struct log_writer *writer, int64_t utime, const char *channel,
                size_t channel_length, const void *data, size_t size);

/* Passes all appended events to the system, so that they survive the end of this process. */
bool log_flush(struct log_writer *writer);

/* Bytes of the file, events still in memory included; after an error, bytes of the file. */
int64_t log_written(const struct log_writer *writer);

/* Whether the file still exists, with all that was written. False after any error, and if another
 * program deleted or truncated the file (ESTALE; events can still be appended). log_finish() checks
 * this too. */
bool log_check(struct log_writer *writer);

/* Bytes that an event takes in the file. */
int64_t log_event_bytes(size_t channel_length, size_t size);

/* Closes the log and waits until all is on disk: some errors only show then. Returns 0; or the
 * first error, even if it was returned before. writer may be NULL. */
int log_finish(struct log_writer *writer);

/* As log_finish(), without waiting for the disk. Call log_reach_disk() later with *disk, which
 * waits. */
int log_finish_soon(struct log_writer *writer, int *disk);
int log_reach_disk(int disk); /* disk may be -1: returns 0 at once */

#endif
