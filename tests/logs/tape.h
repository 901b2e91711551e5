/* A log of LCM events being made: timed by its own clock, never by the machine's, so that the file
 * is the same bytes whenever and wherever it is made.
 *
 * Failures are kept until tape_close(), which reports them. */
#ifndef TAPE_H
#define TAPE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct tape;

/* When every tape begins: 2024-01-01, 00:00 UTC, in microseconds since 1970. */
#define TAPE_BEGIN_UTIME INT64_C(1704067200000000)

/* How it is written. IN_ORDER: at the end, by the times of the events, those of the same time in
 * the order in which they were put. AS_PUT: at once, whatever their times, so that a tape may be
 * longer than memory. */
enum tape_order { TAPE_IN_ORDER, TAPE_AS_PUT };

/* On output: a tape at its beginning; NULL: the file cannot be made, errno says why. */
struct tape *tape_open(const char *path, enum tape_order order);

/* Frees the tape. False: it could not be written in full, or there was no memory. */
bool tape_close(struct tape *tape);

/* The tape's clock, microseconds since 1970, which goes on only here. */
int64_t tape_utime(const struct tape *tape);
void tape_pass(struct tape *tape, int64_t us);

/* Puts an event of this time, which need not be now. Copies what it is given. */
void tape_put(struct tape *tape, int64_t utime, const char *channel, const unsigned char *bytes,
              size_t size);

#endif
