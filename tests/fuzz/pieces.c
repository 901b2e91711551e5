#include "pieces.h"

#include "allocate.h"

#include <string.h>
#include <sys/types.h>
#include <unistd.h>

static const uint8_t *next;
static size_t left, piece_max;

void pieces_begin(const uint8_t *bytes, size_t size, size_t piece)
{
    next = bytes;
    left = size;
    piece_max = piece;
}

static ssize_t read_piece(int fd, void *out, size_t capacity)
{
    (void) fd;
    size_t count = capacity < piece_max ? capacity : piece_max;
    if (count > left)
        count = left;
    if (count > 0)
        memcpy(out, next, count);
    next += count;
    left -= count;
    return (ssize_t) count;
}

/* In memory of that size, so that a sanitizer sees what is read or written beyond it. */
#define allocate_grow(memory, capacity, needed, size) \
    allocate_grow(memory, capacity, (needed) -READ_BYTES + piece_max, size)
#define read read_piece
#include "text.c"
