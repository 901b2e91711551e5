/* What answers the queries of tests that compare results. */
#ifndef REPLAY_ANSWERER_H
#define REPLAY_ANSWERER_H

#include "answer.h"
#include "replay_draw.h"

static struct answerer *answerer;
static struct answer_job *job;

/* Before each test: returns 0, or -1 if there is no memory. Drawing begins anew. */
static int open_answerer(void)
{
    const struct answerer_options options = {.frames = 2000, .server_id = 99, .secret = {1, 2}};
    drawn = 1;
    answerer = answerer_create(&options);
    job = answer_job_create();
    return answerer && job ? 0 : -1;
}

/* After each test. */
static void close_answerer(void)
{
    answer_job_destroy(job);
    answerer_destroy(answerer);
}

#endif
