/* The names of the message types, by fingerprint. */
#ifndef WIRE_TYPE_H
#define WIRE_TYPE_H

#include <stdbool.h>
#include <stdint.h>

/* Returns a static text such as "fmb_msgs.pair_query_t" or "fmb_msgs.pair_query_t (version 1)".
 * NULL: the fingerprint belongs to no type of this version or of version 1. */
const char *wire_type_name(int64_t fingerprint);

/* Whether the fingerprint belongs to a type of version 1. Its types have the same names but other
 * fields, and cannot be decoded. */
bool wire_type_is_version_1(int64_t fingerprint);

#endif
