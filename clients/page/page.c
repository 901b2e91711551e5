#include "page.h"

#include "allocate.h"
#include "page_event.h"
#include "page_template.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { OUTCOMES = REPLAY_ALONE + 1 };

struct page {
    char *title;            /* owned */
    int64_t begin;          /* of the logs, microseconds since 1970 */
    size_t log_count, room; /* paths of the logs, in the order of their first queries */
    char **log;             /* owned */
    struct page_json events;
    struct page_shapes shapes;
    int64_t count[OUTCOMES];    /* of all queries */
    int64_t first, last;        /* microseconds since 1970; of all queries */
    int64_t kept, kept_further; /* within the limits, and differences beyond them */
    size_t bytes_within;        /* when the limits were reached */
    int64_t left_out[OUTCOMES];
    int64_t left_first, left_last; /* as first and last, of those left out */
};

/* ---- Taking in ------------------------------------------------------------------------------- */

static char *copy_text(const char *text)
{
    const size_t size = strlen(text) + 1;
    return memcpy(allocate(size, 1), text, size);
}

struct page *page_open(const char *title, int64_t begin)
{
    struct page *page = allocate(1, sizeof *page);
    page->title = copy_text(title);
    page->begin = begin;
    return page;
}

void page_close(struct page *page)
{
    if (!page)
        return;
    for (size_t i = 0; i < page->log_count; i++)
        free(page->log[i]);
    free(page->log);
    free(page->title);
    page_json_clear(&page->events);
    page_shapes_clear(&page->shapes);
    free(page);
}

/* One log is read after the other: the last one is found first. */
static size_t log_index(struct page *page, const char *path)
{
    for (size_t i = page->log_count; i > 0; i--)
        if (strcmp(page->log[i - 1], path) == 0)
            return i - 1;
    page->log = allocate_room(page->log, &page->room, page->log_count + 1, sizeof *page->log);
    page->log[page->log_count] = copy_text(path);
    return page->log_count++;
}

static int64_t total(const int64_t count[OUTCOMES])
{
    int64_t sum = 0;
    for (int i = 0; i < OUTCOMES; i++)
        sum += count[i];
    return sum;
}

static void stretch(int64_t *first, int64_t *last, int64_t utime, bool is_first)
{
    *first = is_first || utime < *first ? utime : *first;
    *last = is_first || utime > *last ? utime : *last;
}

static size_t bytes(const struct page *page)
{
    return page->events.used + page->shapes.json.used;
}

/* Once it is not, it stays so. */
static bool is_within(const struct page *page)
{
    return page->kept < PAGE_EVENTS_MAX && bytes(page) < PAGE_BYTES_MAX;
}

static bool may_keep(const struct page *page, enum replay_outcome outcome)
{
    return is_within(page) ||
           (outcome == REPLAY_DIFFERENT && page->kept_further < PAGE_DIFFERENCES_MAX &&
            bytes(page) - page->bytes_within < PAGE_DIFFERENCES_BYTES_MAX);
}

static void leave_out(struct page *page, const struct replayed *replayed)
{
    stretch(&page->left_first, &page->left_last, replayed->utime, total(page->left_out) == 0);
    page->left_out[replayed->outcome]++;
}

static void keep(struct page *page, const struct replayed *replayed)
{
    if (is_within(page))
        page->kept++;
    else
        page->kept_further++;
    page_event_write(replayed, log_index(page, replayed->log), &page->shapes, &page->events);
    if (page->kept_further == 0)
        page->bytes_within = bytes(page);
}

void page_take(struct page *page, const struct replayed *replayed)
{
    assert((int) replayed->outcome >= 0 && (int) replayed->outcome < OUTCOMES);
    stretch(&page->first, &page->last, replayed->utime, total(page->count) == 0);
    page->count[replayed->outcome]++;
    if (may_keep(page, replayed->outcome))
        keep(page, replayed);
    else
        leave_out(page, replayed);
}

/* ---- Writing --------------------------------------------------------------------------------- */

static void add_counts(struct page_json *json, const char *name, const int64_t count[OUTCOMES])
{
    page_json_raw(json, name);
    for (int i = 0; i < OUTCOMES; i++) {
        page_json_raw(json, i ? "," : "[");
        page_json_integer(json, count[i]);
    }
    page_json_raw(json, "]");
}

static void add_span(struct page_json *json, const char *name, int64_t first, int64_t last)
{
    page_json_raw(json, name);
    page_json_integer(json, first);
    page_json_raw(json, ",");
    page_json_integer(json, last);
    page_json_raw(json, "]");
}

/* What there is to say of the whole: counts in the order of enum replay_outcome. */
static struct page_json make_head(const struct page *page)
{
    struct page_json json = {0};
    page_json_raw(&json, "{\"title\":");
    page_json_string(&json, page->title);
    page_json_raw(&json, ",\"logs\":[");
    for (size_t i = 0; i < page->log_count; i++) {
        page_json_raw(&json, i ? "," : "");
        page_json_string(&json, page->log[i]);
    }
    page_json_raw(&json, "],\n\"begin\":");
    page_json_integer(&json, page->begin);
    add_counts(&json, ",\n\"count\":", page->count);
    add_span(&json, ",\"span\":[", page->first, page->last);
    add_counts(&json, ",\n\"left_out\":", page->left_out);
    add_span(&json, ",\"left_span\":[", page->left_first, page->left_last);
    page_json_raw(&json, ",\n\"shapes\":[\n");
    return json;
}

static void write_data(const struct page *page, FILE *out)
{
    struct page_json head = make_head(page);
    fwrite(head.bytes, 1, head.used, out);
    page_json_clear(&head);
    if (page->shapes.json.used > 0)
        fwrite(page->shapes.json.bytes, 1, page->shapes.json.used, out);
    fputs("\n],\n\"events\":[\n", out);
    if (page->events.used > 0)
        fwrite(page->events.bytes, 1, page->events.used, out);
    fputs("\n]}", out);
}

void page_write(const struct page *page, FILE *out)
{
    page_template_begin(&page_template_replay, out);
    write_data(page, out);
    page_template_end(&page_template_replay, out);
}
