#include "jobs.h"

#include <assert.h>

bool jobs_init(struct jobs *jobs)
{
    *jobs = (struct jobs){.spare = answer_job_create(), .free = JOBS};
    bool ok = jobs->spare;
    for (int i = 0; i < JOBS; i++) {
        jobs->job[i] = (struct job){.answer = answer_job_create(), .client = -1};
        ok = ok && jobs->job[i].answer;
    }
    return ok;
}

void jobs_release(struct jobs *jobs)
{
    answer_job_destroy(jobs->spare);
    for (int i = 0; i < JOBS; i++)
        answer_job_destroy(jobs->job[i].answer);
}

struct job *jobs_take(struct jobs *jobs, int client, int kind)
{
    struct job *job = jobs->job;
    assert(jobs->free > 0 && !jobs->of_client[client]);
    while (job->client >= 0)
        job++;
    struct answer_job *begun = jobs->spare;
    jobs->spare = job->answer;
    *job = (struct job){.answer = begun, .kind = kind, .client = client, .number = ++jobs->taken};
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

struct job *jobs_longest(struct jobs *jobs)
{
    struct job *longest = NULL;
    int64_t last = 0; /* number of the job taken last */
    for (int i = 0; i < JOBS; i++)
        if (jobs->job[i].client >= 0 && jobs->job[i].number > last)
            last = jobs->job[i].number;
    for (int i = 0; i < JOBS; i++) {
        struct job *job = &jobs->job[i];
        const int64_t patience_ns = job->number == last ? JOBS_BRIEF_NS : JOBS_PATIENCE_NS;
        if (job->client >= 0 &&
            (job->used_ns > patience_ns || answer_job_has_answers(job->answer)) &&
            (!longest || job->used_ns > longest->used_ns))
            longest = job;
    }
    return longest;
}
