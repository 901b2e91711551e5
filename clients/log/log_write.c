#include "log_write.h"

#include "allocate.h"
#include "big_endian.h"
#include "log_read.h"

#include <assert.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Events are collected in a buffer of this capacity, or more for a larger event. */
enum { BUFFER_BYTES = 256 << 10 };

struct log_writer {
    int fd;
    int error;      /* the first error, errno; 0: none */
    int64_t number; /* of the next event */
    int64_t whole;  /* bytes written to the file: complete events only */
    size_t used;    /* bytes used of the buffer: complete events only */
    size_t capacity;
    unsigned char *buffer; /* owned */
};

struct log_writer *log_begin(int fd)
{
    if (fd < 0)
        return NULL;
    struct log_writer *writer = allocate(1, sizeof *writer);
    writer->fd = fd;
    writer->capacity = BUFFER_BYTES;
    writer->buffer = allocate_unset(BUFFER_BYTES);
    return writer;
}

struct log_writer *log_begin_output(const struct output *output)
{
    const int fd = output ? dup(fileno(output->file)) : -1;
    if (output && fd < 0)
        output_complain(output->path, errno);
    return log_begin(fd);
}

int64_t log_event_bytes(size_t channel_length, size_t size)
{
    return LOG_HEADER_BYTES + (int64_t) channel_length + (int64_t) size;
}

/* ---- Writing ---- */

static bool fail(struct log_writer *writer, int error)
{
    if (!writer->error)
        writer->error = error ? error : EIO;
    errno = writer->error;
    return false;
}

/* Returns how many bytes were written; fewer than size after an error, errno. */
static size_t write_all(int fd, const unsigned char *bytes, size_t size)
{
    size_t done = 0;
    while (done < size) {
        const ssize_t count = write(fd, bytes + done, size - done);
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0)
            break;
        done += (size_t) count;
    }
    return done;
}

/* The length of the complete events in the first `done` bytes of the buffer. */
static size_t whole_events(const struct log_writer *writer, size_t done)
{
    size_t at = 0;
    for (;;) {
        const unsigned char *header = writer->buffer + at;
        if (done - at < LOG_HEADER_BYTES)
            return at;
        const size_t size = LOG_HEADER_BYTES + (size_t) big_endian_32(header + 20) +
                            (size_t) big_endian_32(header + 24);
        if (size > done - at)
            return at;
        at += size;
    }
}

/* Removes the last `torn` bytes of the file, which are an incomplete event. Nothing is written
 * after that. A file that another program truncated is not extended. Files that are not regular
 * cannot be truncated, and are left as they are. */
static bool cut_back(struct log_writer *writer, size_t torn, int error)
{
    struct stat file;
    if (fstat(writer->fd, &file) == 0 && file.st_size >= (off_t) torn) {
        const int truncated = ftruncate(writer->fd, file.st_size - (off_t) torn);
        (void) truncated;
    }
    return fail(writer, error);
}

bool log_flush(struct log_writer *writer)
{
    if (writer->error)
        return fail(writer, 0);
    const size_t done = write_all(writer->fd, writer->buffer, writer->used);
    const int error = errno;
    const bool complete = done == writer->used;
    const size_t whole = complete ? done : whole_events(writer, done);
    writer->whole += (int64_t) whole;
    writer->used = 0;
    return complete || cut_back(writer, done - whole, error);
}

bool log_append(struct log_writer *writer, int64_t utime, const char *channel,
                size_t channel_length, const void *data, size_t size)
{
    const size_t bytes = (size_t) log_event_bytes(channel_length, size);
    assert(channel_length >= 1 && channel_length < LOG_CHANNEL_MAX && size <= INT32_MAX);
    if (writer->error)
        return fail(writer, 0);
    if (bytes > writer->capacity - writer->used && !log_flush(writer))
        return false;
    writer->buffer = allocate_grow(writer->buffer, &writer->capacity, bytes, 1);
    unsigned char *header = writer->buffer + writer->used, *name = header + LOG_HEADER_BYTES;
    big_endian_put_32(header, UINT32_C(0xeda1da01));
    big_endian_put_64(header + 4, (uint64_t) writer->number++);
    big_endian_put_64(header + 12, (uint64_t) utime);
    big_endian_put_32(header + 20, (uint32_t) channel_length);
    big_endian_put_32(header + 24, (uint32_t) size);
    memcpy(name, channel, channel_length);
    if (size > 0)
        memcpy(name + channel_length, data, size);
    writer->used += bytes;
    return true;
}

int64_t log_written(const struct log_writer *writer)
{
    return writer->whole + (int64_t) writer->used;
}

bool log_check(struct log_writer *writer)
{
    struct stat file;
    if (writer->error)
        return fail(writer, 0);
    if (fstat(writer->fd, &file) != 0)
        return fail(writer, errno);
    errno = ESTALE;
    return !S_ISREG(file.st_mode) || (file.st_nlink > 0 && file.st_size >= (off_t) writer->whole);
}

/* ---- The end ---- */

int log_finish_soon(struct log_writer *writer, int *disk)
{
    *disk = -1;
    if (!writer)
        return 0;
    const int error = log_flush(writer) && log_check(writer) ? 0 : errno;
    *disk = writer->fd;
    free(writer->buffer);
    free(writer);
    return error;
}

/* EINVAL: not a file on a disk, for example a pipe. */
int log_reach_disk(int disk)
{
    if (disk < 0)
        return 0;
    int error = fsync(disk) == 0 || errno == EINVAL || errno == EROFS ? 0 : errno;
    if (close(disk) != 0 && !error)
        error = errno;
    return error;
}

int log_finish(struct log_writer *writer)
{
    int disk;
    const int error = log_finish_soon(writer, &disk), late = log_reach_disk(disk);
    return error ? error : late;
}
