/* What a recording says of itself at its end. */
#ifndef RECORD_REPORT_H
#define RECORD_REPORT_H

#include "log_parts.h"
#include "record_tally.h"

struct recorded {
    const struct tally *tally;
    const struct log_parts *parts;
    int64_t events, bytes; /* that are in the log */
    int64_t unwritten;     /* messages that came and are not in it */
    int64_t dropped;       /* datagrams that the system threw away; -1: not known */
    long receive_buffer;   /* bytes; 0: not known */
    double seconds;
    int error; /* why the log could not be written to the end; 0: it was */
};

/* Messages that are known not to be in the log, at least. */
int64_t record_lost(const struct tally *tally, int64_t unwritten, int64_t dropped);

/* On standard output. */
void record_report_json(const struct recorded *recorded);
void record_report_text(const struct recorded *recorded);

/* On standard error: what was lost, and what to do about it; nothing where nothing was. */
void record_report_losses(const struct recorded *recorded);

#endif
