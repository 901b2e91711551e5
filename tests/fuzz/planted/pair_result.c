/* A certificate may have bytes beyond ASCII. */
#include "cursor.h"
#define cursor_is_printable(byte) ((byte) >= ' ')
#include "wire_pair.c"
