#include "complain.h"

#include "escape.h"

#include <errno.h>
#include <string.h>

enum { COMPLAIN_MAX = 8192 }; /* bytes: twice the longest path */

void complain_text(const char *text)
{
    escape(stderr, ESCAPE_TERMINAL, text, strlen(text));
}

static void print_line(const char *who, const char *line)
{
    fprintf(stderr, "%s: ", who);
    complain_text(line);
    putc('\n', stderr);
}

void complain(const char *format, ...)
{
    char text[COMPLAIN_MAX];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n"))
        print_line("fmb", line);
}

void complain_as(const char *command, const char *format, va_list list)
{
    char text[COMPLAIN_MAX];
    vsnprintf(text, sizeof text, format, list);
    fputs("fmb ", stderr);
    print_line(command, text);
}

void complain_at(const char *place, const char *format, va_list list)
{
    char text[COMPLAIN_MAX];
    const int length = snprintf(text, sizeof text, "%s: ", place);
    if (length >= 0 && (size_t) length < sizeof text)
        vsnprintf(text + length, sizeof text - (size_t) length, format, list);
    for (char *at = text; (at = strchr(at, '\n'));)
        *at = ' ';
    print_line("fmb", text);
}

bool output_flush(void)
{
    if (fflush(stdout) == 0 && !ferror(stdout))
        return true;
    complain("standard output: %s", strerror(errno));
    return false;
}
