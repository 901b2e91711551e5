#define _GNU_SOURCE /* memfd_create() */
#include "log_bytes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmocka.h>

void log_bytes_add(struct log_bytes *log, const void *bytes, size_t size)
{
    assert_true(size <= LOG_BYTES_MAX - log->size);
    if (size > 0)
        memcpy(log->bytes + log->size, bytes, size);
    log->size += size;
}

/* Big-endian. */
static void add_number(struct log_bytes *log, uint64_t number, int bytes)
{
    while (bytes-- > 0) {
        const unsigned char byte = (unsigned char) (number >> 8 * bytes);
        log_bytes_add(log, &byte, 1);
    }
}

void log_bytes_header(struct log_bytes *log, int64_t number, int64_t utime, uint32_t channel_length,
                      uint32_t data_size)
{
    add_number(log, 0xeda1da01, 4);
    add_number(log, (uint64_t) number, 8);
    add_number(log, (uint64_t) utime, 8);
    add_number(log, channel_length, 4);
    add_number(log, data_size, 4);
}

void log_bytes_event(struct log_bytes *log, int64_t utime, const char *channel, const void *data,
                     size_t size)
{
    assert_true(log->count < LOG_BYTES_EVENTS_MAX);
    log->begin[log->count] = log->size;
    log_bytes_header(log, (int64_t) log->count, utime, (uint32_t) strlen(channel), (uint32_t) size);
    log_bytes_add(log, channel, strlen(channel));
    log_bytes_add(log, data, size);
    log->end[log->count++] = log->size;
}

static int descriptor = -1;

int log_bytes_descriptor(void)
{
    return descriptor;
}

const char *log_bytes_file(const void *bytes, size_t size)
{
    static char path[64];
    if (descriptor < 0)
        descriptor = memfd_create("log", MFD_CLOEXEC);
    assert_true(descriptor >= 0);
    assert_int_equal(ftruncate(descriptor, 0), 0);
    assert_int_equal(pwrite(descriptor, bytes, size, 0), size);
    snprintf(path, sizeof path, "/proc/self/fd/%d", descriptor);
    return path;
}
