/* Which bytes are an event. A candidate is a position with a sync word and a complete header whose
 * lengths are valid and end within the file. A candidate is accepted if the file ends where it
 * ends, or another sync word begins there (at the end of the file, as much of a sync word as fits).
 * Random bytes pass this test once in 2^32 times. Otherwise a candidate is accepted if no other
 * candidate lies inside it: its lengths may then be right, and the bytes after it are damaged. If
 * another candidate lies inside it, its lengths are wrong and would skip good data.
 *
 * Order. `at` is the end of the last reported item. The next item is the event at `at`, if it is
 * accepted; otherwise damage up to the next accepted candidate or the end of the file. `at` then
 * advances to the end of the item. So each byte is in exactly one event or damage.
 *
 * Loss. An intact event is reported, with two exceptions: it lies inside another one that ends at a
 * sync word or at the end of the file; or a candidate lies inside it and the sync word after it is
 * damaged. Both depend on positions only, not on the way the reader got there. So seeking finds the
 * same events as reading.
 *
 * Time. Only the search for the next candidate examines bytes one by one. Its result is cached, and
 * holds for all positions from its start to the candidate; the next search begins after the
 * candidate. So each byte is examined once. A candidate costs 28 bytes at its position and 4 at its
 * end, whatever its lengths.
 *
 * Reading. The file is read by whole buffers, from a requested position on; only the 4 bytes after
 * an event are read separately if they are not in the buffer. Reading forward, the buffer is
 * refilled when fewer than 28 bytes are left in it during a search, or less than the kept bytes of
 * an event (67 kB of 256 kB), so most of each refill is new. A search may run past an event that is
 * still to be reported, for which the buffer is refilled. But of two consecutive searches that do
 * so, the second ends a buffer after the beginning of the first. So the total number of bytes read
 * is a small multiple of the file size, for hostile files too.
 *
 * Holes of sparse files contain no sync word, and searches skip them.
 *
 * Changes. Another program may change the file while it is read. So lengths are never read from the
 * file again after they were checked. */
#define _GNU_SOURCE /* SEEK_DATA */
#define _FILE_OFFSET_BITS 64
#include "log_read.h"

#include "big_endian.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Reading is as fast with 128 KiB to 1 MiB. */
#ifndef LOG_BUFFER_BYTES
#define LOG_BUFFER_BYTES (256 * 1024)
#endif

enum { SYNC_BYTES = 4, KEPT_MAX = LOG_HEADER_BYTES + LOG_CHANNEL_MAX + LOG_DATA_MAX };

_Static_assert(LOG_BUFFER_BYTES > KEPT_MAX, "an event stands in the buffer as one");

static const unsigned char sync_word[SYNC_BYTES] = {0xed, 0xa1, 0xda, 0x01};

struct log_reader {
    int fd;
    int error; /* errno of the failed read; 0: none */
    int64_t size;
    int64_t at;  /* position of the next event or damage */
    bool sought; /* after log_seek(): damage before the next event is not reported */
    /* There is no candidate from none_begin up to, not including, none_end. none_end is a candidate
     * or the end of the file. */
    int64_t none_begin, none_end;
    int64_t begin; /* position of the buffer in the file */
    size_t used;
    char channel[LOG_CHANNEL_MAX];
    unsigned char bytes[LOG_BUFFER_BYTES];
};

/* ---- Bytes of the file ----------------------------------------------------------------------- */

static inline int64_t least(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/* Reads count bytes, which are in the file unless it was truncated. Returns false on error. */
static bool read_at(struct log_reader *reader, int64_t offset, unsigned char *out, size_t count)
{
    while (count > 0) {
        ssize_t got = pread(reader->fd, out, count, (off_t) offset);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0) {
            reader->error = got < 0 ? errno : ENODATA;
            return false;
        }
        out += got;
        offset += got;
        count -= (size_t) got;
    }
    return true;
}

static inline bool is_buffered(const struct log_reader *reader, int64_t offset, size_t count)
{
    return offset >= reader->begin && count <= reader->used &&
           offset - reader->begin <= (int64_t) (reader->used - count);
}

static inline const unsigned char *buffered(const struct log_reader *reader, int64_t offset)
{
    return reader->bytes + (offset - reader->begin);
}

static bool fill(struct log_reader *reader, int64_t offset)
{
    const size_t count = (size_t) least(LOG_BUFFER_BYTES, reader->size - offset);
    reader->begin = offset;
    reader->used = 0;
    if (!read_at(reader, offset, reader->bytes, count))
        return false;
    reader->used = count;
    return true;
}

/* Makes bytes of the file available in the buffer. In: at most LOG_BUFFER_BYTES. Returns false on
 * error. */
static bool buffer(struct log_reader *reader, int64_t offset, size_t count)
{
    return is_buffered(reader, offset, count) || fill(reader, offset);
}

/* ---- Candidates ------------------------------------------------------------------------------ */

