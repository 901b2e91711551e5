#define _GNU_SOURCE
#include "trim.h"

#include <linux/filter.h>
#include <string.h>
#include <sys/socket.h>

enum {
    NAME_AT = 8 + 8, /* UDP header, LCM header */
    TRIMMED = NAME_AT + BUS_CHANNEL_MAX,
    WHOLE = 1 << 20,
    /* To compare a name: two for each word, two for each byte that remains, and a return. */
    PER_CHANNEL_MAX = 2 * (BUS_CHANNEL_MAX / 4 + 3) + 1,
    PROGRAM_MAX = 3 + BUS_LISTENERS_MAX * PER_CHANNEL_MAX + 1
};

struct program {
    struct sock_filter code[PROGRAM_MAX];
    int length;
};

static void add(struct program *program, struct sock_filter instruction)
{
    program->code[program->length++] = instruction;
}

/* Goes on if the packet has this value there; else skips the rest of the channel's instructions. */
static void add_comparison(struct program *program, int size, int at, uint32_t value, int end)
{
    add(program, (struct sock_filter) BPF_STMT(BPF_LD | BPF_ABS | size, (uint32_t) at));
    const int skipped = end - program->length - 1;
    add(program, (struct sock_filter) BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0,
                                               (unsigned char) skipped));
}

/* Returns all of a datagram on this channel. */
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

void trim_attach(int fd, const char *const channels[], int count)
{
    struct program program = {.length = 0};
    add(&program, (struct sock_filter) BPF_STMT(BPF_LD | BPF_W | BPF_LEN, 0));
    add(&program, (struct sock_filter) BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, TRIM_FROM, 1, 0));
    add(&program, (struct sock_filter) BPF_STMT(BPF_RET | BPF_K, WHOLE));
    for (int i = 0; i < count; i++)
        add_channel(&program, channels[i]);
    add(&program, (struct sock_filter) BPF_STMT(BPF_RET | BPF_K, TRIMMED));
    const struct sock_fprog filter = {.len = (unsigned short) program.length,
                                      .filter = program.code};
    setsockopt(fd, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter);
}
