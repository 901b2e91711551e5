/* The names of the message types, by fingerprint. */
#ifndef WIRE_TYPE_H
#define WIRE_TYPE_H

#include <stdint.h>

/* Returns a static text such as "fmb_msgs.pair_query_t" or "fmb_msgs.pair_query_t (version 1)".
 * NULL: the fingerprint belongs to no type of this version or of an old one. */
const char *wire_type_name(int64_t fingerprint);

/* Returns 1 or 2 if the fingerprint belongs to a type of that version, else 0. Its types have the
 * same names but other fields, and cannot be decoded. */
int wire_type_old_version(int64_t fingerprint);

/* Returns why a message with another fingerprint than expected cannot be read. Static text. */
const char *wire_type_mismatch(int64_t fingerprint);

#endif
