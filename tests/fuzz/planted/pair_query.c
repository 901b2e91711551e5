/* Numbers are read without checking that the message has them. */
#include "cursor.h"
#define cursor_take(cursor, size) ((cursor)->at += (size), (cursor)->at - (size))
#include "wire_placement.c"
