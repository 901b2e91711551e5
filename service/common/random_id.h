/* Random ids for services and clients. */
#ifndef RANDOM_ID_H
#define RANDOM_ID_H

#include <stdint.h>

/* Returns a random number from 1 to 2^53 - 1 (QUERY_ID_MAX); if the system has no getrandom()
 * (Linux before 3.17), the time in microseconds. */
int64_t random_id(void);

#endif
