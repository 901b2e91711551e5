/* An event that begins at the last place of the buffer where one can is not found after damage. */
#define _GNU_SOURCE
#define _FILE_OFFSET_BITS 64
#include <string.h>
#define memchr(bytes, byte, count) memchr(bytes, byte, (count) -1)
#include "log_pieces.c"
