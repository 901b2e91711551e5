/* The last byte of a handle is not compared. */
#include "handle.h"
#define handle_equal(a, b) (memcmp(a, b, sizeof *(a) -1) == 0)
#include "wire_definition.c"
