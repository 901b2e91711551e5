/* Prints the summary of a log. */
#ifndef LOG_INFO_REPORT_H
#define LOG_INFO_REPORT_H

#include "log_info.h"

#include <stdio.h>

struct log_report {
    const char *path;
    int64_t size;
    const char *error;           /* why it could not be read to its end; NULL: no error */
    const struct log_info *info; /* after log_info_end() */
};

/* For people; lists the first few damaged places. Control characters in channel names are not
 * printed. */
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
 * its fingerprint, "0x0123456789abcdef", or null where the data has none. "others" follows channels
 * if there are more than LOG_INFO_ROWS_MAX; at most LOG_INFO_DAMAGES_MAX places are listed; "error"
 * comes last, if the log could not be read to its end. */
void log_report_json(FILE *out, const struct log_report *report);

#endif
