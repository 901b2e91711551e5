#include "receivers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { HELD_MAX = 212992 / 6, PORT = 7667, WAITS_MAX = 60000 };

static unsigned port_of_bus(void)
{
    const char *url = getenv("LCM_DEFAULT_URL");
    const char *port = url ? strrchr(url, ':') : NULL;
    return port && atoi(port + 1) > 0 ? (unsigned) atoi(port + 1) : PORT;
}

/* The largest queue of a socket on the port, bytes as the kernel counts them (proc(5)). */
static unsigned long largest_queue(unsigned port)
{
    FILE *file = fopen("/proc/net/udp", "r");
    unsigned long largest = 0;
    char line[256];
    while (file && fgets(line, sizeof line, file)) {
        unsigned at;
        unsigned long held;
        if (sscanf(line, "%*d: %*x:%x %*x:%*x %*x %*x:%lx", &at, &held) == 2 && at == port)
            largest = held > largest ? held : largest;
    }
    if (file)
        fclose(file);
    return largest;
}

bool receivers_wait(void)
{
    const unsigned port = port_of_bus();
    const struct timespec pause = {.tv_nsec = 1000000};
    for (int i = 0; largest_queue(port) > HELD_MAX; i++)
        if (i == WAITS_MAX || nanosleep(&pause, NULL) != 0)
            return false;
    return true;
}
