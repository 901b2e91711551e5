/* The last byte is not compared: a body, or a handle, that differs only there is taken for the one
 * that is held. */
#include <string.h>
#define memcmp(a, b, size) memcmp(a, b, (size) -1)
#include "cache.c"
