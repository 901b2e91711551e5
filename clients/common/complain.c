#include "complain.h"

#include "escape.h"

#include <stdio.h>
#include <string.h>

enum { COMPLAIN_MAX = 8192 }; /* bytes: twice the longest path */

void complain_text(const char *text)
{
    escape(stderr, ESCAPE_TERMINAL, text, strlen(text));
}

void complain(const char *format, ...)
{
    char text[COMPLAIN_MAX];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    for (char *line = text; *line;) {
        char *end = line + strcspn(line, "\n");
        const bool last = !*end;
        *end = '\0';
        fputs("fmb: ", stderr);
        complain_text(line);
        putc('\n', stderr);
        line = end + !last;
    }
}

void complain_as(const char *who, const char *format, va_list list)
{
    char text[COMPLAIN_MAX];
    vsnprintf(text, sizeof text, format, list);
    fprintf(stderr, "%s: ", who);
    complain_text(text);
    putc('\n', stderr);
}
