/* Reads events of logs a second time, since unmatched queries and results only keep their offset.
 */
#ifndef AGAIN_H
#define AGAIN_H

#include "log_read.h"

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
