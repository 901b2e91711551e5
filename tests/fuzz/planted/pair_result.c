/* Of the bytes that no terminal should see in a certificate only those below the space are refused.
 */
#include "cursor.h"
#define cursor_is_printable(byte) ((byte) >= ' ')
#include "wire_pair.c"
