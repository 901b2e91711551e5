/* A bad network between two buses of LCM on this host: carries datagrams over, but for those that
 * it loses, and overtakes some. For systems whose kernel has no netem.
 *
 * soak-relay PORT PORT LOST HELD: between the multicast groups 239.255.76.67 at both ports, loses
 * LOST percent of the datagrams, and holds back HELD percent until the next one has passed. Until
 * it is ended.
 */
#define _DEFAULT_SOURCE /* struct ip_mreq */

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <poll.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>

enum { DATAGRAM_MAX = 65536 };

static const char group[] = "239.255.76.67";

struct side {
    int in, out; /* sockets */
    struct sockaddr_in to;
    in_port_t own_port; /* from which out sends */
    size_t held;        /* bytes of a datagram that is held back; 0: none */
    unsigned char datagram[DATAGRAM_MAX];
};

static bool open_side(struct side *side, const char *port)
{
    const int one = 1, buffer = 4 << 20;
    const unsigned char ttl = 0;
    struct sockaddr_in own = {0};
    socklen_t size = sizeof own;
    side->to =
        (struct sockaddr_in){.sin_family = AF_INET, .sin_port = htons((uint16_t) atoi(port))};
    side->to.sin_addr.s_addr = inet_addr(group);
    struct sockaddr_in any = side->to;
    any.sin_addr.s_addr = htonl(INADDR_ANY);
    const struct ip_mreq membership = {.imr_multiaddr = side->to.sin_addr};
    side->in = socket(AF_INET, SOCK_DGRAM, 0);
    side->out = socket(AF_INET, SOCK_DGRAM, 0);
    const bool good =
        setsockopt(side->in, SOL_SOCKET, SO_REUSEADDR, &one, sizeof one) == 0 &&
        setsockopt(side->in, SOL_SOCKET, SO_RCVBUF, &buffer, sizeof buffer) == 0 &&
        bind(side->in, (const struct sockaddr *) &any, sizeof any) == 0 &&
        setsockopt(side->in, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) == 0 &&
        setsockopt(side->out, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl) == 0 &&
        connect(side->out, (const struct sockaddr *) &side->to, sizeof side->to) == 0 &&
        getsockname(side->out, (struct sockaddr *) &own, &size) == 0;
    side->own_port = own.sin_port;
    return good;
}

static bool falls(int percent)
{
    return rand() % 100 < percent;
}

/* What came on one side goes out on the other; what this relay sent there itself does not. */
static void carry(struct side *from, struct side *to, int lost, int held)
{
    unsigned char bytes[DATAGRAM_MAX];
    struct sockaddr_in sender = {0};
    socklen_t size = sizeof sender;
    const ssize_t count =
        recvfrom(from->in, bytes, sizeof bytes, 0, (struct sockaddr *) &sender, &size);
    if (count <= 0 || sender.sin_port == from->own_port || falls(lost))
        return;
    if (to->held == 0 && falls(held)) {
        to->held = (size_t) count;
        memcpy(to->datagram, bytes, to->held);
        return;
    }
    send(to->out, bytes, (size_t) count, 0);
    if (to->held > 0)
        send(to->out, to->datagram, to->held, 0);
    to->held = 0;
}

int main(int argc, char **argv)
{
    static struct side side[2];
    if (argc != 5) {
        fputs("usage: soak-relay PORT PORT LOST HELD\n", stderr);
        return 2;
    }
    if (!open_side(&side[0], argv[1]) || !open_side(&side[1], argv[2])) {
        perror("soak-relay");
        return EXIT_FAILURE;
    }
    struct pollfd source[2] = {{.fd = side[0].in, .events = POLLIN},
                               {.fd = side[1].in, .events = POLLIN}};
    while (poll(source, 2, -1) > 0 || errno == EINTR)
        for (int i = 0; i < 2; i++)
            if (source[i].revents & POLLIN)
                carry(&side[i], &side[1 - i], atoi(argv[3]), atoi(argv[4]));
    perror("soak-relay: poll");
    return EXIT_FAILURE;
}
