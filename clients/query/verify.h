/* A verdict that comes with a certificate need not be trusted, wherever it comes from. */
#ifndef VERIFY_H
#define VERIFY_H

#include "report.h"

enum { VERIFY_TEXT_MAX = 256 };

/* On input: an outcome with a certificate; whose: "the", or "the service's".
 * On output: the outcome as it was, where its certificate shows its verdict from the numbers of the
 * scene; else without an answer, and with an error, which stands in text. */
void verify_outcome(const struct scene *scene, const char *whose, struct outcome *outcome,
                    char text[VERIFY_TEXT_MAX]);

#endif
