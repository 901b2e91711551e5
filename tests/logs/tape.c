#include "tape.h"

#include <lcm/lcm.h>
#include <stdlib.h>
#include <string.h>

enum { CHANNEL_MAX = 64, FILE_BUFFER = 1 << 20 };

struct event {
    int64_t utime;
    size_t place; /* in the order in which they were put */
    char channel[CHANNEL_MAX];
    size_t size;
    unsigned char *bytes; /* owned */
};

struct tape {
    lcm_eventlog_t *log;
    enum tape_order order;
    int64_t utime;
    struct event *event; /* [count], that are not yet written */
    size_t count, capacity;
    size_t put; /* events so far, dropped ones too */
    bool failed;
};

struct tape *tape_open(const char *path, enum tape_order order)
{
    struct tape *tape = calloc(1, sizeof *tape);
    if (!tape)
        return NULL;
    tape->log = lcm_eventlog_create(path, "w");
    if (!tape->log) {
        free(tape);
        return NULL;
    }
    setvbuf(tape->log->f, NULL, _IOFBF, FILE_BUFFER);
    tape->order = order;
    tape->utime = TAPE_BEGIN_UTIME;
    return tape;
}

int64_t tape_utime(const struct tape *tape)
{
    return tape->utime;
}

void tape_pass(struct tape *tape, int64_t us)
{
    tape->utime += us;
}

/* LCM's own function numbers the events, from 0. */
static void write_event(struct tape *tape, int64_t utime, const char *channel, const void *bytes,
                        size_t size)
{
    lcm_eventlog_event_t event = {.timestamp = utime,
                                  .channellen = (int32_t) strlen(channel),
                                  .datalen = (int32_t) size,
                                  .channel = (char *) channel,
                                  .data = (void *) bytes};
    if (lcm_eventlog_write_event(tape->log, &event) != 0)
        tape->failed = true;
}

static bool make_room(struct tape *tape)
{
    if (tape->count < tape->capacity)
        return true;
    const size_t capacity = tape->capacity ? 2 * tape->capacity : 64;
    struct event *event = realloc(tape->event, capacity * sizeof *event);
    if (!event)
        return false;
    tape->event = event;
    tape->capacity = capacity;
    return true;
}

static bool keep_event(struct tape *tape, int64_t utime, const char *channel,
                       const unsigned char *bytes, size_t size)
{
    unsigned char *copy = make_room(tape) ? malloc(size + 1) : NULL; /* + 1: of none too */
    if (!copy || strlen(channel) >= CHANNEL_MAX) {
        free(copy);
        return false;
    }
    struct event *event = &tape->event[tape->count];
    *event = (struct event){.utime = utime, .place = tape->put++, .size = size, .bytes = copy};
    strcpy(event->channel, channel);
    memcpy(copy, bytes, size);
    tape->count++;
    return true;
}

void tape_put(struct tape *tape, int64_t utime, const char *channel, const unsigned char *bytes,
              size_t size)
{
    if (tape->order == TAPE_AS_PUT)
        write_event(tape, utime, channel, bytes, size);
    else if (!keep_event(tape, utime, channel, bytes, size))
        tape->failed = true;
}

/* No two are equal. */
static int compare_events(const void *one, const void *other)
{
    const struct event *a = one, *b = other;
    if (a->utime != b->utime)
        return a->utime < b->utime ? -1 : 1;
    return a->place < b->place ? -1 : 1;
}

bool tape_close(struct tape *tape)
{
    if (tape->count > 0)
        qsort(tape->event, tape->count, sizeof *tape->event, compare_events);
    for (size_t i = 0; i < tape->count; i++) {
        const struct event *event = &tape->event[i];
        write_event(tape, event->utime, event->channel, event->bytes, event->size);
        free(event->bytes);
    }
    const bool good = fflush(tape->log->f) == 0 && !ferror(tape->log->f) && !tape->failed;
    lcm_eventlog_destroy(tape->log);
    free(tape->event);
    free(tape);
    return good;
}
