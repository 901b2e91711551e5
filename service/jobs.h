/* Queries in progress: scenes, and pairs with a hull or a body of several frames. At most one job
 * per client, JOBS in total. All memory is allocated by jobs_init(). No shared state. */
#ifndef JOBS_H
#define JOBS_H

#include "answer.h"
#include "scheduler.h"

#include <stdbool.h>
#include <stdint.h>

enum { JOBS = 16 };

struct job {
    struct answer_job *answer; /* owned */
    int kind;                  /* of the query, any value */
    int client;                /* -1: the job is free */
    int64_t used_ns;           /* time spent on it so far */
    int64_t number;            /* jobs are numbered in the order in which they are taken, from 1 */
};

struct jobs {
    struct job job[JOBS];
    struct answer_job *spare;                     /* owned; in no job */
    int free;                                     /* number of free jobs */
    int64_t taken;                                /* number of jobs taken so far */
    struct job *of_client[SCHEDULER_CLIENTS + 1]; /* [client] NULL: none */
};

/* Allocates the memory of all jobs; all are free. Returns false if out of memory; jobs_release()
 * must still be called. */
bool jobs_init(struct jobs *jobs);

/* Frees the memory. */
void jobs_release(struct jobs *jobs);

/* Assigns a free job with the query in jobs->spare to a client. On input: jobs->free > 0; the
 * client has no job. */
struct job *jobs_take(struct jobs *jobs, int client, int kind);

/* Makes a job free. On input: a job that was taken, and has ended. */
void jobs_give_back(struct jobs *jobs, struct job *job);

/* The job that has used most time, among those that can be stopped: scenes with at least one pair
 * answered, any job that has used more than JOBS_PATIENCE_NS, and of the jobs in progress the one
 * taken last if it has used more than JOBS_BRIEF_NS. So long jobs cannot keep short ones from
 * beginning: all but one of them go on, and the others take turns. NULL: there is none. */
#define JOBS_PATIENCE_NS INT64_C(1000000000)
#define JOBS_BRIEF_NS INT64_C(5000000)
struct job *jobs_longest(struct jobs *jobs);

#endif
