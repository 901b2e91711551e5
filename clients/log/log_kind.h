/* Which of a service's channels an event of a log is on. */
#ifndef LOG_KIND_H
#define LOG_KIND_H

#include "log_read.h"

/* In the order of msgs/README.md. */
enum log_kind {
    LOG_PAIR_QUERY,
    LOG_PAIR_RESULT,
    LOG_SCENE_QUERY,
    LOG_SCENE_RESULT,
    LOG_STATUS,
    LOG_OTHER, /* somebody else's, or of a service with another prefix */
    LOG_KINDS
};

/* The channels of a service. */
struct log_channels {
    char name[LOG_OTHER][64]; /* [kind] */
    size_t length[LOG_OTHER];
};

/* prefix: one that bus_prefix_ok() takes, "" for none. */
struct log_channels log_channels(const char *prefix);

enum log_kind log_kind_of(const struct log_channels *channels, const struct log_event *event);

#endif
