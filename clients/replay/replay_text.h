/* The report of a replay, for people. */
#ifndef REPLAY_TEXT_H
#define REPLAY_TEXT_H

#include "replay.h"

/* One side of a difference as text, for example "touching". Numbers read back as the same bits;
 * certificates are truncated. */
enum { REPLAY_SIDE_MAX = 320 };
void replay_side_text(const struct difference *difference, const struct difference_side *side,
                      char text[REPLAY_SIDE_MAX]);

/* One line without its end:
 *
 *     event 17  1.25 s  bodies 3 7  verdict: touching, now separated
 *
 * The time is log time, in seconds since first_utime. log: name of the log; NULL if there is only
 * one. */
enum { REPLAY_LINE_MAX = 2 * REPLAY_SIDE_MAX + 512 };
void replay_line(const struct found *found, const char *log, int64_t first_utime,
                 char line[REPLAY_LINE_MAX]);

/* Prints the counts. */
void replay_text_summary(FILE *out, const struct tally *tally);

#endif
