/* The text of a certificate in progress, and what both kinds of certificates write. */
#ifndef FMB_CERTIFICATE_WRITER_H
#define FMB_CERTIFICATE_WRITER_H

#include "exact.h"

struct certificate_writer {
    char text[FMB_CERTIFICATE_MAX];
    size_t length; /* of all that was written, beyond the end of text too */
};

/* Append to the text what fits: a number, and " (X Y Z)". */
void certificate_write_text(struct certificate_writer *writer, const char *text);
void certificate_write_number(struct certificate_writer *writer, const mpq_t number);
void certificate_write_vector(struct certificate_writer *writer, int dim, mpq_t v[3]);

/* x := num / den 2^exponent, in lowest terms. */
void certificate_set_scaled(mpq_t x, const mpz_t num, const mpz_t den, long exponent);

/* Writes " at TIME (X Y Z)": a point of both frames at a time of the window, 0 if the pair is
 * static; if they overlap, a point of the relative interiors of both.
 *
 * In: a pair that touches or overlaps, and its conversion to integers. */
void certificate_write_meeting(struct certificate_writer *writer, struct exact_pair *exact,
                               const struct frame_pair *pair);

/* The span that fmb.h defines, in bits. Fractions of more would take milliseconds each to reduce.
 */
enum { CERTIFICATE_SPAN_MAX = 512 };

#endif
