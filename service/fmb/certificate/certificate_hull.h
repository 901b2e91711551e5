/* Certificates of pairs with a hull. */
#ifndef FMB_CERTIFICATE_HULL_H
#define FMB_CERTIFICATE_HULL_H

#include "pair.h"

#include <gmp.h>

struct certificate_writer {
    char text[FMB_CERTIFICATE_MAX];
    size_t length; /* of all that was written, beyond the end of text too */
};

/* Append to the text what fits. */
void certificate_write_text(struct certificate_writer *writer, const char *text);
void certificate_write_number(struct certificate_writer *writer, const mpq_t number);

/* Writes the certificate of a pair with a hull; nothing if its numbers span too many bits. */
void certificate_hull_write(struct certificate_writer *writer, const struct frame_pair *pair);

/* The span that fmb.h defines, in bits. Fractions of more would take milliseconds each to reduce.
 */
enum { CERTIFICATE_SPAN_MAX = 512 };

#endif
