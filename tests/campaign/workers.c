#include "workers.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

enum { WORKERS_MAX = 256 };

struct workers {
    workers_run *run;
    void *context;
    const char *name;
    size_t jobs;
    bool show;
    double started_at, shown_at; /* seconds */
    pthread_mutex_t lock;        /* of what follows */
    size_t begun, done;
};

static double seconds_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double) now.tv_sec + 1e-9 * (double) now.tv_nsec;
}

long workers_usual(void)
{
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count > 0 ? count : 1;
}

/* The time left is guessed from the jobs done, as if all were alike. */
static void show(struct workers *workers)
{
    const double now = seconds_now();
    if (!workers->show || (now - workers->shown_at < 0.2 && workers->done < workers->jobs))
        return;
    workers->shown_at = now;
    const double spent = now - workers->started_at;
    const double left = spent * (double) (workers->jobs - workers->done) / (double) workers->done;
    fprintf(stderr, "\r\033[K%s: %zu of %zu, %.0f s, about %.0f s left", workers->name,
            workers->done, workers->jobs, spent, left);
    fflush(stderr);
}

static void *work(void *context)
{
    struct workers *workers = context;
    pthread_mutex_lock(&workers->lock);
    while (workers->begun < workers->jobs) {
        const size_t job = workers->begun++;
        pthread_mutex_unlock(&workers->lock);
        workers->run(workers->context, job);
        pthread_mutex_lock(&workers->lock);
        workers->done++;
        show(workers);
    }
    pthread_mutex_unlock(&workers->lock);
    return NULL;
}

void workers_do(const char *name, long count, size_t jobs, workers_run *run, void *context)
{
    struct workers workers = {.run = run,
                              .context = context,
                              .name = name,
                              .jobs = jobs,
                              .show = isatty(STDERR_FILENO),
                              .started_at = seconds_now()};
    pthread_t thread[WORKERS_MAX];
    long started = 0;
    pthread_mutex_init(&workers.lock, NULL);
    while (started < count - 1 && started < WORKERS_MAX &&
           pthread_create(&thread[started], NULL, work, &workers) == 0)
        started++;
    work(&workers); /* this thread is one of them */
    for (long i = 0; i < started; i++)
        pthread_join(thread[i], NULL);
    pthread_mutex_destroy(&workers.lock);
    if (workers.show)
        fputs("\r\033[K", stderr);
}
