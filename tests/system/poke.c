/* What no service and no client sends. The bus is that of LCM_DEFAULT_URL.
 *
 * poke CHANNEL TYPE: publishes every damaged message of the type on the channel, and prints how
 * many there were.
 * poke lie CERTIFICATE: a service that says of every pair, with this certificate, that it
 * overlaps; until it is ended. */
#include "hostile.h"

#include <lcm/lcm.h>
#include <stdio.h>
#include <string.h>
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

static int damage(lcm_t *lcm, const char *channel, const char *type)
{
    struct poke poke = {.lcm = lcm, .channel = channel};
    printf("%zu\n", hostile_each(type, publish, &poke));
    return poke.failed != 0;
}

struct liar {
    lcm_t *lcm;
    char *certificate;
};

static void on_query(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct liar *liar = user;
    unsigned char bytes[HOSTILE_BYTES_MAX];
    size_t size = hostile_lie(buffer->data, buffer->data_size, liar->certificate, bytes);
    (void) channel;
    if (size > 0)
        lcm_publish(liar->lcm, "FMB_PAIR_RESULT", bytes, (unsigned) size);
}

static int lie(lcm_t *lcm, char *certificate)
{
    struct liar liar = {.lcm = lcm, .certificate = certificate};
    lcm_subscribe(lcm, "FMB_PAIR_QUERY", on_query, &liar);
    while (lcm_handle(lcm) == 0)
        continue;
    return 1;
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fputs("usage: poke CHANNEL pair_query|pair_result|status, or poke lie CERTIFICATE\n",
              stderr);
        return 2;
    }
    lcm_t *lcm = lcm_create(NULL);
    if (!lcm)
        return 1;
    int code = strcmp(argv[1], "lie") == 0 ? lie(lcm, argv[2]) : damage(lcm, argv[1], argv[2]);
    lcm_destroy(lcm);
    return code;
}
