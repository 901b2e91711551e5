/* The names of the types of msgs/, by what messages of them begin with. */
#ifndef WIRE_TYPE_H
#define WIRE_TYPE_H

#include <stdint.h>

/* "fmb_msgs.pair_query_t"; NULL: the fingerprint is of no type of this version. */
const char *wire_type_name(int64_t fingerprint);

#endif
