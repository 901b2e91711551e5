/* The product's clock, which a test can advance, so that it need not wait. A test links
 * leap_clock.o (tests.mk) in place of the product's clock. */
#ifndef LEAP_CLOCK_H
#define LEAP_CLOCK_H

#include "clock.h"

/* From any thread. */
void clock_leap(int64_t ns);

#endif
