#include "complain.h"

#include "escape.h"
#include "progress.h"

#include <errno.h>
#include <string.h>

enum { COMPLAIN_MAX = 8192 }; /* bytes: twice the longest path */

static void print_line(const char *who, const char *place, const char *format, va_list list)
{
    char text[COMPLAIN_MAX];
    vsnprintf(text, sizeof text, format, list);
    progress_clear();
    fputs(who, stderr);
    escape_text(stderr, place);
    fputs(": ", stderr);
    escape_text(stderr, text);
    putc('\n', stderr);
}

void complain(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    print_line("fmb", "", format, list);
    va_end(list);
}

void complain_as(const char *command, const char *format, va_list list)
{
    print_line("fmb ", command, format, list);
}

void complain_at(const char *place, const char *format, va_list list)
{
    print_line("fmb: ", place, format, list);
}

bool output_flush(void)
{
    if (fflush(stdout) == 0 && !ferror(stdout))
        return true;
    complain("standard output: %s", strerror(errno));
    return false;
}
