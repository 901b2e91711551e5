/* Calls of a progress function, which a test counts. */
#ifndef PROGRESS_SEEN_H
#define PROGRESS_SEEN_H

#include <stdint.h>

struct progress_seen {
    int times;
    int64_t done, total; /* of the last call */
};

/* Progress never decreases, and the total never changes. context: struct progress_seen. */
static inline void progress_seen(void *context, int64_t done, int64_t total)
{
    struct progress_seen *seen = context;
    assert_true(done >= seen->done && done <= total);
    assert_true(seen->times == 0 || total == seen->total);
    *seen = (struct progress_seen){seen->times + 1, done, total};
}

#endif
