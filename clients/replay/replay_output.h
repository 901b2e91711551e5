/* Reports of a replay: as text, as one line of JSON, and as JUnit XML. */
#ifndef REPLAY_OUTPUT_H
#define REPLAY_OUTPUT_H

#include "escape.h"
#include "json_write.h"
#include "listing.h"
#include "replay.h"

/* ---- For people ---- */

/* Writes one line:
 *
 *     event 17  1.25 s  bodies table 7  verdict: touching, now separated
 *     event 19 (home)  1.5 s  bodies table 7  gap lower bound: 2, now 3 (+1), and 3 more numbers
 *
 * The label of a scene follows the event. The time is log time, in seconds since first_utime.
 * Bodies without a name have their id. Of several numbers, the one that has changed most is
 * printed; of a gap, one of its bounds, if these have changed. The two read back as the same bits;
 * certificates are truncated. log: name of the log; NULL if there is only one. */
void replay_line(FILE *out, enum escape form, const struct difference *difference,
                 const struct body_names *names, const char *log, int64_t first_utime);

/* Prints the counts as text. */
void replay_text_summary(FILE *out, const struct tally *tally);

/* ---- As JSON ---- */

/* The report of a replay as one line of JSON:
 *
 *     {"differences": [{"log": "a.log", "event": 17, "utime": ..., "time": 1.25,
 *                       "channel": "FMB_PAIR_QUERY", "client_id": 7, "sequence_number": 3,
 *                       "a": 3, "b": 7, "names": ["table", null], "kind": "verdict",
 *                       "then": {"verdict": "touching"}, "now": {"verdict": "separated"}}],
 *      "not_listed": 0, "same": 12, "different": 1, ...}
 *
 * names: only if a body has one; "label": only if the scene has one. not_listed: number of
 * differences beyond the limit. */
struct json_writer replay_json_begin(FILE *out);
void replay_json_found(struct json_writer *json, const struct difference *difference,
                       const struct body_names *names, const char *log, int64_t first_utime);
void replay_json_end(struct json_writer *json, const struct tally *tally, int64_t not_listed,
                     int exit_code);

/* ---- As JUnit XML, for CI systems: a suite for each log, with a case for each label of its
 * scenes, one for the other queries of each channel, and one for damage ---- */

/* In: tally[log_count] of a replay with options->labels. On output: ferror(out) is set if writing
 * failed. */
void replay_junit(FILE *out, const struct replay_options *options, struct listing *list,
                  struct tally *tally, int64_t first_utime);

#endif
