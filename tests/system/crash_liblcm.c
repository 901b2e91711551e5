/* Packets that LCM's receiving thread does not survive (liblcm 1.3.1), sent to the group and port
 * of LCM_DEFAULT_URL, or LCM's usual ones.
 *
 * crash-liblcm wrap CHANNEL: two fragments of a message; the second one says that it begins
 * 16 bytes below 2^32: in 32 bits offset plus size wraps and seems to fit, in 64 bits the bytes go
 * 4 GB beyond the message.
 *
 * crash-liblcm empty CHANNEL: only headers, short ones without a channel's end: negative sizes.
 *
 * crash-liblcm huge CHANNEL: a fragment of a message of 256 MB.
 *
 * crash-liblcm short CHANNEL: two good fragments, then one that ends in the middle of its header:
 * what is left of the second stands in for the rest, and the size without the header is taken for a
 * huge one, which wraps with the offset. */
#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { MAGIC_LONG = 0x4c433033 }; /* "LC03" */
enum { PACKET_MAX = 256, DATA = 32, CUT = 8 };

/* The header of a fragment, as LCM sends it: big-endian, without gaps. */
struct fragment {
    uint32_t sequence_number, message_size, offset;
    uint16_t number, count;
};

static unsigned char *put32(unsigned char *at, uint32_t value)
{
    value = htonl(value);
    memcpy(at, &value, sizeof value);
    return at + sizeof value;
}

static unsigned char *put16(unsigned char *at, uint16_t value)
{
    value = htons(value);
    memcpy(at, &value, sizeof value);
    return at + sizeof value;
}

/* The fragment with its header, the channel (NULL: none) and DATA bytes; returns the size. */
static size_t write_fragment(const struct fragment *fragment, const char *channel,
                             unsigned char out[PACKET_MAX])
{
    unsigned char *at = put32(out, MAGIC_LONG);
    at = put32(at, fragment->sequence_number);
    at = put32(at, fragment->message_size);
    at = put32(at, fragment->offset);
    at = put16(at, fragment->number);
    at = put16(at, fragment->count);
    if (channel) {
        size_t size = strlen(channel) + 1;
        memcpy(at, channel, size);
        at += size;
    }
    memset(at, 'x', DATA);
    return (size_t) (at + DATA - out);
}

/* The group and port of LCM_DEFAULT_URL, a udpm one; of LCM itself where there is none. */
static struct sockaddr_in bus_address(void)
{
    char group[16] = "239.255.76.67";
    unsigned port = 7667;
    const char *url = getenv("LCM_DEFAULT_URL");
    struct sockaddr_in address = {.sin_family = AF_INET};
    if (url && sscanf(url, "udpm://%15[0-9.]:%5u", group, &port) != 2) {
        fprintf(stderr, "crash-liblcm: %s is not understood\n", url);
        exit(2);
    }
    address.sin_port = htons((uint16_t) port);
    inet_pton(AF_INET, group, &address.sin_addr);
    return address;
}

/* A socket that sends to the bus of this host only. */
static int open_bus(void)
{
    struct sockaddr_in address = bus_address();
    unsigned char ttl = 0;
    int fd = socket(AF_INET, SOCK_DGRAM, 0);
    if (fd < 0 || setsockopt(fd, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl) != 0 ||
        connect(fd, (const struct sockaddr *) &address, sizeof address) != 0) {
        perror("crash-liblcm: socket");
        exit(1);
    }
    return fd;
}

static void send_packet(int fd, const unsigned char *packet, size_t size)
{
    if (send(fd, packet, size, 0) != (ssize_t) size) {
        perror("crash-liblcm: send");
        exit(1);
    }
}

static void send_wrap(int fd, const char *channel)
{
    unsigned char packet[PACKET_MAX];
    struct fragment fragment = {.sequence_number = 1, .message_size = 4 * DATA, .count = 4};
    send_packet(fd, packet, write_fragment(&fragment, channel, packet));
    fragment.number = 1;
    fragment.offset = 0xfffffff0;
    send_packet(fd, packet, write_fragment(&fragment, NULL, packet));
}

static void send_short(int fd, const char *channel)
{
    unsigned char packet[PACKET_MAX];
    struct fragment fragment = {.sequence_number = 1, .message_size = 4 * DATA, .count = 4};
    send_packet(fd, packet, write_fragment(&fragment, channel, packet));
    fragment.number = 1;
    fragment.offset = DATA;
    send_packet(fd, packet, write_fragment(&fragment, NULL, packet));
    send_packet(fd, packet, CUT);
}

static void send_empty(int fd, const char *channel)
{
    unsigned char packet[PACKET_MAX] = "LC02";
    const size_t length = strlen(channel);
    memcpy(packet + CUT, channel, length);
    for (size_t size = 0; size <= CUT; size += 4)
        send_packet(fd, packet, size);
    send_packet(fd, packet, CUT + length); /* no final 0 */
}

static void send_huge(int fd, const char *channel)
{
    unsigned char packet[PACKET_MAX];
    const struct fragment fragment = {
        .sequence_number = 1, .message_size = 1u << 28, .count = UINT16_MAX};
    send_packet(fd, packet, write_fragment(&fragment, channel, packet));
}

static const struct {
    const char *name;
    void (*send)(int fd, const char *channel);
} packets[] = {
    {"wrap", send_wrap}, {"short", send_short}, {"empty", send_empty}, {"huge", send_huge}};

int main(int argc, char **argv)
{
    for (size_t i = 0; i < sizeof packets / sizeof *packets && argc == 3; i++) {
        if (strcmp(argv[1], packets[i].name) != 0 || strlen(argv[2]) > 63)
            continue;
        const int fd = open_bus();
        packets[i].send(fd, argv[2]);
        close(fd);
        return 0;
    }
    fputs("usage: crash-liblcm wrap|short|empty|huge CHANNEL\n", stderr);
    return 2;
}
