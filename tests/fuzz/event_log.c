/* Any bytes, read as an event log: what is reported covers each byte once, and is what a second
 * reader says, which has all of the file before it and looks at each place anew. In which pieces
 * the file comes makes no difference; from any place on the same is read; and a file that becomes
 * shorter ends what is read of it. */
#include "fuzz.h"

#include "log_pieces.h"
#include "log_read.h"

#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

struct file {
    uint8_t *bytes;
    size_t size;
    size_t *end; /* [at]: of the event that is believed there, or 0 */
};

/* ---- What is an event (log_read.c) ---- */

static uint32_t number_at(const uint8_t *bytes)
{
    uint32_t number = 0;
    for (int i = 0; i < 4; i++)
        number = number << 8 | bytes[i];
    return number;
}

static bool begins_like_one(const struct file *file, size_t at)
{
    static const uint8_t sync[] = {0xed, 0xa1, 0xda, 0x01};
    for (size_t i = 0; i < sizeof sync && at + i < file->size; i++)
        if (file->bytes[at + i] != sync[i])
            return false;
    return true;
}

static bool lengths_are_good(const struct file *file, size_t at)
{
    const int64_t channel = (int32_t) number_at(file->bytes + at + 20);
    const int64_t data = (int32_t) number_at(file->bytes + at + 24);
    return channel >= 1 && channel < PIECES_CHANNEL_MAX && data >= 0;
}

/* Where it would end, or 0. */
static size_t possible_end(const struct file *file, size_t at)
{
    if (file->size - at < LOG_HEADER_BYTES || !begins_like_one(file, at) ||
        !lengths_are_good(file, at))
        return 0;
    const uint64_t end = (uint64_t) at + LOG_HEADER_BYTES + number_at(file->bytes + at + 20) +
                         number_at(file->bytes + at + 24);
    return end <= file->size ? (size_t) end : 0;
}

/* From the last place to the first. */
static size_t *believed_ends(const struct file *file)
{
    size_t *believed = fuzz_room((file->size + 1) * sizeof *believed);
    size_t next_possible = file->size;
    believed[file->size] = 0;
    for (size_t at = file->size; at-- > 0;) {
        const size_t end = possible_end(file, at);
        const bool good = end > 0 && (begins_like_one(file, end) || end <= next_possible);
        believed[at] = good ? end : 0;
        if (end > 0)
            next_possible = at;
    }
    return believed;
}

static size_t next_believed(const struct file *file, size_t at)
{
    while (at < file->size && file->end[at] == 0)
        at++;
    return at;
}

static const char *damage_text(const struct file *file, size_t at, size_t next)
{
    size_t zeros = at;
    while (zeros < next && zeros - at < LOG_HEADER_BYTES && file->bytes[zeros] == 0)
        zeros++;
    if (zeros == next || zeros - at == LOG_HEADER_BYTES)
        return "zeros";
    if (!begins_like_one(file, at))
        return "no event";
    if (file->size - at >= LOG_HEADER_BYTES && !lengths_are_good(file, at))
        return "an event with impossible lengths";
    return next == file->size ? "the last event is cut off"
                              : "an event that is cut off, or has wrong lengths";
}

/* ---- Reports ---- */

static void check_event(const struct file *file, size_t at, const struct log_event *event)
{
    const uint8_t *header = file->bytes + at, *name = header + LOG_HEADER_BYTES;
    const size_t channel = number_at(header + 20), size = number_at(header + 24);
    FUZZ_CHECK(event->offset == (int64_t) at);
    FUZZ_CHECK(event->length == (int64_t) (file->end[at] - at));
    FUZZ_CHECK((uint32_t) ((uint64_t) event->number >> 32) == number_at(header + 4));
    FUZZ_CHECK((uint32_t) event->number == number_at(header + 8));
    FUZZ_CHECK((uint32_t) ((uint64_t) event->utime >> 32) == number_at(header + 12));
    FUZZ_CHECK((uint32_t) event->utime == number_at(header + 16));
    FUZZ_CHECK(event->channel_length == channel && event->channel[channel] == '\0');
    FUZZ_CHECK(memcmp(event->channel, name, channel) == 0);
    FUZZ_CHECK(event->size == size);
    FUZZ_CHECK(event->kept == (size < PIECES_DATA_MAX ? size : PIECES_DATA_MAX));
    FUZZ_CHECK(memcmp(event->data, name + channel, event->kept) == 0);
}

static void check_damage(const struct file *file, size_t at, const struct log_damage *damage)
{
    const size_t next = next_believed(file, at + 1);
    FUZZ_CHECK(damage->offset == (int64_t) at && damage->length == (int64_t) (next - at));
    FUZZ_CHECK(strcmp(damage->what, damage_text(file, at, next)) == 0);
}

/* From where the reader is to the end, or to an error. */
static enum log_outcome check_from(struct log_reader *reader, const struct file *file, size_t at)
{
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    while ((outcome = log_next(reader, &event, &damage)) < LOG_END) {
        FUZZ_CHECK(at < file->size);
        FUZZ_CHECK((outcome == LOG_EVENT) == (file->end[at] > 0));
        if (outcome == LOG_EVENT)
            check_event(file, at, &event);
        else
            check_damage(file, at, &damage);
        at += (size_t) (outcome == LOG_EVENT ? event.length : damage.length);
    }
    FUZZ_CHECK(outcome == LOG_FAILED || at == file->size);
    FUZZ_CHECK(log_next(reader, &event, &damage) == outcome);
    return outcome;
}

static struct log_reader *open_pieces(const struct file *file, size_t piece)
{
    char why[LOG_WHY_MAX];
    log_pieces_begin(file->bytes, file->size, piece);
    struct log_reader *reader = log_open("", why);
    FUZZ_CHECK(reader && log_size(reader) == (int64_t) file->size);
    return reader;
}

static void check_seeking(struct log_reader *reader, const struct file *file, size_t offset)
{
    log_seek(reader, (int64_t) offset);
    FUZZ_CHECK(check_from(reader, file, offset ? next_believed(file, offset) : 0) == LOG_END);
}

static void check_shortened(const struct file *file, size_t size)
{
    struct log_reader *reader = open_pieces(file, file->size + 1);
    log_pieces_shorten(size);
    if (check_from(reader, file, 0) == LOG_FAILED)
        FUZZ_CHECK(errno == ENODATA && size < file->size);
    log_close(reader);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct file file = {.bytes = fuzz_copy(data, size), .size = size};
    const size_t somewhere = size > 0 ? data[size - 1] * size / 255 : 0;
    file.end = believed_ends(&file);
    struct log_reader *reader = open_pieces(&file, size + 1);
    FUZZ_CHECK(check_from(reader, &file, 0) == LOG_END);
    check_seeking(reader, &file, somewhere);
    log_close(reader);
    reader = open_pieces(&file, 1 + size % 7);
    FUZZ_CHECK(check_from(reader, &file, 0) == LOG_END);
    check_seeking(reader, &file, size - somewhere);
    log_close(reader);
    check_shortened(&file, somewhere);
    free(file.end);
    free(file.bytes);
    return 0;
}
