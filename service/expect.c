#include "expect.h"

enum {
    FIRST_GUESS_NS = 50000,
    SAMPLE_MAX_NS = 2000000 /* so that one long pause does not count for many short ones */
};

static int64_t smaller(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

void expect_init(struct expect *expect)
{
    *expect = (struct expect){.client = -1};
}

void expect_answered(struct expect *expect, int client, int64_t now_ns)
{
    expect->clients[client].idle_ns = now_ns;
}

void expect_arrived(struct expect *expect, int client, int64_t not_before_ns)
{
    struct expect_client *c = &expect->clients[client];
    if (!c->idle_ns)
        return;
    const int64_t sample = not_before_ns > c->idle_ns ? not_before_ns - c->idle_ns : 0;
    if (!c->think_ns)
        c->think_ns = FIRST_GUESS_NS;
    c->think_ns += (smaller(sample, SAMPLE_MAX_NS) - c->think_ns) / 8;
    c->idle_ns = 0;
}

bool expect_begin(struct expect *expect, int client, int64_t now_ns, int64_t most_ns,
                  int64_t other_ns)
{
    const int64_t known_ns = expect->clients[client].think_ns;
    const int64_t think_ns = known_ns ? known_ns : FIRST_GUESS_NS;
    if (most_ns <= 0 || think_ns > EXPECT_THINK_NS || think_ns > other_ns)
        return false;
    expect->client = client;
    expect->until_ns = now_ns + smaller(EXPECT_MAX_NS, most_ns);
    expect->polled_ns = now_ns;
    expect->waited_ns = 0;
    return true;
}

bool expect_poll(struct expect *expect, int64_t now_ns)
{
    expect->waited_ns += smaller(now_ns - expect->polled_ns, EXPECT_POLL_NS);
    expect->polled_ns = now_ns;
    return now_ns < expect->until_ns;
}

int64_t expect_end(struct expect *expect, int64_t now_ns)
{
    expect_poll(expect, now_ns);
    expect->client = -1;
    return expect->waited_ns / 2;
}
