#include "page_template.h"

#include <string.h>

/* PAGE_FILE, of the Makefile, names the page. Its bytes, by the assembler: a compiler would take
 * a minute for an array of a million numbers. */
__asm__(
    ".pushsection .rodata\n"
    "page_template_first: .incbin \"" PAGE_FILE
    "\"\n"
    "page_template_last: .byte 0\n"
    ".popsection\n");
extern const char page_template_first[], page_template_last[];

/* Position of the data in the page. The Makefile checks that it is there once. */
static const char *find_mark(void)
{
    static const char mark[] = "@DATA@";
    return strstr(page_template_first, mark);
}

void page_template_begin(FILE *out)
{
    fwrite(page_template_first, 1, (size_t) (find_mark() - page_template_first), out);
}

void page_template_end(FILE *out)
{
    fputs(find_mark() + strlen("@DATA@\n"), out);
}
