/* A second opinion on what is a message: a walk by the letters of its type, which shares nothing
 * with the readers of the service.
 *
 *     i l      4 bytes, 8 bytes
 *     B H L    a count and so many times 1, 2 or 8 bytes
 *     s        a string: its length with the final 0, which is the only one
 *     F        a frame (frame_t.lcm)
 *     M        a count and so many frames */
#ifndef LAYOUT_H
#define LAYOUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define LAYOUT_PAIR_QUERY \
    "llll"                \
    "iiFF"
#define LAYOUT_PAIR_RESULT \
    "llllllll"             \
    "isiiLLsl"
#define LAYOUT_SCENE_QUERY \
    "llll"                 \
    "iiiiiMH"
#define LAYOUT_SCENE_RESULT \
    "llll"                  \
    "isilLiBHLLl"
#define LAYOUT_STATUS \
    "ll"              \
    "slllllll"        \
    "L"               \
    "llllllllllll"    \
    "L"

/* Whether the bytes are what an encoder of this type can write: then its generated decoder may have
 * them, which reads out of bounds where counts lie. */
bool layout_fits(const char *layout, int64_t fingerprint, const uint8_t *bytes, size_t size);

#endif
