/* Ids that nobody hands out: of services, of clients, and where keys start to count. */
#ifndef RANDOM_ID_H
#define RANDOM_ID_H

#include <stdint.h>

/* A random number from 1 to 2^53 - 1 (QUERY_ID_MAX). Where the system has none (Linux before
 * 3.17): the time in microseconds, which is as good as different. */
int64_t random_id(void);

#endif
