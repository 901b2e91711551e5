#include "complain.h"

#include <stdio.h>
#include <string.h>

void complain(const char *text)
{
    while (*text) {
        const int length = (int) strcspn(text, "\n");
        fprintf(stderr, "fmb: %.*s\n", length, text);
        text += length + (text[length] == '\n');
    }
}
