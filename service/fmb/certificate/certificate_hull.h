/* Certificates of pairs with a hull, in steps. */
#ifndef FMB_CERTIFICATE_HULL_H
#define FMB_CERTIFICATE_HULL_H

#include "hull_exact.h"

struct certificate_writer {
    char text[FMB_CERTIFICATE_MAX];
    size_t length; /* of all that was written, beyond the end of text too */
};

/* Append to the text what fits. */
void certificate_write_text(struct certificate_writer *writer, const char *text);
void certificate_write_number(struct certificate_writer *writer, const mpq_t number);

/* A certificate in progress. It points into itself: not to be copied. */
struct certificate_hull {
    struct frame_pair frames;
    struct hull_pair pair;
    struct hull_exact *exact; /* NULL: complete */
    enum {
        CERTIFICATE_DECIDING,
        CERTIFICATE_POINT,
        CERTIFICATE_WEIGHTS_A,
        CERTIFICATE_WEIGHTS_B
    } part; /* of the next step */
};

/* Begins the certificate of a pair with a hull. Returns whether it is complete: in writer, which is
 * empty before; it remains so if the numbers span too many bits. */
bool certificate_hull_begin(const struct frame_pair *frames, struct certificate_writer *writer,
                            struct certificate_hull *out);

/* Performs a step of a certificate that is not complete. Returns whether it is complete then. */
bool certificate_hull_step(struct certificate_hull *hull, struct certificate_writer *writer);

/* Frees the memory of a certificate, complete or not. */
void certificate_hull_end(struct certificate_hull *hull);

/* The span that fmb.h defines, in bits. Fractions of more would take milliseconds each to reduce.
 */
enum { CERTIFICATE_SPAN_MAX = 512 };

#endif
