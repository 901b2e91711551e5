/* A second opinion on what is a message: a walk over its bytes by the letters of its type. Shares
 * nothing with the codec.
 *
 *     i l h    4 bytes, 8 bytes, 16 bytes
 *     B H I L  a count and as many elements of 1, 2, 4 or 8 bytes
 *     s        a string: its length with the final 0, then its bytes; only the last is 0
 *     d D      a dimension, not negative; as many elements of 8 bytes as the last dimension
 *     c        a count, not negative
 *     C S      as many elements of 8 bytes, or strings, as the last count
 *     P        a placement (placement_t.lcm)
 *     M        a count and as many placements
 *     O        a count and as many bodies (body_t.lcm) */
#ifndef LAYOUT_H
#define LAYOUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define LAYOUT_PAIR_QUERY "lllliiPP"
#define LAYOUT_PAIR_RESULT "llllllhhisiiLLLLLLHsl"
#define LAYOUT_SCENE_QUERY "lllsliiliiiMHH"
#define LAYOUT_SCENE_RESULT "llllisiHBiBHLLLLLLHl"
#define LAYOUT_DEFINITION_QUERY "llllB"
#define LAYOUT_DEFINITION "llllislO"
#define LAYOUT_STATUS "llscSC"

/* Whether an encoder of this type can have written the bytes. If so, the generated decoder reads
 * them safely; it reads out of bounds where a count is wrong. */
bool layout_fits(const char *layout, int64_t fingerprint, const uint8_t *bytes, size_t size);

#endif
