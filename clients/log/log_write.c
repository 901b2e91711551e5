#include "log_write.h"

#include "log_read.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <lcm/eventlog.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* What small events are gathered in for the system; larger ones go there straight. */
enum { BUFFER_BYTES = 16 << 10 };

struct log_writer {
    lcm_eventlog_t *log;
    int64_t written; /* bytes */
    int error;       /* the first; 0: none so far */
};

/* An empty file that was not there: LCM's own function would overwrite. */
static bool create_new(const char *path)
{
    int fd = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    return fd >= 0 && close(fd) == 0;
}

struct log_writer *log_create(const char *path, bool force)
{
    struct log_writer *writer = calloc(1, sizeof *writer);
    if (!writer)
        return NULL;
    if (force || create_new(path))
        writer->log = lcm_eventlog_create(path, "w");
    if (!writer->log) {
        const int error = errno;
        free(writer);
        errno = error;
        return NULL;
    }
    setvbuf(writer->log->f, NULL, _IOFBF, BUFFER_BYTES);
    return writer;
}

/* What a call that failed leaves in errno. Always false. */
static bool fail(struct log_writer *writer)
{
    struct stat status;
    if (!writer->error) {
        writer->error = errno ? errno : EIO;
        writer->written = fstat(fileno(writer->log->f), &status) == 0 ? status.st_size : 0;
    }
    errno = writer->error;
    return false;
}

int64_t log_event_bytes(size_t channel_length, size_t size)
{
    return LOG_HEADER_BYTES + (int64_t) channel_length + (int64_t) size;
}

/* The library takes pointers to what it might change, and does not. */
bool log_append(struct log_writer *writer, int64_t utime, const char *channel,
                size_t channel_length, const void *data, size_t size)
{
    lcm_eventlog_event_t event = {.timestamp = utime,
                                  .channellen = (int32_t) channel_length,
                                  .datalen = (int32_t) size,
                                  .channel = (char *) channel,
                                  .data = (void *) data};
    assert(channel_length >= 1 && channel_length < LOG_CHANNEL_MAX && size <= INT32_MAX);
    errno = 0;
    if (writer->error || lcm_eventlog_write_event(writer->log, &event) != 0)
        return fail(writer);
    writer->written += log_event_bytes(channel_length, size);
    return true;
}

bool log_flush(struct log_writer *writer)
{
    errno = 0;
    if (writer->error || fflush(writer->log->f) != 0 || ferror(writer->log->f))
        return fail(writer);
    return true;
}

int64_t log_written(const struct log_writer *writer)
{
    return writer->written;
}

int log_finish_soon(struct log_writer *writer, int *disk)
{
    *disk = -1;
    if (!writer)
        return 0;
    if (log_flush(writer) && (*disk = fcntl(fileno(writer->log->f), F_DUPFD_CLOEXEC, 0)) < 0)
        fail(writer);
    const int error = writer->error;
    lcm_eventlog_destroy(writer->log);
    free(writer);
    return error;
}

/* EINVAL: it is nothing that a disk keeps, such as a pipe. */
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

static const char *remedy(int error)
{
    switch (error) {
    case EEXIST: return "; --force overwrites it";
    case ENOSPC:
    case EDQUOT: return "; make room there, or write elsewhere";
    case EFBIG: return "; no larger file is allowed there: write several";
    default: return "";
    }
}

void log_write_complain(const char *path, int error)
{
    fprintf(stderr, "fmb: %s: %s%s\n", path, strerror(error), remedy(error));
}
