/* echo URL: what a program on the bus takes that does nothing. Replies with as many bytes as it is
 * asked for, and that is all; its bus is opened as fmbd opens it. Ends when it is killed. */
#include "echo.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bus.h"
#include "bytes.h"

/* As long as that of fmbd. */
enum { LCM_QUEUE = 4096 };

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
    const uint32_t size = (uint32_t) bytes_get(request, 4);
    if (size < ECHO_BYTES_MIN || size > ECHO_BYTES_MAX)
        return;
    memcpy(reply, request + ECHO_ID_AT, 8);
    bytes_put(reply + ECHO_COUNT_AT, requests, 8);
    lcm_publish(lcm, ECHO_RESULT, reply, size);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fputs("usage: echo URL\n", stderr);
        return 2;
    }
    lcm_t *lcm = bus_open("echo", argv[1], NULL);
    if (!lcm || !bus_subscribe(lcm, ECHO_QUERY, on_query, lcm, LCM_QUEUE))
        return EXIT_FAILURE;
    while (lcm_handle(lcm) == 0)
        ;
    return EXIT_FAILURE;
}
