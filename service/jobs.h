/* The scenes in progress: at most one per client, JOBS in total. */
#ifndef JOBS_H
#define JOBS_H

#include "answer.h"
#include "turns.h"

#include <stdbool.h>
#include <stdint.h>

enum { JOBS = 16 };

struct job {
    struct scene_job *scene;
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

/* Of the jobs that can stop, the one that has used most time; NULL: none can. */
struct job *jobs_longest(struct jobs *jobs);

#endif
