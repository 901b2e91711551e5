#include <stdarg.h> /* before gmp.h, which then declares functions of a va_list */

#include "certificate_text.h"

#include <stdio.h>

void certificate_write_text(struct certificate_writer *writer, const char *format, ...)
{
    const size_t used = writer->length < FMB_CERTIFICATE_MAX ? writer->length : FMB_CERTIFICATE_MAX;
    va_list values;
    va_start(values, format);
    writer->length +=
        (size_t) gmp_vsnprintf(writer->text + used, FMB_CERTIFICATE_MAX - used, format, values);
    va_end(values);
}

void certificate_write_number(struct certificate_writer *writer, const mpq_t number)
{
    certificate_write_text(writer, "%Qd", number);
}
