#include "anticipation.h"

#include "clock.h"

enum {
    FIRST_GUESS_NS = 50000, /* think time of a client that is unknown */
    SAMPLE_MAX_NS = 2000000 /* so that one long pause does not outweigh many short ones */
};

void anticipation_init(struct anticipation *anticipation)
{
    *anticipation = (struct anticipation){.client = -1};
}

void anticipation_answered(struct anticipation *anticipation, int client, int64_t now_ns)
{
    anticipation->clients[client].idle_ns = now_ns;
}

void anticipation_arrived(struct anticipation *anticipation, int client, int64_t not_before_ns)
{
    struct anticipated_client *c = &anticipation->clients[client];
    if (!c->idle_ns)
        return;
    const int64_t sample = not_before_ns > c->idle_ns ? not_before_ns - c->idle_ns : 0;
    if (!c->think_ns)
        c->think_ns = FIRST_GUESS_NS;
    c->think_ns += (clock_earlier(sample, SAMPLE_MAX_NS) - c->think_ns) / 8;
    c->idle_ns = 0;
}

bool anticipation_begin(struct anticipation *anticipation, int client, int64_t now_ns,
                        int64_t max_ns, int64_t other_ns, bool leads)
{
    const int64_t known_ns = anticipation->clients[client].think_ns;
    const int64_t think_ns = known_ns ? known_ns : FIRST_GUESS_NS;
    if (max_ns <= 0 ||
        (think_ns > ANTICIPATION_THINK_NS && think_ns > other_ns / ANTICIPATION_RATIO) ||
        (think_ns > other_ns && !leads))
        return false;
    anticipation->client = client;
    anticipation->until_ns = now_ns + clock_earlier(ANTICIPATION_MAX_NS, max_ns);
    anticipation->polled_ns = now_ns;
    anticipation->waited_ns = 0;
    return true;
}

bool anticipation_poll(struct anticipation *anticipation, int64_t now_ns)
{
    anticipation->waited_ns +=
        clock_earlier(now_ns - anticipation->polled_ns, ANTICIPATION_POLL_NS);
    anticipation->polled_ns = now_ns;
    return now_ns < anticipation->until_ns;
}

int64_t anticipation_end(struct anticipation *anticipation, int64_t now_ns)
{
    anticipation_poll(anticipation, now_ns);
    anticipation->client = -1;
    return anticipation->waited_ns / 2;
}
