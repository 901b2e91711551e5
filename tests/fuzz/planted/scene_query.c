/* The count of placements may be negative. */
#include "cursor.h"
#define cursor_count(cursor, size) cursor_int32(cursor)
#include "wire_scene.c"
