/* Selects events of a log by time and channel. An event must meet all conditions given.
 * log_choice_all() has no conditions. */
#ifndef LOG_CHOICE_H
#define LOG_CHOICE_H

#include "log_read.h"

struct log_channel_choice;

struct log_choice {
    /* from <= t < to, log time in seconds since the first event; -INFINITY, INFINITY: no limit. */
    double from, to;
    /* Owned. If there are none, all channels are chosen. */
    struct log_channel_choice *channel;
    size_t channel_count, channel_capacity;
};

struct log_choice log_choice_all(void);
void log_choice_clear(struct log_choice *choice);

/* Adds a channel, or those whose whole name matches a POSIX extended regular expression. Returns
 * false, and why, if text is neither. */
enum { LOG_CHOICE_WHY_MAX = 128 };
bool log_choice_add_channel(struct log_choice *choice, const char *text,
                            char why[LOG_CHOICE_WHY_MAX]);

/* Whether there are no conditions. */
bool log_choice_is_all(const struct log_choice *choice);

/* Check a single condition. Times are log times, microseconds. */
bool log_choice_has_time(const struct log_choice *choice, int64_t first_utime, int64_t utime);
bool log_choice_has_channel(const struct log_choice *choice, const struct log_event *event);

#endif
