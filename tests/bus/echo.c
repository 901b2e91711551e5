/* echo URL: the least that a program over liblcm costs. It replies with as many bytes as a request
 * names, and computes nothing. Runs until it is killed. */
#include "echo.h"

#include <lcm/lcm.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "big_endian.h"

static uint64_t requests;
static unsigned char reply[ECHO_BYTES_MAX];

static void on_query(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    const unsigned char *request = buffer->data;
    lcm_t *lcm = user;
    (void) channel;
    if (buffer->data_size < ECHO_BYTES_MIN || buffer->data_size > ECHO_BYTES_MAX)
        return;
    requests++;
    const uint32_t size = big_endian_32(request);
    if (size < ECHO_BYTES_MIN || size > ECHO_BYTES_MAX)
        return;
    memcpy(reply, request + ECHO_ID_AT, 8);
    big_endian_put_64(reply + ECHO_COUNT_AT, requests);
    lcm_publish(lcm, ECHO_RESULT, reply, size);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fputs("usage: echo URL\n", stderr);
        return 2;
    }
    lcm_t *lcm = lcm_create(argv[1]);
    lcm_subscription_t *queries = lcm ? lcm_subscribe(lcm, ECHO_QUERY, on_query, lcm) : NULL;
    if (!queries || lcm_subscription_set_queue_capacity(queries, ECHO_QUEUE) != 0)
        return EXIT_FAILURE;
    while (lcm_handle(lcm) == 0)
        ;
    return EXIT_FAILURE;
}
