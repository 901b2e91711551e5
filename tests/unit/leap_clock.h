/* The clock of the product, which a test can put forward: a time that is over costs no time. A test
 * links leap_clock.o (tests.mk) in place of the product's clock. */
#ifndef LEAP_CLOCK_H
#define LEAP_CLOCK_H

#include "clock.h"

/* From any thread. */
void clock_leap(int64_t ns);

#endif
