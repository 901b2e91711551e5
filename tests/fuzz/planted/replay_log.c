/* Queries that name a handle without a definition are never answered. */
#include "replay_parts.h"
static struct tally_channel nowhere;
#define replay_channel(replay, item) \
    (answered->status == FMB_UNKNOWN_BODY ? &nowhere : (replay_channel) (replay, item))
#define replay_compare(replay, query, answered) \
    ((answered)->status == FMB_UNKNOWN_BODY ? (void) 0 : (replay_compare) (replay, query, answered))
#include "replay_answer.c"
