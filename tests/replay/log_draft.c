#define _GNU_SOURCE /* memfd_create() */
#include "log_draft.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { HEADER_BYTES = 28 };

static _Noreturn void give_up(const char *what)
{
    perror(what);
    abort();
}

void log_draft_raw(struct log_draft *log, const void *bytes, size_t size)
{
    while (log->size + size > log->capacity) {
        log->capacity = 2 * log->capacity + 4096;
        log->bytes = realloc(log->bytes, log->capacity);
        if (!log->bytes)
            give_up("memory");
    }
    if (size > 0)
        memcpy(log->bytes + log->size, bytes, size);
    log->size += size;
}

static void put(struct log_draft *log, uint64_t value, int size)
{
    unsigned char bytes[8];
    for (int i = 0; i < size; i++)
        bytes[i] = (unsigned char) (value >> (8 * (size - 1 - i)));
    log_draft_raw(log, bytes, (size_t) size);
}

void log_draft_header(struct log_draft *log, int64_t number, int64_t utime, uint32_t channel_length,
                      uint32_t data_size)
{
    put(log, 0xeda1da01, 4);
    put(log, (uint64_t) number, 8);
    put(log, (uint64_t) utime, 8);
    put(log, channel_length, 4);
    put(log, data_size, 4);
}

void log_draft_event(struct log_draft *log, const char *channel, int64_t utime, const void *data,
                     size_t size)
{
    log_draft_header(log, log->events++, utime, (uint32_t) strlen(channel), (uint32_t) size);
    log_draft_raw(log, channel, strlen(channel));
    log_draft_raw(log, data, size);
}

void log_draft_free(struct log_draft *log)
{
    free(log->bytes);
    *log = (struct log_draft){.size = 0};
}

int log_draft_file(const unsigned char *bytes, size_t size, char path[LOG_DRAFT_PATH_MAX])
{
    const int fd = memfd_create("log", MFD_CLOEXEC);
    if (fd < 0)
        give_up("a file in memory");
    for (size_t done = 0; done < size;) {
        const ssize_t count = write(fd, bytes + done, size - done);
        if (count <= 0)
            give_up("a file in memory");
        done += (size_t) count;
    }
    if (lseek(fd, 0, SEEK_SET) != 0)
        give_up("a file in memory");
    snprintf(path, LOG_DRAFT_PATH_MAX, "/proc/self/fd/%d", fd);
    return fd;
}
