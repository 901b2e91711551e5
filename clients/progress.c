#include "progress.h"

#include "clock.h"
#include "number.h"

#include <stdio.h>
#include <unistd.h>

static const int64_t first_after_ns = 1000000000, every_ns = 200000000;

/* The clock is looked at once in so many steps. */
enum { STEPS = 64 };

struct progress progress_begin(uint64_t total)
{
    bool enabled = isatty(STDERR_FILENO) && !isatty(STDOUT_FILENO);
    return (struct progress){.enabled = enabled, .total = total, .started_at = clock_ns()};
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
    int64_t time = clock_ns();
    if (time - progress->started_at < first_after_ns || time - progress->shown_at < every_ns)
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
