/* The text of a certificate in progress. */
#ifndef FMB_CERTIFICATE_TEXT_H
#define FMB_CERTIFICATE_TEXT_H

#include "fmb.h"

#include <gmp.h>

struct certificate_writer {
    char text[FMB_CERTIFICATE_MAX];
    size_t length; /* of all that was written, including what did not fit */
};

/* Append to the text what fits: formatted as by gmp_printf(), or a number. */
void certificate_write_text(struct certificate_writer *writer, const char *format, ...);
void certificate_write_number(struct certificate_writer *writer, const mpq_t number);

#endif
