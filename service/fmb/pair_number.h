/* The pairs of FMB_PAIRS_ALL and FMB_PAIRS_ACROSS, the numbers of all pairs (fmb.h), which pairs
 * are valid, and the scene of one pair.
 *
 *   ALL     a = 0 to n - 1, each with b = a + 1 to n - 1
 *   ACROSS  a = 0 to split - 1, each with b = split to n - 1
 *
 * Inline: other folders use them too, and libfmb shows the names of fmb.h only. */
#ifndef FMB_PAIR_NUMBER_H
#define FMB_PAIR_NUMBER_H

#include "fmb.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct pair_numbers {
    bool across;
    size_t n, split; /* number of placements; split: at most n, used if across */
};

/* In: which is not FMB_PAIRS_LISTED. */
static inline struct pair_numbers pair_numbers_of(const struct fmb_scene *scene)
{
    return (struct pair_numbers){scene->which == FMB_PAIRS_ACROSS, scene->placement_count,
                                 scene->split};
}

/* The number of placements that come first in pairs: a is below it. */
static inline size_t pair_rows(struct pair_numbers of)
{
    return of.across ? of.split : of.n;
}

/* The first b of placement a. */
static inline size_t pair_first_partner(struct pair_numbers of, size_t a)
{
    return of.across ? of.split : a + 1;
}

/* The number of pairs of the placements before a: fewer than 2^63 for n < 2^32. In: a <= n. */
static inline uint64_t pairs_before(struct pair_numbers of, size_t a)
{
    const uint64_t n = of.n, i = a;
    return of.across ? i * (n - of.split) : i * n - i * (i + 1) / 2;
}

static inline uint64_t pairs_total(struct pair_numbers of)
{
    return pairs_before(of, pair_rows(of));
}

static inline bool pair_is_among(struct pair_numbers of, size_t a, size_t b)
{
    return a < pair_rows(of) && b >= pair_first_partner(of, a) && b < of.n;
}

/* In: a pair that is among them. */
static inline uint64_t pair_number(struct pair_numbers of, size_t a, size_t b)
{
    return pairs_before(of, a) + (b - pair_first_partner(of, a));
}

/* Advances to the first pair, in order, whose first placement is *a and second at least *b, or
 * whose first placement is later. *b is 0 at first. Returns false if there is none. */
static inline bool pair_find(struct pair_numbers of, size_t *a, size_t *b)
{
    for (; *a < pair_rows(of); ++*a, *b = 0) {
        if (*b < pair_first_partner(of, *a))
            *b = pair_first_partner(of, *a);
        if (*b < of.n)
            return true;
    }
    return false;
}

/* Whether a listed or an ignored pair is valid: of two different placements. */
static inline bool pair_is_valid(const unsigned pair[2], size_t placements)
{
    const unsigned end = (unsigned) placements;
    return (pair[0] < end) & (pair[1] < end) & (pair[0] != pair[1]);
}

/* Returns the first pair that is not valid; count if there is none. The first loop has no branches,
 * so that compilers vectorize it. */
static inline size_t pairs_first_invalid(const unsigned (*restrict pair)[2], size_t count,
                                         size_t placements)
{
    bool good = true;
    size_t i = 0;
    for (size_t k = 0; k < count; k++)
        good &= pair_is_valid(pair[k], placements);
    while (!good && pair_is_valid(pair[i], placements))
        i++;
    return good ? count : i;
}

/* Returns the scene of one pair, of placements 0 and 1, without its placements. */
static inline struct fmb_scene pair_scene(const struct fmb_method *method, double duration,
                                          unsigned want)
{
    static const unsigned pair[1][2] = {{0, 1}};
    return (struct fmb_scene){.placement_count = 2,
                              .duration = duration,
                              .instant = duration == 0,
                              .method = method,
                              .want = want | FMB_WANT_TIMES,
                              .which = FMB_PAIRS_LISTED,
                              .pairs = pair,
                              .pair_count = 1};
}

#endif
