/* Messages between the echo and its client. Numbers are big-endian.
 *
 * Request: [0..3] size of the reply in bytes (0: none), [8..15] its id. Reply: [0..7] the id of the
 * request, [8..15] requests received so far; the remainder is arbitrary. Both have ECHO_BYTES_MIN
 * bytes or more. */
#ifndef ECHO_H
#define ECHO_H

#define ECHO_QUERY "BUS_ECHO_QUERY"
#define ECHO_RESULT "BUS_ECHO_RESULT"

/* LCM's queue of a subscription, in messages: more than a receive buffer holds. */
enum { ECHO_QUEUE = 4096 };

enum { ECHO_ID_AT = 8, ECHO_COUNT_AT = 8, ECHO_BYTES_MIN = 16, ECHO_BYTES_MAX = 65000 };

#endif
