#include "page_json.h"

#include "allocate.h"

#include <stdlib.h>
#include <string.h>

void page_json_flush(struct page_json *page)
{
    if (fflush(page->json.out) != 0 || ferror(page->json.out))
        allocate_failed();
}

void page_json_open(struct page_json *out)
{
    memset(out, 0, sizeof *out);
    FILE *stream = open_memstream(&out->bytes, &out->used);
    if (!stream)
        allocate_failed();
    out->json = (struct json_writer){.out = stream, .page = true};
    page_json_flush(out); /* so that bytes is not NULL */
}

void page_json_close(struct page_json *page)
{
    fclose(page->json.out);
    free(page->bytes);
    memset(page, 0, sizeof *page);
}

void page_json_write(const struct page_json *page, FILE *out)
{
    fwrite(page->bytes, 1, page->used, out);
}
