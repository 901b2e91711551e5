/* Whether a reader took from a message what lcm-gen's decoder takes from it, to the bit. */
#ifndef SAME_H
#define SAME_H

#include "fuzz.h"
#include "query.h"

#include "fmb_msgs_body_t.h"
#include "fmb_msgs_placement_t.h"

#include <stdbool.h>

/* The bits of count numbers, NaNs and zeros included. */
bool same_doubles(const double *a, const double *b, size_t count);

/* Of a body the fields from dim on. */
bool same_geometry(const struct body_view *geometry, const fmb_msgs_body_t *message);

bool same_placement(const struct query_placement *placement, const fmb_msgs_placement_t *message);

/* Whether a struct query_placement has capacity for all numbers of the message, so that it can be
 * written again. */
bool same_can_hold(const struct query_placement *placement);

/* Handles one after the other in size bytes; the first max were kept. */
bool same_handles(const struct handle *handle, int32_t count, int32_t max, const uint8_t *bytes,
                  int32_t size);

/* Whether text is that of the message, cut to size bytes with the final 0, with '?' for each byte
 * that is not printable. *whole: nothing was cut or replaced. */
bool same_text(const char *text, size_t size, const char *message, bool *whole);

/* Checks that what was written are the bytes that were read. */
void same_bytes(const uint8_t *written, size_t size, const uint8_t *read, size_t read_size);

/* Checks a reader of headers on any bytes: it accepts the fingerprint and three numbers, whatever
 * follows. */
void same_header(const char *(*reader)(const void *, uint32_t, struct query_header *),
                 int64_t fingerprint, const uint8_t *bytes, size_t size);

/* Checks that the bytes are what the type's generated encoder makes of the message that its decoder
 * has read. Frees the message. */
#define SAME_ENCODED(type, message, bytes, size)                                 \
    do {                                                                         \
        uint8_t *encoded = fuzz_room(size);                                      \
        const int written = type##_encode(encoded, 0, (int) (size), &(message)); \
        FUZZ_CHECK(written >= 0);                                                \
        same_bytes(encoded, (size_t) written, bytes, size);                      \
        free(encoded);                                                           \
        FUZZ_CHECK(type##_decode_cleanup(&(message)) == 0);                      \
    } while (0)

#endif
