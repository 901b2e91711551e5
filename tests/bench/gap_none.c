#include "gap_peers.h"

#include <stdio.h>

struct gap_peers *gap_peers_open(const struct gap_solid *solid, size_t pairs)
{
    (void) solid;
    (void) pairs;
    return NULL;
}

void gap_peers_close(struct gap_peers *peers)
{
    (void) peers;
}

const char *gap_peer_name(int peer)
{
    (void) peer;
    return NULL;
}

int gap_peer_answers(int peer)
{
    (void) peer;
    return GAP_PEER_MEETS;
}

void gap_peer_run(struct gap_peers *peers, int peer, size_t first, size_t count, double *gap)
{
    (void) peers;
    (void) peer;
    (void) first;
    (void) count;
    (void) gap;
}

void gap_peers_help(void)
{
    puts("Other libraries are not in this build: make deps-bench.");
}
