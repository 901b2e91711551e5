/* Goes through logs, and finds what a cut of them (log_cut.h) has to hold: which events, and what
 * is to be written back into queries that came by keys. */
#ifndef LOG_SURVEY_H
#define LOG_SURVEY_H

#include "input.h"
#include "log_choice.h"
#include "log_kind.h"
#include "log_marks.h"
#include "log_patches.h"

struct log_survey_options {
    struct input *input; /* at its beginning */
    char *const *log;    /* paths */
    const struct log_channels *channels;
    const struct log_choice *choice;
    /* So many bytes more have been gone through. */
    void (*progress)(void *user, int64_t bytes);
    void *user;
};

struct log_survey {
    struct log_marks *marks;     /* owned: events that are chosen */
    struct log_patches *patches; /* owned: of queries that are chosen */
    /* Frames of chosen queries that came by keys which the logs do not tell, and those queries. */
    int64_t unknown_frames, unknown_queries;
};

/* Events are numbered over all logs, from 0. *out is to be cleared in any case. False: a file
 * failed, which has been said on stderr. */
bool log_survey(const struct log_survey_options *options, struct log_survey *out);
void log_survey_clear(struct log_survey *survey);

#endif
