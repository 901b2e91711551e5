/* Reports what the accuracy campaign has found: as text for the methods that are never wrong, as
 * JSON for all methods. */
#ifndef REPORT_H
#define REPORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "measure.h"
#include "campaign_options.h"

struct report {
    const struct options *options;
    const struct measure *measure; /* families one after the other */
    size_t measures;
};

/* Prints the counts of each method that is never wrong, and, for some of the cells in which one of
 * its replies was wrong, a reproducer of the first. */
void report_print(const struct report *report, FILE *out);

/* Everything, a cell and a method at a time. A number that is infinite is null. False if it could
 * not be written; errno says why. */
bool report_write_json(const struct report *report, const char *path);

/* Replies that break what is promised by methods that are never wrong, and pairs that differ in
 * their orders; and pairs that are not what their family made them for. */
uint64_t report_broken(const struct report *report);
uint64_t report_not_as_made(const struct report *report);

#endif
