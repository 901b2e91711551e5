/* Work that falls into independent jobs, done by several threads. */
#ifndef WORKERS_H
#define WORKERS_H

#include <stddef.h>

typedef void workers_run(void *context, size_t job);

/* As many as the machine has processors on line. */
long workers_usual(void);

/* Calls run for each job from 0 to jobs - 1, on so many threads (at least 1), and returns when all
 * are done. Where standard error is a terminal, shows there how far it is, under the name. */
void workers_do(const char *name, long workers, size_t jobs, workers_run *run, void *context);

#endif
