/* poke CHANNEL TYPE: publishes every damaged message of the type on the channel, and prints
 * how many there were. The bus is that of LCM_DEFAULT_URL. */
#include "hostile.h"

#include <lcm/lcm.h>
#include <stdio.h>
#include <time.h>

struct poke {
    lcm_t *lcm;
    const char *channel;
    size_t failed;
};

/* Slow enough that no buffer overflows: the receiver counts them all. */
static void publish(void *context, const char *what, const unsigned char *bytes, size_t size)
{
    struct poke *poke = context;
    const struct timespec pause = {.tv_nsec = 200000};
    (void) what;
    if (lcm_publish(poke->lcm, poke->channel, bytes, (unsigned) size) != 0)
        poke->failed++;
    nanosleep(&pause, NULL);
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fputs("usage: poke CHANNEL pair_query|pair_result|status\n", stderr);
        return 2;
    }
    struct poke poke = {.lcm = lcm_create(NULL), .channel = argv[1]};
    if (!poke.lcm)
        return 1;
    printf("%zu\n", hostile_each(argv[2], publish, &poke));
    lcm_destroy(poke.lcm);
    return poke.failed != 0;
}
