/* Numbers that tests of replay draw: the same in every run. */
#ifndef REPLAY_DRAW_H
#define REPLAY_DRAW_H

#include <stdint.h>

static uint64_t drawn = 1; /* the state; set to 1, it begins anew */

static uint64_t draw(uint64_t below)
{
    drawn = drawn * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (drawn >> 33) % below;
}

#endif
