#include "log_spool.h"

#include <assert.h>
#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* How long an event waits at most before it is written, while the disk does not stall. To wake the
 * thread for each would cost the receiver more than the event itself; to let more of them gather
 * would push them out of the processor's caches. */
static const long turn_ns = 10000000;

/* Written in one go before the system is given all of it and the state is brought up to date. */
enum { FLUSH_BYTES = 4 << 20 };

/* What waits in a half, each on a multiple of 8 bytes; channel and data stand behind it. */
struct entry {
    int64_t utime;
    uint32_t size, channel_length;
};

struct half {
    unsigned char *bytes;
    size_t used;
};

struct log_spool {
    struct log_parts *parts; /* of the thread alone */
    size_t room;             /* of each half */
    pthread_t thread;
    pthread_mutex_t lock; /* for all below; the half that is written is the thread's alone */
    pthread_cond_t wake;
    struct half half[2];
    int filling; /* which half */
    bool closing;
    struct log_spool_state state;
};

/* ---- The thread ------------------------------------------------------------------------------ */

static struct timespec in_a_turn(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    time.tv_nsec += turn_ns;
    if (time.tv_nsec >= 1000000000) {
        time.tv_sec++;
        time.tv_nsec -= 1000000000;
    }
    return time;
}

static bool is_nearly_full(const struct log_spool *spool)
{
    return spool->half[spool->filling].used > spool->room / 4;
}

/* Until a turn is over since something came, or it is time before; takes the half that was filled.
 * Returns whether it is the last. */
static bool next_half(struct log_spool *spool, struct half **out)
{
    pthread_mutex_lock(&spool->lock);
    while (!spool->closing && spool->half[spool->filling].used == 0)
        pthread_cond_wait(&spool->wake, &spool->lock);
    const struct timespec end = in_a_turn();
    while (!spool->closing && !is_nearly_full(spool) &&
           pthread_cond_timedwait(&spool->wake, &spool->lock, &end) != ETIMEDOUT)
        continue;
    *out = &spool->half[spool->filling];
    spool->filling = !spool->filling;
    const bool last = spool->closing;
    pthread_mutex_unlock(&spool->lock);
    return last;
}

/* Brings the state up to date: so many events more are in the files. */
static void add_events(struct log_spool *spool, int64_t events, int64_t bytes, int error)
{
    pthread_mutex_lock(&spool->lock);
    spool->state.events += events;
    spool->state.bytes += bytes;
    spool->state.part = spool->parts->number;
    spool->state.error = error;
    pthread_mutex_unlock(&spool->lock);
}

static size_t entry_bytes(size_t channel_length, size_t size)
{
    return (sizeof(struct entry) + channel_length + size + 7) / 8 * 8;
}

static bool append(struct log_parts *parts, const struct entry *entry)
{
    const char *channel = (const char *) (entry + 1);
    return log_parts_append(parts, entry->utime, channel, entry->channel_length,
                            channel + entry->channel_length, entry->size);
}

/* Appends entries from at on, and has the system take them. Returns where it stopped; *error: 0 or
 * errno. */
static size_t write_some(struct log_parts *parts, const struct half *half, size_t at, int *error)
{
    const size_t begin = at;
    *error = 0;
    while (at < half->used && at - begin < FLUSH_BYTES && !*error) {
        const struct entry *entry = (const struct entry *) (half->bytes + at);
        if (append(parts, entry))
            at += entry_bytes(entry->channel_length, entry->size);
        else
            *error = errno;
    }
    if (!*error && !log_parts_flush(parts))
        *error = errno;
    return at;
}

/* Counts the entries from one place to another that are whole in what the files have more than
 * before. */
static void count_written(struct log_spool *spool, const struct half *half, size_t at, size_t end,
                          int error)
{
    const int64_t more = log_parts_written(spool->parts) - spool->state.bytes;
    int64_t events = 0, bytes = 0;
    while (at < end) {
        const struct entry *entry = (const struct entry *) (half->bytes + at);
        bytes += log_event_bytes(entry->channel_length, entry->size);
        if (bytes > more)
            break;
        events++;
        at += entry_bytes(entry->channel_length, entry->size);
    }
    add_events(spool, events, more, error);
}

