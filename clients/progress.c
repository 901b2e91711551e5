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

struct progress progress_begin_bytes(uint64_t total)
{
    struct progress progress = progress_begin(total);
    progress.bytes = true;
    return progress;
}

static void show(struct progress *progress)
{
    char done[NUMBER_TEXT_MAX], total[NUMBER_TEXT_MAX];
    if (progress->bytes)
        fprintf(stderr, "\rfmb: %.1f of %.1f MB", 1e-6 * (double) progress->done,
                1e-6 * (double) progress->total);
    else
        fprintf(stderr, "\rfmb: %s of %s pairs", number_grouped((int64_t) progress->done, done),
                number_grouped((int64_t) progress->total, total));
    fflush(stderr);
    progress->shown = true;
}

static void show_if_due(struct progress *progress)
{
    int64_t time = clock_ns();
    if (time - progress->started_at < first_after_ns || time - progress->shown_at < every_ns)
        return;
    progress->shown_at = time;
    show(progress);
}

void progress_step(struct progress *progress)
{
    progress->done++;
    if (progress->enabled && progress->done % STEPS == 0)
        show_if_due(progress);
}

void progress_to(struct progress *progress, uint64_t done)
{
    progress->done = done;
    if (progress->enabled)
        show_if_due(progress);
}

void progress_end(struct progress *progress)
{
    if (progress->shown)
        fputs("\r\033[K", stderr);
    progress->shown = false;
}