struct lengths {
    uint32_t channel, data;
};

static inline struct lengths lengths_at(const unsigned char *header)
{
    return (struct lengths){big_endian_32(header + 20), big_endian_32(header + 24)};
}

/* As unsigned numbers, negative lengths exceed the limits. */
static inline bool lengths_are_valid(struct lengths lengths)
{
    return lengths.channel - 1 < LOG_CHANNEL_MAX - 1 && lengths.data <= INT32_MAX;
}

static inline int64_t whole_length(struct lengths lengths)
{
    return LOG_HEADER_BYTES + (int64_t) lengths.channel + (int64_t) lengths.data;
}

static inline size_t kept_data(struct lengths lengths)
{
    return lengths.data < LOG_DATA_MAX ? lengths.data : LOG_DATA_MAX;
}

static inline bool is_sync(const unsigned char *bytes)
{
    return memcmp(bytes, sync_word, SYNC_BYTES) == 0;
}

/* In: the offset of a complete header in the buffer. Out: *out: its lengths. */
static bool is_candidate(const struct log_reader *reader, int64_t offset, struct lengths *out)
{
    const unsigned char *header = buffered(reader, offset);
    *out = lengths_at(header);
    return is_sync(header) && lengths_are_valid(*out) &&
           whole_length(*out) <= reader->size - offset;
}

/* Whether the file ends at the offset, or a sync word, or the beginning of one, is there. */
static bool is_followed(struct log_reader *reader, int64_t end)
{
    unsigned char bytes[SYNC_BYTES];
    const size_t count = (size_t) least(SYNC_BYTES, reader->size - end);
    if (is_buffered(reader, end, SYNC_BYTES))
        return is_sync(buffered(reader, end));
    return read_at(reader, end, bytes, count) && memcmp(bytes, sync_word, count) == 0;
}

/* ---- Searches. After an error they end at once, without a result ----------------------------- */

/* Returns the first position from offset on that is not in a hole, but at most last. The caller
 * reads there in any case, which detects truncation. */
static int64_t skip_hole(const struct log_reader *reader, int64_t offset, int64_t last)
{
    const off_t data = lseek(reader->fd, (off_t) offset, SEEK_DATA);
    if (data >= 0)
        return least(data, last);
    return errno == ENXIO ? last : offset; /* ENXIO: only a hole follows; else: unknown */
}

/* The first sync word that begins before end, or end. In: at least SYNC_BYTES - 1 bytes after end
 * are readable. */
static const unsigned char *find_sync(const unsigned char *bytes, const unsigned char *end)
{
    while (bytes < end && (bytes = memchr(bytes, sync_word[0], (size_t) (end - bytes)))) {
        if (is_sync(bytes))
            return bytes;
        bytes++;
    }
    return end;
}

/* The first candidate at or after the offset, or the size of the file. */
static int64_t find_candidate(struct log_reader *reader, int64_t offset)
{
    const int64_t last = reader->size - LOG_HEADER_BYTES;
    struct lengths lengths;
    while (offset <= last) {
        if (!is_buffered(reader, offset, LOG_HEADER_BYTES)) {
            offset = skip_hole(reader, offset, last);
            if (!fill(reader, offset))
                break;
        }
        const unsigned char *bytes = buffered(reader, offset);
        const unsigned char *end = reader->bytes + reader->used - LOG_HEADER_BYTES + 1;
        const unsigned char *sync = find_sync(bytes, end);
        offset += sync - bytes;
        if (sync < end && is_candidate(reader, offset, &lengths))
            return offset;
        offset += sync < end;
    }
    return reader->size;
}

/* The first candidate after the offset, or the size of the file. Cached. */
static int64_t next_candidate(struct log_reader *reader, int64_t offset)
{
    const int64_t from = offset + 1;
    if (from < reader->none_begin || from > reader->none_end) {
        reader->none_end = find_candidate(reader, from);
        reader->none_begin = from;
    }
    return reader->none_end;
}

/* On output: *out: the lengths of the candidate, if it is accepted. */
static bool is_accepted(struct log_reader *reader, int64_t offset, struct lengths *out)
{
    if (reader->size - offset < LOG_HEADER_BYTES || !buffer(reader, offset, LOG_HEADER_BYTES) ||
        !is_candidate(reader, offset, out))
        return false;
    const int64_t end = offset + whole_length(*out);
    return is_followed(reader, end) || (!reader->error && end <= next_candidate(reader, offset));
}

/* The first accepted candidate after the offset, or the size of the file. */
static int64_t next_accepted(struct log_reader *reader, int64_t offset)
{
    struct lengths lengths;
    do
        offset = next_candidate(reader, offset);
    while (offset < reader->size && !is_accepted(reader, offset, &lengths) && !reader->error);
    return offset;
}

/* ---- Events and damage ---------------------------------------------------------------------- */

static const char cut_off[] = "the last event is cut off";

