/* The end of a string is not looked for: it is taken to be where its length says. */
#include <string.h>
#define memchr(bytes, byte, size) ((bytes) + (size) -1)
#include "cursor.c"
