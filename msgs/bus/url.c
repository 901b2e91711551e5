#define _GNU_SOURCE /* strsep */
#include "url.h"

#include <arpa/inet.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char scheme[] = "udpm://";

/* LCM's default group and port. */
#define DEFAULT_GROUP "239.255.76.67"
enum { DEFAULT_PORT = 7667 };

enum {
    /* Holds about 120 of the largest datagrams, or thousands of pair queries. */
    DEFAULT_RECEIVE_BUFFER = 4 << 20,
    RECEIVE_BUFFER_MAX = INT_MAX / 2, /* the kernel doubles it */
    URL_MAX = 200                     /* of the longest URL that is accepted, final 0 included */
};

/* Parses an integer from min to max. text: NULL: there is none. Options have base 0, since liblcm
 * accepts 0x10 and 010 there. */
static bool parse_number(const char *text, int base, int min, int max, int *out)
{
    char *end;
    errno = 0;
    const long value = text && *text >= '0' && *text <= '9' ? strtol(text, &end, base) : -1;
    *out = (int) value;
    return value >= min && value <= max && errno == 0 && !*end;
}

/* GROUP:PORT */
static bool parse_address(char *text, struct sockaddr_in *out)
{
    const char *group = strsep(&text, ":");
    int port;
    if (inet_pton(AF_INET, group, &out->sin_addr) != 1 ||
        !IN_MULTICAST(ntohl(out->sin_addr.s_addr)) || !parse_number(text, 10, 1, 65535, &port))
        return false;
    out->sin_port = htons((uint16_t) port);
    return true;
}

/* NAME=VALUE */
static bool parse_option(char *value, struct bus_url *out)
{
    const char *name = strsep(&value, "=");
    if (strcmp(name, "ttl") == 0)
        return parse_number(value, 0, 0, 255, &out->ttl);
    return strcmp(name, "recv_buf_size") == 0 &&
           parse_number(value, 0, 1, RECEIVE_BUFFER_MAX, &out->receive_buffer);
}

bool bus_url_parse(const char *url, struct bus_url *out, char why[BUS_WHY_MAX])
{
    char copy[URL_MAX], *options = copy + sizeof scheme - 1;
    bool good = strncmp(url, scheme, sizeof scheme - 1) == 0 && strlen(url) < URL_MAX;
    *out = (struct bus_url){.group = {.sin_family = AF_INET, .sin_port = htons(DEFAULT_PORT)},
                            .receive_buffer = DEFAULT_RECEIVE_BUFFER};
    inet_pton(AF_INET, DEFAULT_GROUP, &out->group.sin_addr);
    snprintf(copy, sizeof copy, "%s", url);
    char *address = good ? strsep(&options, "?") : NULL;
    good = good && (!*address || parse_address(address, &out->group));
    if (good && options && !*options)
        options = NULL;
    while (good && options)
        good = parse_option(strsep(&options, "&"), out);
    if (!good)
        snprintf(why, BUS_WHY_MAX,
                 "'%.*s' is not an LCM bus URL: write %s%s:%d?ttl=0; the group is 224.0.0.0 to "
                 "239.255.255.255, the port 1 to 65535, ttl 0 to 255 (1 or more reaches other "
                 "hosts), and &recv_buf_size=BYTES is 1 to %d",
                 URL_MAX, url, scheme, DEFAULT_GROUP, DEFAULT_PORT, RECEIVE_BUFFER_MAX);
    return good;
}
