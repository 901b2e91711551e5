/* Of the numbers of a frame one more is kept than there is room for. */
#include "cursor.h"
#define cursor_doubles(cursor, out, max) cursor_doubles(cursor, out, (max) + 1)
#include "wire_frame.c"
