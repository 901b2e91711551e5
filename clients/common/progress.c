#include "progress.h"

#include "clock.h"
#include "number.h"

#include <stdio.h>
#include <unistd.h>

static const int64_t first_after_ns = 1000000000, every_ns = 200000000;

/* Calls of progress_to() for each reading of the clock. */
enum { STEPS = 64 };

struct progress progress_begin(const char *unit, int64_t total)
{
    return (struct progress){
        .enabled = isatty(STDERR_FILENO), .unit = unit, .total = total, .started_at = clock_ns()};
}

void progress_to(void *of, int64_t done, int64_t total)
{
    struct progress *progress = of;
    char done_text[NUMBER_TEXT_MAX], total_text[NUMBER_TEXT_MAX];
    progress->done = done;
    progress->total = total;
    if (!progress->enabled || ++progress->steps % STEPS != 0)
        return;
    int64_t time = clock_ns();
    if (time - progress->started_at < first_after_ns || time - progress->shown_at < every_ns)
        return;
    progress->shown_at = time;
    progress->shown = true;
    fprintf(stderr, "\rfmb: %s of %s %s", number_grouped(done, done_text),
            number_grouped(total, total_text), progress->unit);
    fflush(stderr);
}

void progress_end(struct progress *progress)
{
    if (progress->shown)
        fputs("\r\033[K", stderr);
    progress->shown = false;
}
