/* Cuts logs: copies chosen events into a new log. A replay of the new log reports for each of its
 * queries what a replay of the whole logs reports.
 *
 * Events are copied unchanged, with their log times, and renumbered from 0. A result is copied with
 * its query (match.h), wherever it is in the logs. A result without a query is chosen by its own
 * time. Damage is left out.
 *
 * A query that names a body by handle is preceded by a definition of it (definition_t, of client 0
 * and server 0), from anywhere in the logs, unless a copied event defines it earlier. Handles that
 * the logs do not define are counted. Unless everything is chosen, names_t messages are not copied:
 * the new log begins with the names of all bodies of the logs.
 *
 * The logs are read twice: once to choose, once to copy. Memory: that of match.h, each distinct
 * body, and twice the largest event. */
#ifndef LOG_CUT_H
#define LOG_CUT_H

#include "log_choice.h"
#include "log_kind.h"
#include "output.h"

struct log_cut_options {
    char *const *log; /* [log_count] paths, read as one log */
    int log_count;
    const char *prefix; /* of the service's channels; "": none */
    struct output_options output;
    struct log_choice choice;
};

struct log_cut_counts {
    int64_t events, bytes; /* of the logs */
    int64_t kept_events, kept_bytes;
    int64_t kept[LOG_KINDS]; /* [kind] */
    /* Bodies whose definitions were added, which do not count as kept; handles in kept queries that
     * the logs do not define. */
    int64_t defined, unknown;
    int64_t names; /* added to the beginning */
    int64_t damages, damaged_bytes;
};

/* Writes the chosen events, and reports damage on stderr. Returns false if a file cannot be opened,
 * read or written, which is reported too; no output is then written. Nor is it if no event is
 * chosen: kept_events is 0. */
bool log_cut(const struct log_cut_options *options, struct log_cut_counts *counts);

#endif
