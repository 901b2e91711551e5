#include "progress.h"

#include "clock.h"
#include "number.h"

#include <stdio.h>
#include <unistd.h>

static const int64_t first_after_ns = 1000000000, every_ns = 200000000;

/* The clock is looked at once in so many steps. */
enum { STEPS = 64 };

static struct progress begin(bool enabled, const char *unit, uint64_t total)
{
    return (struct progress){
        .enabled = enabled, .unit = unit, .total = total, .started_at = clock_ns()};
}

struct progress progress_begin(uint64_t total)
{
    return begin(isatty(STDERR_FILENO) && !isatty(STDOUT_FILENO), "pairs", total);
}

struct progress progress_begin_of(const char *unit, uint64_t total)
{
    return begin(isatty(STDERR_FILENO), unit, total);
}

static void show(struct progress *progress)
{
    char done[NUMBER_TEXT_MAX], total[NUMBER_TEXT_MAX];
    fprintf(stderr, "\rfmb: %s of %s %s", number_grouped((int64_t) progress->done, done),
            number_grouped((int64_t) progress->total, total), progress->unit);
    fflush(stderr);
    progress->shown = true;
}

void progress_to(struct progress *progress, uint64_t done)
{
    progress->done = done;
    if (!progress->enabled || ++progress->steps % STEPS != 0)
        return;
    int64_t time = clock_ns();
    if (time - progress->started_at < first_after_ns || time - progress->shown_at < every_ns)
        return;
    progress->shown_at = time;
    show(progress);
}

void progress_to_of(struct progress *progress, uint64_t done, uint64_t total)
{
    progress->total = total;
    progress_to(progress, done);
}

void progress_step(struct progress *progress)
{
    progress_to(progress, progress->done + 1);
}

void progress_end(struct progress *progress)
{
    if (progress->shown)
        fputs("\r\033[K", stderr);
    progress->shown = false;
}
