#include "page.h"

#include "allocate.h"
#include "page_event.h"
#include "page_template.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { OUTCOMES = REPLAY_OUTCOMES };

/* A set of queries. */
struct page_span {
    int64_t count[OUTCOMES]; /* [enum replay_outcome] */
    int64_t total;
    int64_t time[2]; /* of the first and the last one, microseconds since 1970 */
};

struct page {
    char *title;                /* owned */
    int64_t begin;              /* of the logs, microseconds since 1970 */
    size_t log_count, capacity; /* paths of the logs, in the order of their first queries */
    char **log;                 /* owned */
    struct page_json events;
    struct page_shapes shapes;
    struct page_span all, left_out; /* all queries, and those left out */
    int64_t kept, kept_further;     /* within the limits, and differences beyond them */
    size_t bytes_within;            /* when the limits were reached */
};

/* ---- Adding ---------------------------------------------------------------------------------- */

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
    page_json_open(&page->events);
    page_shapes_open(&page->shapes);
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
    page_json_close(&page->events);
    page_shapes_close(&page->shapes);
    free(page);
}

/* Logs are read one after the other: the latest is searched first. */
static size_t log_index(struct page *page, const char *path)
{
    for (size_t i = page->log_count; i > 0; i--)
        if (strcmp(page->log[i - 1], path) == 0)
            return i - 1;
    page->log = allocate_grow(page->log, &page->capacity, page->log_count + 1, sizeof *page->log);
    page->log[page->log_count] = copy_text(path);
    return page->log_count++;
}

static void add(struct page_span *span, const struct replayed *replayed)
{
    const bool is_first = span->total++ == 0;
    span->count[replayed->outcome]++;
    if (is_first || replayed->utime < span->time[0])
        span->time[0] = replayed->utime;
    if (is_first || replayed->utime > span->time[1])
        span->time[1] = replayed->utime;
}

static size_t bytes(const struct page *page)
{
    return page->events.used + page->shapes.json.used;
}

/* Whether the next query is within the limits. Once false, it stays false. */
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

static void keep(struct page *page, const struct replayed *replayed)
{
    if (is_within(page))
        page->kept++;
    else
        page->kept_further++;
    page_event_write(replayed, log_index(page, replayed->log), &page->shapes, &page->events.json);
    page_json_flush(&page->events);
    page_json_flush(&page->shapes.json);
    if (page->kept_further == 0)
        page->bytes_within = bytes(page);
}

void page_take(struct page *page, const struct replayed *replayed)
{
    assert((int) replayed->outcome >= 0 && (int) replayed->outcome < OUTCOMES);
    add(&page->all, replayed);
    if (may_keep(page, replayed->outcome))
        keep(page, replayed);
    else
        add(&page->left_out, replayed);
}

/* ---- Writing --------------------------------------------------------------------------------- */

static void write_elements(struct json_writer *json, const char *key,
                           const struct page_json *elements)
{
    json_begin(json, key, '[');
    fwrite(elements->bytes, 1, elements->used, json->out);
    json_end(json, ']');
}

/* Counts in the order of enum replay_outcome. */
static void write_data(const struct page *page, FILE *out)
{
    struct json_writer json = {.out = out, .page = true};
    json_begin(&json, NULL, '{');
    json_string(&json, "title", page->title);
    json_begin(&json, "logs", '[');
    for (size_t i = 0; i < page->log_count; i++)
        json_string(&json, NULL, page->log[i]);
    json_end(&json, ']');
    json_integer(&json, "begin", page->begin);
    json_integers(&json, "count", page->all.count, OUTCOMES);
    json_integers(&json, "span", page->all.time, 2);
    json_integers(&json, "left_out", page->left_out.count, OUTCOMES);
    json_integers(&json, "left_span", page->left_out.time, 2);
    write_elements(&json, "shapes", &page->shapes.json);
    write_elements(&json, "events", &page->events);
    json_end(&json, '}');
}

void page_write(const struct page *page, FILE *out)
{
    page_template_begin(&page_template_replay, out);
    write_data(page, out);
    page_template_end(&page_template_replay, out);
}
