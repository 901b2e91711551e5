/* What is an event. An event is possible where a sync word stands with a whole header, whose
 * lengths can be and end within the file. It is believed where the file ends just there too, or a
 * sync word stands there, as much of one as the file has: of bytes that are there by chance that is
 * true once in 2^32 times. Else it is believed where no other event is possible inside of it: then
 * its lengths may be right, and what follows it is damaged; if one is, they are wrong, and jump
 * over what is good.
 *
 * From `at`, the end of what was told last, the next to be told is the event there, if it is
 * believed; if not, damage up to the next one that is, or to the end of the file. `at` goes to the
 * end of what was told: so each byte is in one event or one damage, and no byte is in neither.
 *
 * What is lost. An event all of whose bytes are good is told, unless it lies in another that ends
 * at a sync word or with the file, or another is possible inside of it and the sync word behind it
 * is damaged. All this is said of places, not of how the reader came there: so seeking finds what
 * reading finds.
 *
 * Time. Only the search for the next possible event looks at bytes one by one. What it finds is
 * kept, and is the answer for all places before it; the next search begins behind it: so each byte
 * is looked at once. For each possible event, 28 bytes are looked at there and 4 where it ends,
 * whatever its lengths say.
 *
 * Bytes are read by the buffer, from a place on that is asked for; only those 4 alone, where they
 * are not in it. Going forward, it is filled again where less than 28 bytes are left of it in a
 * search, or less than what is kept of an event, 67 kB of 256: each filling is mostly new. A search
 * may leave behind an event that is to be told, for which the buffer is filled again: but of two
 * searches that do so, one after the other, the second ends a buffer behind the beginning of the
 * first. So what is read in all is a small multiple of the file, hostile files included.
 *
 * Holes of sparse files hold no sync word: searches jump over them. */
#define _GNU_SOURCE /* SEEK_DATA */
#define _FILE_OFFSET_BITS 64
#include "log_read.h"

#include "big_endian.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

/* With 128 KiB to 1 MiB reading is as quick. */
#ifndef LOG_BUFFER_BYTES
#define LOG_BUFFER_BYTES (256 * 1024)
#endif

enum { SYNC_BYTES = 4, KEPT_MAX = LOG_HEADER_BYTES + LOG_CHANNEL_MAX + LOG_DATA_MAX };

_Static_assert(LOG_BUFFER_BYTES > KEPT_MAX, "an event stands in the buffer as one");

static const unsigned char sync_word[SYNC_BYTES] = {0xed, 0xa1, 0xda, 0x01};

struct log_reader {
    int fd;
    int error; /* errno of a read that failed; 0: none did */
    int64_t size;
    int64_t at;  /* what comes next begins here */
    bool sought; /* no damage is to be told before it */
    /* No event is possible from none_begin to before none_end; there one is, or the file ends. */
    int64_t none_begin, none_end;
    int64_t begin; /* where in the file the buffer's bytes are */
    size_t used;
    char channel[LOG_CHANNEL_MAX];
    unsigned char bytes[LOG_BUFFER_BYTES];
};

/* ---- Bytes of the file ----------------------------------------------------------------------- */

