/* The programs at the other end: fmbd and the echo, each on a bus of its own, so that neither
 * receives the messages of the other. */
#ifndef PARTIES_H
#define PARTIES_H

#include <stdbool.h>
#include <sys/types.h>

/* Which CPUs the client and the others run on. */
struct cpus {
    int cores;           /* 1 or 2 */
    int client, service; /* numbers of CPUs */
};

enum { PARTIES_URL_MAX = 96 };

struct parties {
    pid_t service, echo;
    char service_url[PARTIES_URL_MAX], echo_url[PARTIES_URL_MAX];
};

/* The placement on so many cores. False: this program may not use as many. */
bool parties_cpus(int cores, struct cpus *out);

/* Ties this thread, and what it starts from now on, to the client's CPU, and starts fmbd and the
 * echo on the other, beside this program's own file. They end when it does, however that is. False:
 * not possible, and stderr says why. */
bool parties_start(const struct cpus *cpus, struct parties *out);
/* Ends them, by force where they do not within seconds. */
void parties_stop(struct parties *parties);

/* The last line of fmbd's log, for people; "" if there is none. */
const char *parties_log(void);

#endif
