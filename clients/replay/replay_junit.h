/* What a replay found, as JUnit's XML, which CI systems show: a suite for each log, and in it a
 * case for each channel, and one that the log is whole. */
#ifndef REPLAY_JUNIT_H
#define REPLAY_JUNIT_H

#include "replay.h"
#include "listing.h"

/* On input: tally[log_count]. Where out fails, ferror() tells. */
void replay_junit(FILE *out, const struct replay_options *options, struct listing *told,
                  const struct tally *tally, int64_t first_utime);

#endif
