#include "scene_change.h"

#include "report.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { NO_BODY = -1 };

/* The bodies of one query. */
struct bodies {
    const struct query_placement *placement;
    int32_t count;                          /* of placements */
    const char *name[QUERY_PLACEMENTS_MAX]; /* [placement]; "": none */
    int32_t other[QUERY_PLACEMENTS_MAX];    /* [placement]: index in the other query; NO_BODY */
};

static void list_bodies(struct bodies *bodies, const struct exchange *exchange)
{
    bodies->placement = exchange->query->placement;
    bodies->count = exchange->query->placement_count;
    for (int32_t i = 0; i < bodies->count; i++) {
        const char *name = exchange_name(exchange, i);
        bodies->name[i] = name ? name : "";
        bodies->other[i] = NO_BODY;
    }
}

static bool are_same(const struct bodies *a, int32_t i, const struct bodies *b, int32_t k)
{
    const char *name = a->name[i], *other = b->name[k];
    return *name && *other ? strcmp(name, other) == 0
                           : a->placement[i].placed.id == b->placement[k].placed.id;
}

/* Sets other[] of both. The search for a body begins after the previous match, so that it is short
 * if bodies were inserted or removed. */
static void match_bodies(struct bodies *then, struct bodies *now)
{
    int32_t next = 0;
    for (int32_t i = 0; i < now->count; i++)
        for (int32_t step = 0; step < then->count; step++) {
            const int32_t k = (next + step) % then->count;
            if (then->other[k] != NO_BODY || !are_same(now, i, then, k))
                continue;
            then->other[k] = i;
            now->other[i] = k;
            next = k + 1;
            break;
        }
}

static bool same_indices(const unsigned (*a)[2], int32_t a_count, const unsigned (*b)[2],
                         int32_t b_count)
{
    const int32_t stored = a_count / 2 < QUERY_PAIRS_MAX ? a_count / 2 : QUERY_PAIRS_MAX;
    return a_count == b_count && memcmp(a, b, (size_t) stored * sizeof *a) == 0;
}

/* Whether two queries of the same bodies decide the same pairs; false if not known. */
static bool same_pairs(const struct scene_query *a, const struct scene_query *b)
{
    if (a->which != b->which || a->split != b->split || a->first_pair != b->first_pair ||
        a->placement_count != b->placement_count ||
        !same_indices(a->pair, a->index_count, b->pair, b->index_count) ||
        !same_indices(a->ignored, a->ignored_count, b->ignored, b->ignored_count))
        return false;
    for (int32_t i = 0; i < query_stored_placements(a); i++)
        if (a->placement[i].placed.group != b->placement[i].placed.group)
            return false;
    return true;
}

/* ---- Text ---- */

/* Appends to the text, which is truncated. */
__attribute__((format(printf, 2, 3))) static void say(char *out, const char *format, ...)
{
    const size_t used = strlen(out);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(out + used, SCENE_CHANGE_MAX - used, format, arguments);
    va_end(arguments);
}

/* Names the first bodies that the other query lacks or, if moved is true, has at another index. For
 * example "post, crate and 3 more are new". */
static void say_bodies(char *out, const struct bodies *bodies, bool moved, const char *what)
{
    enum { NAMED = 3 };
    int32_t count = 0;
    char text[NUMBER_TEXT_MAX];
    for (int32_t i = 0; i < bodies->count; i++) {
        const int32_t other = bodies->other[i];
        if ((moved ? other != i : other == NO_BODY) && ++count <= NAMED)
            say(out, "%s%.40s",
                count > 1          ? ", "
                : strchr(out, ':') ? "; "
                                   : ": ",
                report_body(*bodies->name[i] ? bodies->name[i] : NULL,
                            bodies->placement[i].placed.id, text));
    }
    if (count > NAMED)
        say(out, " and %" PRId32 " more", count - NAMED);
    if (count > 0)
        say(out, " %s %s", count > 1 ? "are" : "is", what);
}

bool scene_change(const struct exchange *then, const struct exchange *now,
                  char out[SCENE_CHANGE_MAX])
{
    struct bodies old, new;
    bool differ, moved = false;
    *out = 0;
    list_bodies(&old, then);
    list_bodies(&new, now);
    match_bodies(&old, &new);
    differ = old.count != new.count;
    for (int32_t i = 0; i < new.count; i++) {
        differ = differ || new.other[i] == NO_BODY;
        moved = moved || new.other[i] != i;
    }
    if (differ) {
        say(out, "the recording has %" PRId32 " bodies, the query %" PRId32, old.count, new.count);
        say_bodies(out, &new, false, "new");
        say_bodies(out, &old, false, "missing");
    } else if (moved) {
        say(out, "the recording has the same bodies in another order");
        say_bodies(out, &new, true, "moved");
    } else if (now->query->kind == LOG_SCENE_QUERY &&
               !same_pairs(&then->query->scene, &now->query->scene)) {
        say(out, "the recording and the query decide different pairs of the same bodies");
    }
    return *out;
}
