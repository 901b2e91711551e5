/* A summary of an event log, built event by event, and its reports. Memory grows with the number of
 * channels. For one thread at a time. */
#ifndef LOG_INFO_H
#define LOG_INFO_H

#include "body_names.h"
#include "keyed_hash.h"

#include <stdio.h>

/* The first so many damaged places are kept. */
enum { LOG_INFO_DAMAGES_MAX = 1000 };

struct log_tally {
    int64_t events;
    int64_t bytes;      /* data of all events */
    size_t least, most; /* data of one event, bytes */
    int64_t begin, end; /* earliest and latest time, in any order in the log, microseconds */
};

/* The type of a message: its first 8 bytes, big-endian; shorter messages have none. */
struct log_type {
    bool known;
    int64_t fingerprint; /* 0 if not known */
};

/* The events of one channel and type. */
struct log_row {
    const char *channel; /* not zero-terminated */
    size_t channel_length;
    struct log_type type;
    struct log_tally tally;
    UT_hash_handle hh; /* hh.next: the next row; NULL: none */
    /* Private. */
    enum log_kind kind;  /* of messages that give bodies names, by their type; else LOG_OTHER */
    unsigned char key[]; /* type and channel */
};

struct log_info {
    struct log_tally all;     /* valid after log_info_end() */
    int64_t backward;         /* events with an earlier time than the event before them */
    int64_t damages, damaged; /* number of damaged places, and their bytes */
    struct log_damage damage[LOG_INFO_DAMAGES_MAX];
    struct body_names *names; /* of all channels; owned */
    struct log_row *rows;     /* owned; the first one, by channel and type after log_info_end() */
    /* Private. */
    int64_t utime; /* of the last event */
};

/* Opens an empty summary, which the caller closes. Exits with status 1 if memory is exhausted. */
struct log_info *log_info_open(void);
void log_info_close(struct log_info *info);

void log_info_event(struct log_info *info, const struct log_event *event);
void log_info_damage(struct log_info *info, const struct log_damage *damage);

/* Completes the summary. No events may be added after that. */
void log_info_end(struct log_info *info);

/* ---- Reports ---- */

struct log_report {
    const char *path;
    int64_t size;
    const char *error;           /* why it could not be read to its end; NULL: no error */
    const struct log_info *info; /* after log_info_end() */
};

/* For people; lists the first few names and damaged places. Control characters in channels and
 * names are not printed. */
void log_report_text(FILE *out, const struct log_report *report);

/* One line, one JSON object:
 *
 *     {"log": "a.log", "size": 523, "events": 2, "bytes": 373, "begin": 1700000000000000,
 *      "end": 1700000000000100, "rate": 20000, "backward": 0,
 *      "channels": [{"channel": "FMB_PAIR_QUERY", "type": "fmb_msgs.pair_query_t", "events": 1,
 *                    "bytes": 328, "least": 328, "most": 328, "begin": 1700000000000000,
 *                    "end": 1700000000000000}, ...],
 *      "damage": {"places": 1, "bytes": 100, "first": [
 *          {"offset": 423, "length": 100, "what": "the last event is cut off"}]}}
 *
 * bytes, least and most are of data; times are microseconds since 1970, null where there is no
 * event; rate is events a second, null where no time passes. A type that is not one of fmb_msgs is
 * its fingerprint, "0x0123456789abcdef", or null where the data has none. "names" follows channels,
 * if bodies have names, the last name of each: [{"client_id": 7, "body_id": 1, "name": "table"},
 * ...]; at most LOG_INFO_DAMAGES_MAX places are listed; "error" comes last, if the log could not be
 * read to its end. */
void log_report_json(FILE *out, const struct log_report *report);

#endif
