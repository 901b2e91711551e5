/* The names of the message types, by fingerprint. */
#ifndef WIRE_TYPE_H
#define WIRE_TYPE_H

#include <stdint.h>

/* Returns a static text such as "fmb_msgs.pair_query_t"; NULL if no type has this
 * fingerprint. */
const char *wire_type_name(int64_t fingerprint);

#endif
