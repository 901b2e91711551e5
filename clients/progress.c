#include "progress.h"

#include "number.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

static const double first_after_s = 1, every_s = 0.2;

/* The clock is looked at once in so many steps. */
enum { STEPS = 64 };

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double) time.tv_sec + 1e-9 * (double) time.tv_nsec;
}

struct progress progress_begin(uint64_t total)
{
    bool enabled = isatty(STDERR_FILENO) && !isatty(STDOUT_FILENO);
    return (struct progress){.enabled = enabled, .total = total, .started_at = now()};
}

static void show(struct progress *progress)
{
    char done[NUMBER_TEXT_MAX], total[NUMBER_TEXT_MAX];
    fprintf(stderr, "\rfmb: %s of %s pairs", number_grouped((int64_t) progress->done, done),
            number_grouped((int64_t) progress->total, total));
    fflush(stderr);
    progress->shown = true;
}

void progress_step(struct progress *progress)
{
    progress->done++;
    if (!progress->enabled || progress->done % STEPS != 0)
        return;
    double time = now();
    if (time - progress->started_at < first_after_s || time - progress->shown_at < every_s)
        return;
    progress->shown_at = time;
    show(progress);
}

void progress_end(struct progress *progress)
{
    if (progress->shown)
        fputs("\r\033[K", stderr);
    progress->shown = false;
}
