/* Checks certificates, so that a verdict need not be trusted. */
#ifndef VERIFY_H
#define VERIFY_H

#include "report.h"

enum { VERIFY_TEXT_MAX = 256 };

/* Checks the certificate of an outcome against the numbers of the scene. If it does not hold, the
 * outcome loses its answer, and gets an error, written into text. whose: "the" or "the service's",
 * for that error. */
void verify_outcome(const struct scene *scene, const char *whose, struct outcome *outcome,
                    char text[VERIFY_TEXT_MAX]);

#endif
