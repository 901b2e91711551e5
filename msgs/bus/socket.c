#define _GNU_SOURCE
#include "socket.h"

#include <arpa/inet.h>
#include <errno.h>
#include <linux/filter.h>
#include <linux/sock_diag.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

bool bus_socket_route(const struct sockaddr_in *group, char why[BUS_WHY_MAX])
{
    char address[INET_ADDRSTRLEN];
    const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (fd < 0) {
        snprintf(why, BUS_WHY_MAX, "cannot open a socket (%s)", strerror(errno));
        return false;
    }
    const bool ok = connect(fd, (const struct sockaddr *) group, sizeof *group) == 0;
    const int error = errno;
    close(fd);
    if (ok)
        return true;
    inet_ntop(AF_INET, &group->sin_addr, address, sizeof address);
    snprintf(why, BUS_WHY_MAX,
             "no route to the multicast group %s (%s); to keep the bus on this host, run: "
             "sudo ip link set lo up multicast on && sudo ip route add 224.0.0.0/4 dev lo",
             address, strerror(error));
    return false;
}

/* Requests a receive buffer: beyond the system's limit if the process is privileged, else up to it.
 * Returns the bytes that were granted. */
static long set_receive_buffer(int fd, int bytes)
{
    int granted = 0;
    socklen_t size = sizeof granted;
    if (setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes) != 0)
        setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
    getsockopt(fd, SOL_SOCKET, SO_RCVBUF, &granted, &size);
    return granted;
}

/* Binds the socket to the group and joins it. With SO_REUSEADDR every socket that is bound to the
 * group receives each datagram; with SO_REUSEPORT the kernel could choose one of them. */
static bool join(int fd, const struct sockaddr_in *group)
{
    const int on = 1;
    const struct ip_mreq membership = {.imr_multiaddr = group->sin_addr,
                                       .imr_interface = {htonl(INADDR_ANY)}};
    return setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) == 0 &&
           bind(fd, (const struct sockaddr *) group, sizeof *group) == 0 &&
           setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) == 0;
}

int bus_socket_open(const struct bus_url *url, long *granted, char why[BUS_WHY_MAX])
{
    char address[INET_ADDRSTRLEN];
    const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (fd >= 0) {
        *granted = set_receive_buffer(fd, url->receive_buffer);
        if (join(fd, &url->group))
            return fd;
    }
    const int error = errno;
    if (fd >= 0)
        close(fd);
    inet_ntop(AF_INET, &url->group.sin_addr, address, sizeof address);
    snprintf(why, BUS_WHY_MAX, "cannot receive from the multicast group %s:%d (%s)", address,
             ntohs(url->group.sin_port), strerror(error));
    return -1;
}

uint32_t bus_socket_drops(int fd)
{
    uint32_t info[SK_MEMINFO_VARS] = {0};
    socklen_t size = sizeof info;
    return getsockopt(fd, SOL_SOCKET, SO_MEMINFO, info, &size) == 0 ? info[SK_MEMINFO_DROPS] : 0;
}

/* ---- Truncating datagrams on other channels ----
 *
 * A classic BPF program, which runs on the UDP header and payload of each datagram and returns the
 * number of bytes to keep:
 *
 *     if the length is less than BUS_SOCKET_TRIM_FROM: return WHOLE
 *     if the magic number is that of a fragment: return FRAGMENT
 *     for each channel: if the channel name, final 0 included, is equal: return WHOLE
 *     return TRIMMED
 */

enum {
    TRIMMED = 8 + BUS_SOCKET_TRIMMED,   /* bytes kept, UDP header included */
    FRAGMENT = 8 + BUS_SOCKET_FRAGMENT, /* the same, of a fragment */
    MAGIC_AT = 8,                       /* offset of the magic number, after the UDP header */
    FRAGMENT_MAGIC = 0x4c433033,        /* "LC03" */
    NAME_AT = MAGIC_AT + 8,             /* offset of the channel name of a whole message */
    WHOLE = 1 << 20,                    /* more bytes than any datagram has */
    /* Instructions to compare a name: two for each word, two for each byte that remains, and a
     * return. */
    PER_CHANNEL_MAX = 2 * (BUS_CHANNEL_MAX / 4 + 3) + 1,
    PROGRAM_MAX = 6 + BUS_LISTENERS_MAX * PER_CHANNEL_MAX + 1
};

struct program {
    struct sock_filter code[PROGRAM_MAX];
    int length;
};

static void add(struct program *program, struct sock_filter instruction)
{
    program->code[program->length++] = instruction;
}

/* Adds: load size bytes at an offset; if they differ from value, jump to instruction `end`. */
static void add_comparison(struct program *program, int size, int at, uint32_t value, int end)
{
    add(program, (struct sock_filter) BPF_STMT(BPF_LD | BPF_ABS | size, (uint32_t) at));
    const int skipped = end - program->length - 1;
    add(program, (struct sock_filter) BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0,
                                               (unsigned char) skipped));
}

/* Adds: if the datagram is on this channel, return WHOLE. */
static void add_channel(struct program *program, const char *name)
{
    const int size = (int) strlen(name) + 1, words = size / 4;
    const int end = program->length + 2 * (words + size % 4) + 1;
    for (int i = 0; i < 4 * words; i += 4) {
        const unsigned char *at = (const unsigned char *) name + i;
        const uint32_t word =
            (uint32_t) at[0] << 24 | (uint32_t) at[1] << 16 | (uint32_t) at[2] << 8 | at[3];
        add_comparison(program, BPF_W, NAME_AT + i, word, end);
    }
    for (int i = 4 * words; i < size; i++)
        add_comparison(program, BPF_B, NAME_AT + i, (unsigned char) name[i], end);
    add(program, (struct sock_filter) BPF_STMT(BPF_RET | BPF_K, WHOLE));
}

void bus_socket_trim(int fd, const char *const channels[], int count)
{
    struct program program = {.length = 0};
    add(&program, (struct sock_filter) BPF_STMT(BPF_LD | BPF_W | BPF_LEN, 0));
    add(&program,
        (struct sock_filter) BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, BUS_SOCKET_TRIM_FROM, 1, 0));
    add(&program, (struct sock_filter) BPF_STMT(BPF_RET | BPF_K, WHOLE));
    add_comparison(&program, BPF_W, MAGIC_AT, FRAGMENT_MAGIC, program.length + 3);
    add(&program, (struct sock_filter) BPF_STMT(BPF_RET | BPF_K, FRAGMENT));
    for (int i = 0; i < count; i++)
        add_channel(&program, channels[i]);
    add(&program, (struct sock_filter) BPF_STMT(BPF_RET | BPF_K, TRIMMED));
    const struct sock_fprog filter = {.len = (unsigned short) program.length,
                                      .filter = program.code};
    setsockopt(fd, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter);
}
