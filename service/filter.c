#include "filter.h"

#include <assert.h>
#include <linux/filter.h>
#include <linux/sock_diag.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#ifndef SO_ATTACH_FILTER
#define SO_ATTACH_FILTER 26 /* <asm/socket.h>; POSIX does not know it */
#endif
#ifndef SO_MEMINFO
#define SO_MEMINFO 55
#endif

enum {
    MAGIC_AT = 8, /* behind the UDP header */
    CHANNEL_AT = MAGIC_AT + 8,
    CHANNEL_MAX = 64,
    /* For the magic number, and for each byte of a name at most a load and a comparison. */
    CODE_MAX = 4 + FILTER_CHANNELS_MAX * (2 * CHANNEL_MAX + 1) + 1
};

static const uint32_t short_magic = 0x4c433032; /* "LC02" */

struct code {
    struct sock_filter at[CODE_MAX];
    int count;
};

static void add(struct code *code, uint16_t what, uint8_t otherwise, uint32_t operand)
{
    assert(code->count < CODE_MAX);
    code->at[code->count++] = (struct sock_filter){what, 0, otherwise, operand};
}

/* Where the bytes at a place differ, goes on so many instructions behind this one. A load from
 * beyond the datagram ends the filter, which then drops it. */
static void add_comparison(struct code *code, uint16_t size, uint32_t at, uint32_t value,
                           int otherwise)
{
    add(code, (uint16_t) (BPF_LD | size | BPF_ABS), 0, at);
    add(code, BPF_JMP | BPF_JEQ | BPF_K, (uint8_t) otherwise, value);
}

/* Passes what has this name, its 0 included; what has not goes on behind. Four bytes at a time. */
static void add_channel(struct code *code, const char *name)
{
    const uint32_t length = (uint32_t) strlen(name) + 1, words = length / 4, bytes = length % 4;
    const unsigned char *byte = (const unsigned char *) name;
    int left = (int) (2 * (words + bytes)); /* instructions before the one that passes it */
    for (uint32_t i = 0; i < length; left -= 2) {
        const bool word = i + 4 <= length;
        const uint32_t value = word ? (uint32_t) byte[i] << 24 | (uint32_t) byte[i + 1] << 16 |
                                          (uint32_t) byte[i + 2] << 8 | byte[i + 3]
                                    : byte[i];
        add_comparison(code, word ? BPF_W : BPF_B, CHANNEL_AT + i, value, left - 1);
        i += word ? 4 : 1;
    }
    add(code, BPF_RET | BPF_K, 0, UINT32_MAX);
}

static void write_code(struct code *code, const char *const *channels, int count)
{
    code->count = 0;
    add_comparison(code, BPF_W, MAGIC_AT, short_magic, 1);
    add(code, BPF_JMP | BPF_JA, 0, 1); /* over the next one */
    add(code, BPF_RET | BPF_K, 0, 0);
    for (int i = 0; i < count; i++)
        add_channel(code, channels[i]);
    add(code, BPF_RET | BPF_K, 0, 0);
}

static bool is_udp(int fd)
{
    int type;
    struct sockaddr_storage own;
    socklen_t type_size = sizeof type, own_size = sizeof own;
    return getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &type_size) == 0 && type == SOCK_DGRAM &&
           getsockname(fd, (struct sockaddr *) &own, &own_size) == 0 && own.ss_family == AF_INET;
}

void filter_note_others(struct filter_others *out)
{
    for (int fd = 0; fd < FILTER_FDS_MAX; fd++)
        out->udp[fd] = is_udp(fd);
}

int filter_attach(const struct filter_others *others, const char *const *channels, int count)
{
    struct code code;
    assert(count >= 1 && count <= FILTER_CHANNELS_MAX);
    write_code(&code, channels, count);
    const struct sock_fprog program = {.len = (unsigned short) code.count, .filter = code.at};
    int attached = 0;
    for (int fd = 0; fd < FILTER_FDS_MAX; fd++) {
        if (others->udp[fd] || !is_udp(fd))
            continue;
        if (setsockopt(fd, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof program) != 0)
            return -1;
        attached++;
    }
    return attached;
}

int64_t filter_dropped(const struct filter_others *others)
{
    int64_t dropped = -1;
    for (int fd = 0; fd < FILTER_FDS_MAX; fd++) {
        uint32_t info[SK_MEMINFO_VARS] = {0};
        socklen_t size = sizeof info;
        if (others->udp[fd] || !is_udp(fd))
            continue;
        if (getsockopt(fd, SOL_SOCKET, SO_MEMINFO, info, &size) != 0 ||
            size <= SK_MEMINFO_DROPS * sizeof *info)
            return -1;
        dropped = (dropped < 0 ? 0 : dropped) + info[SK_MEMINFO_DROPS];
    }
    return dropped;
}
