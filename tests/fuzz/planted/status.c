/* The final 0 of a string is not looked for: its length is trusted. */
#include <string.h>
#define memchr(bytes, byte, size) ((bytes) + (size) -1)
#include "wire_status.c"
