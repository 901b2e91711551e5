/* The pairs of a scene that are not decided: ignored ones, and those within a group.
 *
 * Ignored pairs are linked lists by their lower index. A query marks the partners of its lower
 * index, unless the query before it had the same one: in the order of the pairs, all queries
 * together take O(pairs + ignored).
 *
 * Use: the engine while it enumerates pairs; the client library while it divides a scene and
 * delivers answers. A caller that counts pairs which are not decided (service/answer,
 * clients/common) queries each a with each b after it, and skips those a for which
 * ignored_has_any() is false.
 *
 * Inline: libfmb shows the names of fmb.h only. */
#ifndef FMB_IGNORED_H
#define FMB_IGNORED_H

#include "pair_number.h"

#include <string.h>

/* Filled by ignored_begin(). */
struct ignored {
    const unsigned (*pairs)[2];
    /* Positions in pairs plus 1; 0 ends a list. NULL: there are none. */
    unsigned *head;  /* [placement] */
    unsigned *link;  /* [pair] */
    unsigned *mark;  /* [placement]: a + 1 if its pair with a is ignored */
    unsigned marked; /* a + 1 of the last query; 0: none */
};

/* The number of elements in the memory of ignored_begin(). */
static inline size_t ignored_capacity(size_t placements, size_t ignored)
{
    return ignored > 0 ? 2 * placements + ignored : 0;
}

/* In: scene   placement_count, ignored and ignored_count, whose indices are in range; no other
 *             field is read
 *     memory  [ignored_capacity()]; in use, as scene->ignored, until the last query */
static inline void ignored_begin(const struct fmb_scene *scene, unsigned *memory,
                                 struct ignored *out)
{
    const size_t n = scene->placement_count;
    *out = (struct ignored){.pairs = scene->ignored};
    if (scene->ignored_count == 0)
        return;
    out->head = memory;
    out->mark = memory + n;
    out->link = memory + 2 * n;
    memset(memory, 0, 2 * n * sizeof *memory);
    for (size_t i = 0; i < scene->ignored_count; i++) {
        const unsigned *pair = scene->ignored[i];
        const unsigned lower = pair[0] < pair[1] ? pair[0] : pair[1];
        out->link[i] = out->head[lower];
        out->head[lower] = (unsigned) i + 1;
    }
}

/* Whether there is an ignored pair whose lower index is a. */
static inline bool ignored_has_any(const struct ignored *ignored, unsigned a)
{
    return ignored->head && ignored->head[a];
}

/* Whether the pair is ignored. In: a < b. */
static inline bool ignored_has(struct ignored *ignored, unsigned a, unsigned b)
{
    if (!ignored_has_any(ignored, a))
        return false;
    for (unsigned at = ignored->marked == a + 1 ? 0 : ignored->head[a]; at;
         at = ignored->link[at - 1]) {
        const unsigned *pair = ignored->pairs[at - 1];
        ignored->mark[pair[0] == a ? pair[1] : pair[0]] = a + 1;
    }
    ignored->marked = a + 1;
    return ignored->mark[b] == a + 1;
}

/* Whether two placements are of one group. */
static inline bool pair_is_within_group(const struct fmb_scene *scene, unsigned a, unsigned b)
{
    const int64_t group = scene->placements[a].group;
    return group != 0 && group == scene->placements[b].group;
}

/* Returns the first listed pair that is within a group; pair_count if there is none. */
static inline size_t pairs_first_grouped(const struct fmb_scene *scene)
{
    bool groups = false;
    size_t k = 0;
    for (size_t i = 0; i < scene->placement_count; i++)
        groups = groups || scene->placements[i].group;
    while (groups && k < scene->pair_count &&
           !pair_is_within_group(scene, scene->pairs[k][0], scene->pairs[k][1]))
        k++;
    return groups ? k : scene->pair_count;
}

/* Whether a pair of FMB_PAIRS_ALL or FMB_PAIRS_ACROSS is not decided: it is ignored, within a
 * group, or before first_pair. In: such a pair; the ignored pairs of the scene. */
static inline bool pair_is_left_out(const struct fmb_scene *scene, struct ignored *ignored,
                                    unsigned a, unsigned b)
{
    return ignored_has(ignored, a, b) || pair_is_within_group(scene, a, b) ||
           pair_number(pair_numbers_of(scene), a, b) < scene->first_pair;
}

/* A position in the pairs to be decided, which are in the order of the scene. Initialize to {0}. */
struct pair_cursor {
    size_t listed; /* index of the next listed pair */
    size_t a, b;   /* FMB_PAIRS_ALL and FMB_PAIRS_ACROSS: of pair_find() */
};

/* Returns true and the next pair, or false after the last one. A list of pairs begins at
 * cursor->listed. */
static inline bool pair_next(const struct fmb_scene *scene, struct ignored *ignored,
                             struct pair_cursor *cursor, unsigned out[2])
{
    if (scene->which == FMB_PAIRS_LISTED) {
        if (cursor->listed == scene->pair_count)
            return false;
        memcpy(out, scene->pairs[cursor->listed++], sizeof *scene->pairs);
        return true;
    }
    do {
        if (!pair_find(pair_numbers_of(scene), &cursor->a, &cursor->b))
            return false;
        out[0] = (unsigned) cursor->a;
        out[1] = (unsigned) cursor->b++;
    } while (pair_is_left_out(scene, ignored, out[0], out[1]));
    return true;
}

#endif
