/* A line that shows the progress of long work, on a terminal only. For one thread. */
#ifndef PROGRESS_H
#define PROGRESS_H

#include <stdint.h>

/* Programs call this first. Without it, as in libraries, nothing is shown. */
void progress_allow(void);

/* Begins a count of things such as "bytes", in place of any earlier one. Nothing is shown unless
 * standard error is a terminal. unit must live as long as the count. */
void progress_begin(const char *unit);

/* Sets what is done, of how much. The line is shown after the first second, then a few times a
 * second. Has no effect if no count has begun. */
void progress_to(int64_t done, int64_t total);

/* Shows this text at once, if a count has begun. */
void progress_show(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Clears the line. complain() does so too; the line may appear again after that. */
void progress_clear(void);

/* Clears the line, and ends the count. */
void progress_end(void);

#endif
