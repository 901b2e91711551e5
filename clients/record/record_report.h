/* The progress line of a recording, and the report at its end. */
#ifndef RECORD_REPORT_H
#define RECORD_REPORT_H

#include "bus.h"
#include "log_kind.h"
#include "log_parts.h"
#include "record_bodies.h"

/* Shows the line, unless standard error is not a terminal, or would block. In: messages and bytes
 * so far, and datagrams lost. Out: *shown: true if the line was shown; else unchanged. */
void record_line_show(bool *shown, int64_t events, int64_t bytes, int64_t lost);

/* Clears the line, if it is shown. */
void record_line_end(bool *shown);

struct recorded {
    int64_t received[LOG_KINDS]; /* [kind] messages, written or not */
    int64_t malformed;           /* messages of the service that cannot be decoded */
    int64_t events, bytes;       /* of the log */
    double seconds;
    struct record_bodies_counts bodies;
    struct bus_counts bus; /* dropped: messages missing from the log */
};

/* Print on standard output. */
void record_report_json(const struct recorded *recorded, const struct log_parts *parts);
void record_report_text(const struct recorded *recorded, const struct log_parts *parts);

/* Reports on standard error what is missing, if anything, in one line. */
void record_report_losses(const struct recorded *recorded);

#endif