/* On output: 0 or errno. */
static int write_half(struct log_spool *spool, const struct half *half)
{
    int error = 0;
    for (size_t at = 0; at < half->used && !error;) {
        const size_t end = write_some(spool->parts, half, at, &error);
        count_written(spool, half, at, end, error);
        at = end;
    }
    return error;
}

/* After an error it goes on taking what comes, and forgets it. */
static void *run(void *user)
{
    struct log_spool *spool = user;
    int error = 0;
    for (bool last = false; !last;) {
        struct half *half;
        last = next_half(spool, &half);
        if (!error)
            error = write_half(spool, half);
        half->used = 0;
    }
    return NULL;
}

/* ---- From outside ---------------------------------------------------------------------------- */

static void destroy(struct log_spool *spool)
{
    free(spool->half[0].bytes);
    free(spool->half[1].bytes);
    free(spool);
}

static int start_thread(struct log_spool *spool)
{
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_mutex_init(&spool->lock, NULL);
    pthread_cond_init(&spool->wake, &attributes);
    pthread_condattr_destroy(&attributes);
    return pthread_create(&spool->thread, NULL, run, spool);
}

struct log_spool *log_spool_start(struct log_parts *parts, size_t half)
{
    struct log_spool *spool = calloc(1, sizeof *spool);
    if (!spool)
        return NULL;
    spool->parts = parts;
    spool->room = half;
    spool->half[0].bytes = malloc(half);
    spool->half[1].bytes = malloc(half);
    int error = ENOMEM;
    if (spool->half[0].bytes && spool->half[1].bytes && (error = start_thread(spool)) == 0)
        return spool;
    destroy(spool);
    errno = error;
    return NULL;
}

static void fill(struct half *half, const struct entry *entry, const char *channel,
                 const void *data)
{
    unsigned char *at = half->bytes + half->used;
    memcpy(at, entry, sizeof *entry);
    memcpy(at + sizeof *entry, channel, entry->channel_length);
    if (entry->size > 0)
        memcpy(at + sizeof *entry + entry->channel_length, data, entry->size);
    half->used += entry_bytes(entry->channel_length, entry->size);
}

bool log_spool_put(struct log_spool *spool, int64_t utime, const char *channel,
                   size_t channel_length, const void *data, size_t size)
{
    const struct entry entry = {utime, (uint32_t) size, (uint32_t) channel_length};
    assert(size <= INT32_MAX);
    pthread_mutex_lock(&spool->lock);
    struct half *half = &spool->half[spool->filling];
    const bool was_empty = half->used == 0, was_nearly_full = is_nearly_full(spool);
    const bool ok =
        !spool->state.error && entry_bytes(channel_length, size) <= spool->room - half->used;
    if (ok)
        fill(half, &entry, channel, data);
    if (was_empty || (!was_nearly_full && is_nearly_full(spool)))
        pthread_cond_signal(&spool->wake);
    pthread_mutex_unlock(&spool->lock);
    return ok;
}

struct log_spool_state log_spool_state(struct log_spool *spool)
{
    pthread_mutex_lock(&spool->lock);
    const struct log_spool_state state = spool->state;
    pthread_mutex_unlock(&spool->lock);
    return state;
}

struct log_spool_state log_spool_finish(struct log_spool *spool)
{
    pthread_mutex_lock(&spool->lock);
    spool->closing = true;
    pthread_cond_signal(&spool->wake);
    pthread_mutex_unlock(&spool->lock);
    pthread_join(spool->thread, NULL);
    const int error = log_parts_finish(spool->parts);
    struct log_spool_state state = spool->state;
    if (!state.error)
        state.error = error;
    pthread_cond_destroy(&spool->wake);
    pthread_mutex_destroy(&spool->lock);
    destroy(spool);
    return state;
}
