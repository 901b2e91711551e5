/* Queries that wait for a definition are never answered. */
#include "pending.h"
#define pending_take(pending, handle) \
    ((void) (pending), (void) (handle), (struct match_item *) NULL)
#include "replay_answer.c"
