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
enum { DEFAULT_PORT = 7667 };

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
    bool ok = (wanted == 0 || setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &ask, sizeof ask) == 0) &&
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

/* udpm://[GROUP[:PORT]][?options]. False: another provider, or a group that is no address,
 * which is left to LCM. */
static bool parse_group(const char *url, struct sockaddr_in *group)
{
    static const char scheme[] = "udpm://";
    char text[64];
    unsigned port = DEFAULT_PORT;
    if (strncmp(url, scheme, sizeof scheme - 1) != 0)
        return false;
    url += sizeof scheme - 1;
    size_t length = strcspn(url, ":?");
    if (length >= sizeof text)
        return false;
    memcpy(text, url, length);
    text[length] = '\0';
    if (url[length] == ':' && sscanf(url + length, ":%5u", &port) != 1)
        return false;
    *group = (struct sockaddr_in){.sin_family = AF_INET, .sin_port = htons((uint16_t) port)};
    return inet_pton(AF_INET, length ? text : DEFAULT_GROUP, &group->sin_addr) == 1;
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

static bool check_route(const char *program, const char *url)
{
    struct sockaddr_in group;
    if (!parse_group(url, &group))
        return true;
    int error = route_error(&group);
    if (!error)
        return true;
    char text[INET_ADDRSTRLEN];
    inet_ntop(AF_INET, &group.sin_addr, text, sizeof text);
    fprintf(stderr,
            "%s: no route to the multicast group %s (%s); to keep the bus on this host, run:\n"
            "%s:   sudo ip link set lo up multicast on && sudo ip route add 224.0.0.0/4 dev lo\n",
            program, text, strerror(error), program);
    return false;
}

lcm_t *bus_open(const char *program, const char *url, long *receive_buffer)
{
    char usual[96];
    if (!url)
        url = getenv("LCM_DEFAULT_URL");
    if (!url || !*url) {
        snprintf(usual, sizeof usual, "udpm://%s:%d?ttl=0&recv_buf_size=%ld", DEFAULT_GROUP,
                 DEFAULT_PORT, receive_buffer_to_ask());
        url = usual;
    }
    if (receive_buffer)
        *receive_buffer =
            strncmp(url, "udpm:", 5) == 0 ? receive_buffer_granted(parse_receive_buffer(url)) : 0;
    if (!check_route(program, url))
        return NULL;

    lcm_t *lcm = lcm_create(url);
    if (!lcm) {
        fprintf(stderr, "%s: cannot open the LCM bus %s\n", program, url);
        return NULL;
    }
    if (lcm_get_fileno(lcm) < 0) { /* tcpq without a server behind it */
        fprintf(stderr, "%s: the LCM bus %s is there in name only: is its server running?\n",
                program, url);
        lcm_destroy(lcm);
        return NULL;
    }
    return lcm;
}
