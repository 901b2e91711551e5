#include "progress.h"

#include "clock.h"
#include "number.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <unistd.h>

static const int64_t first_after_ns = 1000000000, every_ns = 200000000;

/* Calls of progress_to() for each reading of the clock. */
enum { STEPS = 64 };

/* If false, no variable here is written, so that threads may call the functions. */
static bool allowed;

static struct {
    const char *unit; /* NULL: there is no count, or no terminal */
    unsigned steps;
    int64_t next_at; /* when the line is shown; clock_ns() */
    bool shown;      /* the line has text on it */
} line;

void progress_allow(void)
{
    allowed = true;
}

void progress_begin(const char *unit)
{
    if (!allowed)
        return;
    line.unit = isatty(STDERR_FILENO) ? unit : NULL;
    line.next_at = clock_ns() + first_after_ns;
}

void progress_show(const char *format, ...)
{
    va_list list;
    if (!line.unit)
        return;
    line.shown = true;
    fputs("\rfmb: ", stderr);
    va_start(list, format);
    vfprintf(stderr, format, list);
    va_end(list);
    fputs("\033[K", stderr);
    fflush(stderr);
}

void progress_to(int64_t done, int64_t total)
{
    char done_text[NUMBER_TEXT_MAX], total_text[NUMBER_TEXT_MAX];
    if (!line.unit || ++line.steps % STEPS != 0 || clock_ns() < line.next_at)
        return;
    line.next_at = clock_ns() + every_ns;
    progress_show("%s of %s %s", number_grouped(done, done_text), number_grouped(total, total_text),
                  line.unit);
}

void progress_clear(void)
{
    if (!line.shown)
        return;
    fputs("\r\033[K", stderr);
    line.shown = false;
}

void progress_end(void)
{
    progress_clear();
    if (allowed)
        line.unit = NULL;
}
