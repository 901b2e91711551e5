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
    job->number = ++jobs->taken;
    jobs->last = job;
    jobs->of_client[client] = job;
    jobs->free--;
    return job;
}

/* The job in progress that was taken last; NULL: there is none. */
static const struct job *find_last(const struct jobs *jobs)
{
    const struct job *last = NULL;
    for (int i = 0; i < JOBS; i++) {
        const struct job *job = &jobs->job[i];
        if (job->client >= 0 && (!last || job->number > last->number))
            last = job;
    }
    return last;
}

void jobs_give_back(struct jobs *jobs, struct job *job)
{
    jobs->of_client[job->client] = NULL;
    job->client = -1;
    jobs->free++;
    if (job == jobs->last)
        jobs->last = find_last(jobs);
}

static bool can_stop(const struct jobs *jobs, const struct job *job)
{
    const int64_t patience_ns = job == jobs->last ? JOBS_BRIEF_NS : JOBS_PATIENCE_NS;
    return job->used_ns > patience_ns || (!job->is_pair && scene_job_has_answers(job->scene));
}

struct job *jobs_longest(struct jobs *jobs)
{
    struct job *longest = NULL;
    for (int i = 0; i < JOBS; i++) {
        struct job *job = &jobs->job[i];
        if (job->client >= 0 && can_stop(jobs, job) &&
            (!longest || job->used_ns > longest->used_ns))
            longest = job;
    }
    return longest;
}
