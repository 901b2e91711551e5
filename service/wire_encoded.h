/* What the generated encoders return: for the files that write messages. */
#ifndef WIRE_ENCODED_H
#define WIRE_ENCODED_H

#include <assert.h>
#include <stddef.h>

/* The size of the message; -1 where there is no room, which does not happen where the caller has
 * counted well. Inline: one line, for three files. */
static inline size_t wire_encoded(int size)
{
    assert(size > 0);
    return (size_t) size;
}

#endif
