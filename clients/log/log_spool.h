/* A log that is written by a thread of its own: who hands events over never waits for a disk.
 *
 * They wait in memory, in two halves: one is filled while the other is written, then they change
 * places, at least some twenty times a second. So a process that is killed loses no more than some
 * fifty milliseconds, and a disk that stops for a while nothing, as long as there is room. Memory
 * is only touched where it is needed. */
#ifndef LOG_SPOOL_H
#define LOG_SPOOL_H

#include "log_parts.h"

struct log_spool;

/* Starts the thread. On input: parts are open, and nobody else touches them until
 * log_spool_finish(); half: bytes of each half. On output: NULL: errno. */
struct log_spool *log_spool_start(struct log_parts *parts, size_t half);

/* Hands an event over, as log_append() takes it. False: it is not written, since there is no room,
 * or since nothing can be written any more. */
bool log_spool_put(struct log_spool *spool, int64_t utime, const char *channel,
                   size_t channel_length, const void *data, size_t size);

/* What has become of them. */
struct log_spool_state {
    int64_t events, bytes; /* that the system has, bytes with those of the events' headers */
    long part;             /* the number of the file that is being written */
    int error;             /* why nothing is written any more; 0: all is well */
};
struct log_spool_state log_spool_state(struct log_spool *spool);

/* Writes what waits, ends the thread, finishes the parts, and frees all but them. On output: the
 * state at the end. */
struct log_spool_state log_spool_finish(struct log_spool *spool);

#endif
