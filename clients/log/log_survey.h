/* Reads logs once, and determines the contents of a cut (log_cut.h): its events, and the bodies
 * that it must define. Memory: a bit for each event, the unmatched queries and results, and each
 * distinct body. */
#ifndef LOG_SURVEY_H
#define LOG_SURVEY_H

#include "input.h"
#include "log_choice.h"
#include "log_kind.h"

struct log_survey_options {
    struct input *input; /* at the beginning */
    char *const *log;    /* paths */
    const struct log_channels *channels;
    const struct log_choice *choice;
    /* Called after input->passed has grown. */
    void (*progress)(void *user);
    void *user;
};

struct log_survey {
    unsigned char *chosen; /* owned; one bit for each event */
    size_t chosen_size;    /* bytes */
    /* Distinct handles that chosen queries name and no earlier chosen event defines, ascending. */
    struct handle *wanted; /* owned */
    size_t wanted_count, wanted_capacity;
    struct definitions *definitions; /* owned; of all events, chosen or not */
};

/* Events are numbered from 0 over all logs. Returns false if a file failed, which was reported on
 * stderr. Clear *out in any case. */
bool log_survey(const struct log_survey_options *options, struct log_survey *out);
void log_survey_clear(struct log_survey *survey);

bool log_survey_is_chosen(const struct log_survey *survey, int64_t event);

#endif
