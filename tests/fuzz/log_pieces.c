#define _GNU_SOURCE
#define _FILE_OFFSET_BITS 64
#include "log_pieces.h"

#include "log_read.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static struct {
    const uint8_t *bytes;
    size_t size, piece;
} file;

void log_pieces_begin(const uint8_t *bytes, size_t size, size_t piece)
{
    file.bytes = bytes;
    file.size = size;
    file.piece = piece;
}

void log_pieces_shorten(size_t size)
{
    file.size = size;
}

static ssize_t read_piece(void *out, size_t count, off_t offset)
{
    const size_t left = (size_t) offset < file.size ? file.size - (size_t) offset : 0;
    if (count > left)
        count = left;
    if (count > file.piece)
        count = file.piece;
    if (count > 0)
        memcpy(out, file.bytes + offset, count);
    return (ssize_t) count;
}

static bool is_hole(size_t block)
{
    for (size_t i = block; i < block + PIECES_BLOCK; i++)
        if (i < file.size && file.bytes[i] != 0)
            return false;
    return true;
}

static off_t seek_data(off_t offset)
{
    size_t at = (size_t) offset;
    while (at < file.size && is_hole(at - at % PIECES_BLOCK))
        at += PIECES_BLOCK - at % PIECES_BLOCK;
    if (at < file.size)
        return (off_t) at;
    errno = ENXIO;
    return -1;
}

static int describe(struct stat *out)
{
    out->st_mode = S_IFREG;
    out->st_size = (off_t) file.size;
    return 0;
}

#define LOG_BUFFER_BYTES ((size_t) PIECES_BUFFER_BYTES)
#define LOG_CHANNEL_MAX PIECES_CHANNEL_MAX
#define LOG_DATA_MAX PIECES_DATA_MAX
#define open(path, flags) ((void) (path), 0)
#define fstat(fd, out) describe(out)
#define close(fd) ((void) (fd))
#define pread(fd, out, count, offset) ((void) (fd), read_piece(out, count, offset))
#define lseek(fd, offset, whence) ((void) (fd), seek_data(offset))
#include "log_read.c"
