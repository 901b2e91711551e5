/* What the echo and its client know of each other. Numbers are big-endian.
 *
 * Request: [0..3] how many bytes to reply (0: none), [8..15] its id. Reply: [0..7] the id of the
 * request, [8..15] how many requests came so far; the rest is anything. Both are ECHO_BYTES_MIN
 * bytes or more. */
#ifndef ECHO_H
#define ECHO_H

#define ECHO_QUERY "BUS_ECHO_QUERY"
#define ECHO_RESULT "BUS_ECHO_RESULT"

enum { ECHO_ID_AT = 8, ECHO_COUNT_AT = 8, ECHO_BYTES_MIN = 16, ECHO_BYTES_MAX = 65000 };

#endif
