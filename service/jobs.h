/* The work in progress: a scene, or a pair of bodies of several frames; at most one per client,
 * JOBS in total. */
#ifndef JOBS_H
#define JOBS_H

#include "answer.h"
#include "turns.h"

#include <stdbool.h>
#include <stdint.h>

enum { JOBS = 16 };

struct job {
    struct scene_job *scene; /* in progress, unless is_pair */
    struct pair_job *pair;
    bool is_pair;
    int client; /* -1: free */
    int64_t used_ns;
};

struct jobs {
    struct job job[JOBS];
    int free;
    struct job *of_client[TURNS_CLIENTS + 1]; /* NULL: none */
};

/* Allocates all memory. False: out of memory; jobs_release() must still be called. */
bool jobs_init(struct jobs *jobs);
void jobs_release(struct jobs *jobs);

/* Assigns a free job to a client. On input: jobs->free > 0; the client has no job. */
struct job *jobs_take(struct jobs *jobs, int client);
void jobs_give_back(struct jobs *jobs, struct job *job);

/* Of the jobs that can be stopped, the one that has used most time; NULL: there is none. Those are
 * scenes with an answer, and jobs without one that have used more than JOBS_PATIENCE_NS. */
#define JOBS_PATIENCE_NS INT64_C(1000000000)
struct job *jobs_longest(struct jobs *jobs);

#endif