static inline int64_t least(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/* All of what is asked for, which is in the file unless that has become shorter. */
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

static inline bool is_held(const struct log_reader *reader, int64_t offset, size_t count)
{
    return offset >= reader->begin && count <= reader->used &&
           offset - reader->begin <= (int64_t) (reader->used - count);
}

static inline const unsigned char *held(const struct log_reader *reader, int64_t offset)
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

/* On input: bytes that are in the file, no more than a buffer. On output: they are in the buffer;
 * or false, and error. */
static bool hold(struct log_reader *reader, int64_t offset, size_t count)
{
    return is_held(reader, offset, count) || fill(reader, offset);
}

/* ---- Events, as headers have them ------------------------------------------------------------ */

struct lengths {
    uint32_t channel, data;
};

static inline struct lengths lengths_at(const unsigned char *header)
{
    return (struct lengths){big_endian_32(header + 20), big_endian_32(header + 24)};
}

/* Negative ones are beyond the limits too. */
static inline bool lengths_can_be(struct lengths lengths)
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

/* On input: a whole header, in the buffer. Where its event would end; 0: it can be none. */
static int64_t end_of(const struct log_reader *reader, int64_t offset)
{
    const unsigned char *header = held(reader, offset);
    const struct lengths lengths = lengths_at(header);
    if (!is_sync(header) || !lengths_can_be(lengths) ||
        whole_length(lengths) > reader->size - offset)
        return 0;
    return offset + whole_length(lengths);
}

/* Whether the file ends at the offset, or a sync word begins there. */
static bool is_followed(struct log_reader *reader, int64_t end)
{
    unsigned char bytes[SYNC_BYTES];
    const size_t count = (size_t) least(SYNC_BYTES, reader->size - end);
    if (is_held(reader, end, SYNC_BYTES))
        return is_sync(held(reader, end));
    return read_at(reader, end, bytes, count) && memcmp(bytes, sync_word, count) == 0;
}

/* ---- Searches. They end at once, and find nothing, after an error ---------------------------- */

/* The first place from the offset on that is no hole, or the last one: that is read in any case,
 * and tells whether the file has become shorter. */
static int64_t skip_hole(const struct log_reader *reader, int64_t offset, int64_t last)
{
    const off_t data = lseek(reader->fd, (off_t) offset, SEEK_DATA);
    if (data >= 0)
        return least(data, last);
    return errno == ENXIO ? last : offset; /* only holes; or it is not known */
}

/* The first sync word that begins before the end, or the end; there are bytes to read behind it. */
static const unsigned char *find_sync(const unsigned char *bytes, const unsigned char *end)
{
    while (bytes < end && (bytes = memchr(bytes, sync_word[0], (size_t) (end - bytes)))) {
        if (is_sync(bytes))
            return bytes;
        bytes++;
    }
    return end;
}

/* The first event that is possible from the offset on, or the size. */
static int64_t search(struct log_reader *reader, int64_t offset)
{
    const int64_t last = reader->size - LOG_HEADER_BYTES;
    while (offset <= last) {
        if (!is_held(reader, offset, LOG_HEADER_BYTES)) {
            offset = skip_hole(reader, offset, last);
            if (!fill(reader, offset))
                break;
        }
        const unsigned char *bytes = held(reader, offset);
        const unsigned char *end = reader->bytes + reader->used - LOG_HEADER_BYTES + 1;
        const unsigned char *found = find_sync(bytes, end);
        offset += found - bytes;
        if (found < end && end_of(reader, offset) > 0)
            return offset;
        offset += found < end;
    }
    return reader->size;
}

/* The first event that is possible behind the offset, or the size. */
static int64_t next_possible(struct log_reader *reader, int64_t offset)
{
    const int64_t from = offset + 1;
    if (from < reader->none_begin || from > reader->none_end) {
        reader->none_end = search(reader, from);
        reader->none_begin = from;
    }
    return reader->none_end;
}

static bool is_believed(struct log_reader *reader, int64_t offset)
{
    if (reader->size - offset < LOG_HEADER_BYTES || !hold(reader, offset, LOG_HEADER_BYTES))
        return false;
    const int64_t end = end_of(reader, offset);
    if (end == 0)
        return false;
    return is_followed(reader, end) || (!reader->error && end <= next_possible(reader, offset));
}

/* The first event that is believed behind the offset, or the size. */
static int64_t next_believed(struct log_reader *reader, int64_t offset)
{
    do
        offset = next_possible(reader, offset);
    while (offset < reader->size && !is_believed(reader, offset) && !reader->error);
    return offset;
}

/* ---- One after the other --------------------------------------------------------------------- */

static const char cut_off[] = "the last event is cut off";

/* Of what is no event that is believed. On input: count bytes, a header, or less at the end of the
 * file. */
static const char *what_is_wrong(const unsigned char *header, size_t count)
{
    if (memcmp(header, sync_word, count < SYNC_BYTES ? count : SYNC_BYTES) != 0)
        return "no event";
    if (count == LOG_HEADER_BYTES && !lengths_can_be(lengths_at(header)))
        return "an event with impossible lengths";
    return cut_off;
}

static int64_t count_zeros(const unsigned char *bytes, size_t count)
{
    size_t zeros = 0;
    while (zeros < count && bytes[zeros] == 0)
        zeros++;
    return (int64_t) zeros;
}

static enum log_outcome failed(const struct log_reader *reader)
{
    errno = reader->error;
    return LOG_FAILED;
}

/* Nearly all names are short: then it is quicker to copy a number of bytes that is always the same.
 * On input: the name is in the buffer. */
static void take_channel(struct log_reader *reader, const unsigned char *name, size_t length)
{
    enum { SHORT = LOG_CHANNEL_MAX < 64 ? LOG_CHANNEL_MAX : 64 };
    if (length < SHORT && reader->bytes + reader->used - name >= SHORT)
        memcpy(reader->channel, name, SHORT);
    else
        memcpy(reader->channel, name, length);
    reader->channel[length] = '\0';
}

/* On input: all that is kept of the event is in the buffer. */
static enum log_outcome take_event(struct log_reader *reader, struct lengths lengths,
                                   struct log_event *event)
{
    const unsigned char *header = held(reader, reader->at);
    take_channel(reader, header + LOG_HEADER_BYTES, lengths.channel);
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
    if (!hold(reader, offset, count))
        return failed(reader);
    damage->what = what_is_wrong(held(reader, offset), count);
    const int64_t zeros = count_zeros(held(reader, offset), count);
    reader->at = next_believed(reader, offset);
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

/* Whether an event is there that is believed; then what is kept of it is in the buffer. */
static bool is_event(struct log_reader *reader, struct lengths *out)
{
    const int64_t at = reader->at;
    if (!is_believed(reader, at) || reader->error || !hold(reader, at, LOG_HEADER_BYTES))
        return false;
    *out = lengths_at(held(reader, at));
    return hold(reader, at, LOG_HEADER_BYTES + out->channel + kept_data(*out));
}

/* What nearly every event is: all in the buffer, and followed by a sync word there. This decides
 * nothing that is_event() does not decide alike, and is quick. */
static bool is_plain_event(const struct log_reader *reader, struct lengths *out)
{
    const int64_t left = reader->begin + (int64_t) reader->used - reader->at;
    if (reader->at < reader->begin || left < LOG_HEADER_BYTES)
        return false;
    const unsigned char *header = held(reader, reader->at);
    *out = lengths_at(header);
    return is_sync(header) && lengths_can_be(*out) && whole_length(*out) <= left - SYNC_BYTES &&
           is_sync(header + whole_length(*out));
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
    if (is_plain_event(reader, &lengths) || is_event(reader, &lengths))
        return take_event(reader, lengths, event);
    if (reader->error)
        return failed(reader);
    if (!sought)
        return take_damage(reader, damage);
    reader->at = next_believed(reader, reader->at);
    return log_next(reader, event, damage);
}

void log_seek(struct log_reader *reader, int64_t offset)
{
    reader->at = offset;
    reader->sought = true;
}

void log_rewind(struct log_reader *reader)
{
    reader->at = 0;
    reader->sought = false;
}

/* ---- All data of an event -------------------------------------------------------------------- */

/* How far behind the beginning of a page an event's data begin: files are mapped from there on. */
static size_t behind_page(const struct log_event *event)
{
    const int64_t page = sysconf(_SC_PAGESIZE);
    return (size_t) ((event->offset + event->length - (int64_t) event->size) % page);
}

const void *log_map(const struct log_reader *reader, const struct log_event *event)
{
    struct stat about;
    const size_t before = behind_page(event);
    const int64_t begin = event->offset + event->length - (int64_t) event->size - (int64_t) before;
    if (fstat(reader->fd, &about) != 0)
        return NULL;
    if (about.st_size < event->offset + event->length) {
        errno = ENODATA;
        return NULL;
    }
    const unsigned char *bytes =
        mmap(NULL, before + event->size, PROT_READ, MAP_PRIVATE, reader->fd, (off_t) begin);
    return bytes == MAP_FAILED ? NULL : bytes + before;
}

void log_unmap(const void *data, const struct log_event *event)
{
    const size_t before = behind_page(event);
    munmap((unsigned char *) (uintptr_t) data - before, before + event->size);
}

/* ---- Opening and closing --------------------------------------------------------------------- */

int64_t log_size(const struct log_reader *reader)
{
    return reader->size;
}

static struct log_reader *refuse(int fd, const char *reason, char why[LOG_WHY_MAX])
{
    snprintf(why, LOG_WHY_MAX, "%s", reason);
    if (fd >= 0)
        close(fd);
    return NULL;
}

/* O_NONBLOCK: a pipe is refused, not waited for. */
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
