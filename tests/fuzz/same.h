/* Whether a reader took from a message what lcm-gen's decoder takes from it, to the bit. */
#ifndef SAME_H
#define SAME_H

#include "fuzz.h"
#include "query.h"

#include "fmb_msgs_frame_t.h"

#include <stdbool.h>

/* The bits of count numbers, NaNs and zeros included. */
bool same_doubles(const double *a, const double *b, size_t count);

bool same_frame(const struct query_frame *frame, const fmb_msgs_frame_t *message);

/* Whether all of the frame has room in a struct query_frame, so that it can be written again. */
bool same_can_hold(const struct query_frame *frame);

/* Whether text is the message's, cut to what size bytes hold with a final 0, with '?' for what is
 * not printable. *whole: nothing was cut, nor replaced. */
bool same_text(const char *text, size_t size, const char *message, bool *whole);

/* Checks that what was written are the bytes that were read. */
void same_bytes(const uint8_t *written, size_t size, const uint8_t *read, size_t read_size);

/* Checks that the bytes are what the type's generated encoder makes of the message that its decoder
 * has read. Frees the message. */
#define SAME_ENCODED(type, message, bytes, size)                              \
    do {                                                                      \
        uint8_t *room = fuzz_room(size);                                      \
        const int written = type##_encode(room, 0, (int) (size), &(message)); \
        FUZZ_CHECK(written >= 0);                                             \
        same_bytes(room, (size_t) written, bytes, size);                      \
        free(room);                                                           \
        FUZZ_CHECK(type##_decode_cleanup(&(message)) == 0);                   \
    } while (0)

#endif
