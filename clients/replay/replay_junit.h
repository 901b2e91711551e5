/* The report of a replay as JUnit XML, for CI systems: a suite for each log, with a case for each
 * channel, and one for damage. */
#ifndef REPLAY_JUNIT_H
#define REPLAY_JUNIT_H

#include "replay.h"
#include "listing.h"

/* On input: tally[log_count]. Check ferror(out) for write errors. */
void replay_junit(FILE *out, const struct replay_options *options, struct listing *list,
                  const struct tally *tally, int64_t first_utime);

#endif
