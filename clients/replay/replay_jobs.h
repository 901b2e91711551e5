/* A replay on several cores: each of several processes has a part of the bytes of the logs, and
 * what they find comes in the order of the parts, as if it had been one. */
#ifndef REPLAY_JOBS_H
#define REPLAY_JOBS_H

#include "replay.h"

enum { REPLAY_JOBS_MAX = 256 };

/* As replay_run() of all; size: replay_size(). With more jobs than one the options have no page and
 * no write_golden. False also where a process died, which has been said on stderr. */
bool replay_jobs(const struct replay_options *options, int jobs, int64_t size,
                 const struct replay_sink *sink, struct tally *tally);

#endif
