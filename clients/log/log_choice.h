/* Which events of a log somebody wants: by time, by channel and by body; each that is given has to
 * hold. Starts with no limits: log_choice_all(). */
#ifndef LOG_CHOICE_H
#define LOG_CHOICE_H

#include "log_read.h"
#include "query.h"

struct log_channel_choice;

struct log_choice {
    /* Seconds of log time since the first event, from <= t < to; -INFINITY and INFINITY: no limit.
     */
    double from, to;
    /* Owned; none: all channels, any query. */
    struct log_channel_choice *channel;
    size_t channel_count, channel_room;
    int64_t *body; /* ids, from 1 */
    size_t body_count, body_room;
};

struct log_choice log_choice_all(void);
void log_choice_clear(struct log_choice *choice);

/* One channel more, or those whose whole name an extended regular expression of POSIX matches. On
 * output: false, and why it is none. */
enum { LOG_CHOICE_WHY_MAX = 128 };
bool log_choice_add_channel(struct log_choice *choice, const char *text,
                            char why[LOG_CHOICE_WHY_MAX]);
void log_choice_add_body(struct log_choice *choice, int64_t id);

/* Whether nothing is left out. */
bool log_choice_is_all(const struct log_choice *choice);

/* The single conditions. Times are those of the log, microseconds. */
bool log_choice_has_time(const struct log_choice *choice, int64_t first_utime, int64_t utime);
bool log_choice_has_channel(const struct log_choice *choice, const struct log_event *event);
bool log_choice_has_body(const struct log_choice *choice, const struct query_frame *frame,
                         int32_t count);

#endif
