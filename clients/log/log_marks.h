/* A mark for each event of a log, a bit, whatever the number of events: but for a part of them they
 * lie in a temporary file (temporary.h). Quick where marks that are set or asked one after the
 * other are near each other. */
#ifndef LOG_MARKS_H
#define LOG_MARKS_H

#include <stdbool.h>
#include <stdint.h>

struct log_marks;

/* All events are without a mark. Never NULL: ends the program where there is no memory. */
struct log_marks *log_marks_open(void);
void log_marks_close(struct log_marks *marks); /* may be NULL */

/* event: its number, from 0. */
void log_marks_set(struct log_marks *marks, int64_t event);
bool log_marks_has(struct log_marks *marks, int64_t event);

/* errno of the first failure of the file; 0: none, and all that was said is right. */
int log_marks_error(const struct log_marks *marks);

#endif