/* What is wrong at a position that is not an accepted event. In: count bytes, a header, or fewer at
 * the end of the file. */
static const char *what_is_wrong(const unsigned char *header, size_t count)
{
    if (memcmp(header, sync_word, count < SYNC_BYTES ? count : SYNC_BYTES) != 0)
        return "no event";
    if (count == LOG_HEADER_BYTES && !lengths_are_valid(lengths_at(header)))
        return "an event with impossible lengths";
    return cut_off;
}

static enum log_outcome failed(const struct log_reader *reader)
{
    errno = reader->error;
    return LOG_FAILED;
}

/* In: all kept bytes of the event are in the buffer. */
static enum log_outcome take_event(struct log_reader *reader, struct lengths lengths,
                                   struct log_event *event)
{
    const unsigned char *header = buffered(reader, reader->at);
    memcpy(reader->channel, header + LOG_HEADER_BYTES, lengths.channel);
    reader->channel[lengths.channel] = '\0';
    event->offset = reader->at;
    event->length = whole_length(lengths);
    event->number = (int64_t) big_endian_64(header + 4);
    event->utime = (int64_t) big_endian_64(header + 12);
    event->channel = reader->channel;
    event->channel_length = lengths.channel;
    event->data = header + LOG_HEADER_BYTES + lengths.channel;
    event->size = lengths.data;
    event->kept = kept_data(lengths);
    reader->at += event->length;
    return LOG_EVENT;
}

static enum log_outcome take_damage(struct log_reader *reader, struct log_damage *damage)
{
    const int64_t offset = reader->at;
    const size_t count = (size_t) least(LOG_HEADER_BYTES, reader->size - offset);
    if (!buffer(reader, offset, count))
        return failed(reader);
    const unsigned char *bytes = buffered(reader, offset);
    int64_t zeros = 0;
    while (zeros < (int64_t) count && bytes[zeros] == 0)
        zeros++;
    damage->what = what_is_wrong(bytes, count);
    reader->at = next_accepted(reader, offset);
    if (reader->error)
        return failed(reader);
    damage->offset = offset;
    damage->length = reader->at - offset;
    if (zeros >= least(LOG_HEADER_BYTES, damage->length))
        damage->what = "zeros";
    else if (damage->what == cut_off && reader->at < reader->size)
        damage->what = "an event that is cut off, or has wrong lengths";
    return LOG_DAMAGE;
}

enum log_outcome log_next(struct log_reader *reader, struct log_event *event,
                          struct log_damage *damage)
{
    const bool sought = reader->sought;
    struct lengths lengths;
    if (reader->error)
        return failed(reader);
    reader->sought = false;
    if (reader->at == reader->size)
        return LOG_END;
    if (is_accepted(reader, reader->at, &lengths) && !reader->error &&
        buffer(reader, reader->at, LOG_HEADER_BYTES + lengths.channel + kept_data(lengths)))
        return take_event(reader, lengths, event);
    if (reader->error)
        return failed(reader);
    if (!sought)
        return take_damage(reader, damage);
    reader->at = next_accepted(reader, reader->at);
    return log_next(reader, event, damage);
}

void log_seek(struct log_reader *reader, int64_t offset)
{
    reader->at = offset;
    reader->sought = offset > 0;
}

/* ---- All data of an event -------------------------------------------------------------------- */

bool log_read_data(struct log_reader *reader, const struct log_event *event, unsigned char *out)
{
    const int64_t data = event->offset + event->length - (int64_t) event->size;
    const bool good = read_at(reader, data, out, event->size);
    if (!good)
        failed(reader);
    return good;
}

/* ---- Opening and closing --------------------------------------------------------------------- */

int64_t log_size(const struct log_reader *reader)
{
    return reader->size;
}

void log_limit(struct log_reader *reader, int64_t size)
{
    reader->size = size;
}

static struct log_reader *refuse(int fd, const char *reason, char why[LOG_WHY_MAX])
{
    snprintf(why, LOG_WHY_MAX, "%s", reason);
    if (fd >= 0)
        close(fd);
    return NULL;
}

/* O_NONBLOCK: a pipe is an error, and does not block. */
struct log_reader *log_open(const char *path, char why[LOG_WHY_MAX])
{
    struct stat about;
    const int fd = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    if (fd < 0 || fstat(fd, &about) != 0)
        return refuse(fd, strerror(errno), why);
    if (!S_ISREG(about.st_mode))
        return refuse(fd, "no regular file", why);
    struct log_reader *reader = malloc(sizeof *reader);
    if (!reader)
        return refuse(fd, strerror(errno), why);
    reader->fd = fd;
    reader->error = 0;
    reader->size = about.st_size;
    reader->at = reader->begin = 0;
    reader->used = 0;
    reader->sought = false;
    reader->none_begin = reader->none_end = -1;
    return reader;
}

void log_close(struct log_reader *reader)
{
    if (!reader)
        return;
    close(reader->fd);
    free(reader);
}
