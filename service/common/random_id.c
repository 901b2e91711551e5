#include "random_id.h"

#include "clock.h"
#include "query.h"

#include <sys/random.h>

int64_t random_id(void)
{
    uint64_t bits;
    if (getrandom(&bits, sizeof bits, 0) != (ssize_t) sizeof bits)
        bits = (uint64_t) clock_utime();
    int64_t id = (int64_t) (bits & (uint64_t) QUERY_ID_MAX);
    return id ? id : 1;
}
