#include "bus.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

/* LCM's usual group and port. */
#define DEFAULT_GROUP "239.255.76.67"
#define USUAL_URL "udpm://" DEFAULT_GROUP ":7667?ttl=0"
enum { DEFAULT_PORT = 7667 };

static const char scheme[] = "udpm://";

/* Of a URL, and how much of it is told. */
enum { URL_MAX = 512, URL_SHOWN = 400 };

/* Asked for where the URL names no receive buffer: holds some 60 of the largest datagrams, or
 * thousands of pair queries. */
enum { RECEIVE_BUFFER_WANTED = 4 << 20 };

bool bus_prefix_ok(const char *prefix)
{
    static const char allowed[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
    size_t length = strlen(prefix);
    return length <= BUS_PREFIX_MAX && strspn(prefix, allowed) == length;
}

void bus_channel(char out[BUS_CHANNEL_MAX], const char *prefix, const char *name)
{
    snprintf(out, BUS_CHANNEL_MAX, "%s%s", prefix, name);
}

/* What SO_RCVBUF reads back as after this was asked for: what LCM's own socket gets. */
static long receive_buffer_granted(long wanted)
{
    int granted = 0, ask = (int) wanted;
    socklen_t size = sizeof granted;
    int fd = socket(AF_INET, SOCK_DGRAM, 0);
    if (fd < 0)
        return 0;
    bool ok = setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &ask, sizeof ask) == 0 &&
              getsockopt(fd, SOL_SOCKET, SO_RCVBUF, &granted, &size) == 0;
    close(fd);
    return ok ? granted : 0;
}

/* The largest receive buffer to ask for, up to what is wanted: asking for more than the system
 * grants makes LCM warn. Linux grants twice what is asked, within its limit. */
static long receive_buffer_to_ask(void)
{
    return receive_buffer_granted(RECEIVE_BUFFER_WANTED) / 2;
}

enum group_kind { GROUP_GOOD, GROUP_WITHOUT_PORT, GROUP_OF_OTHERS };

/* udpm://[GROUP:PORT][?options]. OF_OTHERS: another provider, or what is no address; that is left
 * to LCM. WITHOUT_PORT: LCM would take a port of its own choice, and hear nobody. */
static enum group_kind parse_group(const char *url, struct sockaddr_in *group)
{
    char text[64];
    unsigned port = DEFAULT_PORT;
    if (strncmp(url, scheme, sizeof scheme - 1) != 0)
        return GROUP_OF_OTHERS;
    url += sizeof scheme - 1;
    size_t length = strcspn(url, ":?");
    if (length >= sizeof text)
        return GROUP_OF_OTHERS;
    memcpy(text, url, length);
    text[length] = '\0';
    if (length && sscanf(url + length, ":%5u", &port) != 1)
        return GROUP_WITHOUT_PORT;
    *group = (struct sockaddr_in){.sin_family = AF_INET, .sin_port = htons((uint16_t) port)};
    return inet_pton(AF_INET, length ? text : DEFAULT_GROUP, &group->sin_addr) == 1
               ? GROUP_GOOD
               : GROUP_OF_OTHERS;
}

static long parse_receive_buffer(const char *url)
{
    const char *option = strstr(url, "recv_buf_size=");
    return option ? strtol(option + strlen("recv_buf_size="), NULL, 10) : 0;
}

/* 0 if the system can send there; else errno. Sends nothing. */
static int route_error(const struct sockaddr_in *group)
{
    int fd = socket(AF_INET, SOCK_DGRAM, 0);
    if (fd < 0)
        return errno;
    int error = connect(fd, (const struct sockaddr *) group, sizeof *group) ? errno : 0;
    close(fd);
    return error;
}

static bool check_route(const char *url, char why[BUS_WHY_MAX])
{
    struct sockaddr_in group;
    switch (parse_group(url, &group)) {
    case GROUP_OF_OTHERS: return true;
    case GROUP_WITHOUT_PORT:
        snprintf(why, BUS_WHY_MAX, "the LCM bus %.*s has no port: write udpm://GROUP:%d", URL_SHOWN,
                 url, DEFAULT_PORT);
        return false;
    case GROUP_GOOD: break;
    }
    int error = route_error(&group);
    if (!error)
        return true;
    char text[INET_ADDRSTRLEN];
    inet_ntop(AF_INET, &group.sin_addr, text, sizeof text);
    snprintf(why, BUS_WHY_MAX,
             "no route to the multicast group %s (%s); to keep the bus on this host, run:\n"
             "  sudo ip link set lo up multicast on && sudo ip route add 224.0.0.0/4 dev lo",
             text, strerror(error));
    return false;
}

/* The URL to open: as given, or the usual one; where it is udpm and names no receive buffer, with
 * as much as the system grants. */
static void complete_url(const char *url, char out[URL_MAX])
{
    if (!url)
        url = getenv("LCM_DEFAULT_URL");
    if (!url || !*url)
        url = USUAL_URL;
    if (strncmp(url, scheme, sizeof scheme - 1) == 0 && !strstr(url, "recv_buf_size="))
        snprintf(out, URL_MAX, "%s%crecv_buf_size=%ld", url, strchr(url, '?') ? '&' : '?',
                 receive_buffer_to_ask());
    else
        snprintf(out, URL_MAX, "%s", url);
}

lcm_t *bus_open_or_why(const char *url, long *receive_buffer, char why[BUS_WHY_MAX])
{
    char full[URL_MAX];
    complete_url(url, full);
    long asked = parse_receive_buffer(full);
    if (receive_buffer)
        *receive_buffer = asked > 0 ? receive_buffer_granted(asked) : 0;
    if (!check_route(full, why))
        return NULL;

    lcm_t *lcm = lcm_create(full);
    if (!lcm) {
        snprintf(why, BUS_WHY_MAX, "cannot open the LCM bus %.*s", URL_SHOWN, full);
        return NULL;
    }
    if (lcm_get_fileno(lcm) < 0) { /* tcpq without a server; udpm that does not hear itself */
        snprintf(why, BUS_WHY_MAX,
                 "nothing comes through the LCM bus %.*s: no server, or a firewall?", URL_SHOWN,
                 full);
        lcm_destroy(lcm);
        return NULL;
    }
    return lcm;
}

lcm_subscription_t *bus_subscribe(lcm_t *lcm, const char *channel, lcm_msg_handler_t handler,
                                  void *user, int queue)
{
    lcm_subscription_t *subscription = lcm_subscribe(lcm, channel, handler, user);
    if (!subscription || lcm_subscription_set_queue_capacity(subscription, queue) == 0)
        return subscription;
    lcm_unsubscribe(lcm, subscription);
    return NULL;
}
