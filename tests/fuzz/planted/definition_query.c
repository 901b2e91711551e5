/* The last handle of a list may have fewer than 16 bytes. */
#include "cursor.h"
#define cursor_fail(cursor, error) ((void) 0)
#include "wire_placement.c"
