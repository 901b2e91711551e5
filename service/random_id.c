#include "random_id.h"

#include "query.h"

#include <sys/random.h>
#include <time.h>

int64_t random_id(void)
{
    uint64_t bits;
    if (getrandom(&bits, sizeof bits, 0) != (ssize_t) sizeof bits) {
        struct timespec now;
        clock_gettime(CLOCK_REALTIME, &now);
        bits = (uint64_t) now.tv_sec * 1000000 + (uint64_t) now.tv_nsec / 1000;
    }
    int64_t id = (int64_t) (bits & (uint64_t) QUERY_ID_MAX);
    return id ? id : 1;
}
