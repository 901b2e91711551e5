#include "page_template.h"

#include <string.h>

/* Position of the data in the page. */
static const char mark[] = "@DATA@";
enum { MARK_LENGTH = sizeof mark - 1 };

/* The Makefile checks that the page contains the mark once. */
static size_t find_mark(const struct page_template *page)
{
    size_t at = 0;
    while (at + MARK_LENGTH < page->size && memcmp(page->bytes + at, mark, MARK_LENGTH) != 0)
        at++;
    return at;
}

void page_template_begin(const struct page_template *page, FILE *out)
{
    fwrite(page->bytes, 1, find_mark(page), out);
}

void page_template_end(const struct page_template *page, FILE *out)
{
    const size_t after = find_mark(page) + MARK_LENGTH;
    fwrite(page->bytes + after, 1, page->size - after, out);
}
