#include "record_line.h"

#include "number.h"
#include "say.h"

#include <inttypes.h>
#include <stdio.h>
#include <sys/ioctl.h>
#include <unistd.h>

static const int64_t every_ns = 250000000;

enum { LINE_MAX_CHARACTERS = 512, USUAL_WIDTH = 80 };

struct record_line record_line_begin(int64_t now_ns)
{
    return (struct record_line){.enabled = isatty(STDERR_FILENO), .at_ns = now_ns};
}

static int terminal_width(void)
{
    struct winsize size;
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col
                                                                           : USUAL_WIDTH;
}

/* Cut where the terminal ends: a line that goes on in the next row could not be replaced. */
static void show(const char *text)
{
    fprintf(stderr, "\r%.*s\033[K", terminal_width() - 1, text);
    fflush(stderr);
}

void record_line_show(struct record_line *line, int64_t now_ns, const char *path, int64_t events,
                      int64_t bytes, int64_t lost)
{
    const int64_t passed = now_ns - line->at_ns;
    if (!line->enabled || passed < every_ns || !say_now())
        return;
    char text[LINE_MAX_CHARACTERS], number[4][NUMBER_TEXT_MAX];
    const double seconds = 1e-9 * (double) passed;
    snprintf(text, sizeof text, "fmb: %s messages, %s/s, %.2f MB/s, %s lost, %s MB: %s",
             number_grouped(events, number[0]),
             number_grouped((int64_t) ((double) (events - line->events) / seconds), number[1]),
             1e-6 * (double) (bytes - line->bytes) / seconds, number_grouped(lost, number[2]),
             number_grouped(bytes / 1000000, number[3]), path);
    show(text);
    *line = (struct record_line){true, true, now_ns, events, bytes};
}

void record_line_end(struct record_line *line)
{
    if (line->shown)
        fputs("\r\033[K", stderr);
    line->shown = false;
}
