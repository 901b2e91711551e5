#include "jobs.h"

#include <assert.h>

bool jobs_init(struct jobs *jobs)
{
    *jobs = (struct jobs){.free = JOBS};
    for (int i = 0; i < JOBS; i++) {
        jobs->job[i] =
            (struct job){.scene = scene_job_create(), .pair = pair_job_create(), .client = -1};
        if (!jobs->job[i].scene || !jobs->job[i].pair)
            return false;
    }
    return true;
}

void jobs_release(struct jobs *jobs)
{
    for (int i = 0; i < JOBS; i++) {
        scene_job_destroy(jobs->job[i].scene);
        pair_job_destroy(jobs->job[i].pair);
    }
}

struct job *jobs_take(struct jobs *jobs, int client)
{
    struct job *job = jobs->job;
    assert(jobs->free > 0 && !jobs->of_client[client]);
    while (job->client >= 0)
        job++;
    job->client = client;
    job->used_ns = 0;
    jobs->of_client[client] = job;
    jobs->free--;
    return job;
}

void jobs_give_back(struct jobs *jobs, struct job *job)
{
    jobs->of_client[job->client] = NULL;
    job->client = -1;
    jobs->free++;
}

static bool can_stop(const struct job *job)
{
    return job->used_ns > JOBS_PATIENCE_NS || (!job->is_pair && scene_job_has_answers(job->scene));
}

struct job *jobs_longest(struct jobs *jobs)
{
    struct job *longest = NULL;
    for (int i = 0; i < JOBS; i++) {
        struct job *job = &jobs->job[i];
        if (job->client >= 0 && can_stop(job) && (!longest || job->used_ns > longest->used_ns))
            longest = job;
    }
    return longest;
}
