/* Certificates of pairs with a hull, in steps. */
#ifndef FMB_CERTIFICATE_HULL_H
#define FMB_CERTIFICATE_HULL_H

#include "certificate_writer.h"
#include "hull_exact.h"

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

#endif
