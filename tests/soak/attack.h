/* Clients that cost a service as much as they can, each in a process of its own. */
#ifndef ATTACK_H
#define ATTACK_H

#include <stdint.h>
#include <sys/types.h>

struct attack {
    const char *name;
    long rate;   /* queries a second; 0: the next query of an id follows an answer to it */
    long window; /* queries of each id under way, where the rate is 0 */
};

extern const struct attack attacks[];
extern const int attack_count;

/* The attack with this name; NULL: there is none. */
const struct attack *attack_find(const char *name);

/* Starts an attack from this number of client ids, numbered from first_id, on the bus with this URL
 * (NULL: see bus_open()). Returns the process, to be ended with attack_end(). */
pid_t attack_start(const struct attack *attack, long ids, int64_t first_id, const char *url);
void attack_end(pid_t process);

#endif
