/* Selects events of a log by time and channel. An event must meet all conditions given.
 * log_choice_all() has no conditions. */
#ifndef LOG_CHOICE_H
#define LOG_CHOICE_H

#include "args.h"
#include "log_read.h"

#include <regex.h>

struct log_choice {
    /* from <= t < to, log time in seconds since the first event; -INFINITY, INFINITY: no limit. */
    double from, to;
    bool has_channel; /* otherwise all channels are chosen */
    regex_t channel;  /* owned; of the whole name */
};

struct log_choice log_choice_all(void);
void log_choice_clear(struct log_choice *choice);

/* Takes the option --channel: the channels whose whole name matches a POSIX extended regular
 * expression. choice: without a channel. Returns false after an error, which was reported. */
bool log_choice_take_channel(const struct args *args, void *choice);

/* Whether there are no conditions. */
bool log_choice_is_all(const struct log_choice *choice);

/* Check a single condition. Times are log times, microseconds. */
bool log_choice_has_time(const struct log_choice *choice, int64_t first_utime, int64_t utime);
bool log_choice_has_channel(const struct log_choice *choice, const char *channel);

#endif
