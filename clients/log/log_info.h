/* What is in an event log, taken in one event after the other, in memory that is bounded whatever
 * the log holds. */
#ifndef LOG_INFO_H
#define LOG_INFO_H

#include "log_read.h"

/* Of channels, each with one type of message, so many are counted for themselves, the first to be
 * seen; of damages so many are kept, the first. */
enum { LOG_INFO_ROWS_MAX = 4096, LOG_INFO_DAMAGES_MAX = 1000 };

struct log_tally {
    int64_t events;
    int64_t bytes;      /* of their data */
    size_t least, most; /* bytes of the data of one */
    int64_t begin, end; /* the first time and the last one, whatever their order in the log, us */
};

/* The type of a message is its first 8 bytes, big-endian; shorter ones have none. */
struct log_type {
    bool known;
    int64_t fingerprint; /* 0 where it is not known */
};

struct log_row {
    char *channel; /* its bytes, no final 0 */
    size_t channel_length;
    struct log_type type;
    struct log_tally tally;
    unsigned next; /* which row came last after this one: the guess for what comes now */
};

struct log_info {
    struct log_tally all;     /* good when log_info_end() was called */
    struct log_tally others;  /* of those for which there was no row */
    int64_t backward;         /* events whose time is before that of the event before them */
    int64_t damages, damaged; /* how many, and bytes of them all */
    struct log_damage damage[LOG_INFO_DAMAGES_MAX];
    unsigned row_count;
    struct log_row row[LOG_INFO_ROWS_MAX]; /* by channel and type when log_info_end() was called */
    /* For itself. */
    int64_t utime;                              /* of the last event */
    unsigned last;                              /* its row */
    unsigned short slot[2 * LOG_INFO_ROWS_MAX]; /* [hash] a row's index + 1, or 0 */
};

/* On output: to be closed by the caller. */
struct log_info *log_info_open(void);
void log_info_close(struct log_info *info);

void log_info_event(struct log_info *info, const struct log_event *event);
void log_info_damage(struct log_info *info, const struct log_damage *damage);

/* Nothing more comes. */
void log_info_end(struct log_info *info);

#endif
