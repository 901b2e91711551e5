#include "align.h"

#include "allocate.h"
#include "pair_number.h"
#include "report.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { THEN, NOW, SIDES, NO_BODY = -1 };

/* A cell of the table: a pair of the recorded query, by its indices. */
enum {
    CELL_NONE, /* the query does not decide it */
    CELL_NOT_ANSWERED,
    CELL_NOT_NAMED, /* separated */
    CELL_VERDICT    /* and more: plus the index of its verdict */
};

/* One of the queries. */
struct side {
    const struct body_names *names;
    const struct logged_query *query;
    const struct scene_result *result; /* NULL: it answers nothing */
    const struct query_placement *placement;
    int32_t count;                          /* of placements */
    int32_t other[QUERY_PLACEMENTS_MAX];    /* [placement]: that of the other query; NO_BODY */
    const char *name[QUERY_PLACEMENTS_MAX]; /* [placement]; "": none */
    int32_t contact[QUERY_VERDICTS_MAX];    /* [verdict]: index of its times */
    unsigned ignored[QUERY_IGNORED_CAPACITY];
    /* Pairs of bodies that both queries have, decided in one only; and the first of them. */
    int64_t pairs, only;
    unsigned first[2];
};

struct align {
    struct side side[SIDES];
    int32_t *cell;   /* [a][b], a <= b: of the recorded query; negative: the new one has it too */
    size_t cells, n; /* capacity; n: placements of the recorded query */
    struct scene_result none; /* that answers nothing */
    struct replayed_match match;
};

struct align *align_open(const struct body_names *then, const struct body_names *now)
{
    struct align *align = allocate(1, sizeof *align);
    align->side[THEN].names = then;
    align->side[NOW].names = now;
    return align;
}

void align_close(struct align *align)
{
    if (!align)
        return;
    free(align->cell);
    free(align);
}

/* ---- Bodies ---- */

static void begin_side(struct side *side, const struct logged_query *query)
{
    const int64_t client = query->header.client_id;
    side->query = query;
    side->placement = query->placement;
    side->count = query->placement_count;
    for (int32_t i = 0; i < side->count; i++) {
        const struct fmb_placement *placed = &side->placement[i].placed;
        const char *name = body_names_find(side->names, client, placed->id);
        side->name[i] = name ? name : placed->name ? placed->name : "";
        side->other[i] = NO_BODY;
    }
}

static bool are_same(const struct side *a, int32_t i, const struct side *b, int32_t k)
{
    const char *name = a->name[i], *other = b->name[k];
    return *name && *other ? strcmp(name, other) == 0
                           : a->placement[i].placed.id == b->placement[k].placed.id;
}

/* Sets other[] of both. Returns whether each body has its own index. The search for a body begins
 * after the one before it, so that it is short where bodies were inserted or removed. */
static bool match_bodies(struct side *then, struct side *now)
{
    bool same = then->count == now->count;
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
    for (int32_t i = 0; same && i < now->count; i++)
        same = now->other[i] == i;
    return same;
}

/* ---- Pairs ---- */

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

bool align_queries(struct align *align, const struct logged_query *then,
                   const struct logged_query *now)
{
    begin_side(&align->side[THEN], then);
    begin_side(&align->side[NOW], now);
    return match_bodies(&align->side[THEN], &align->side[NOW]) &&
           (now->kind == LOG_PAIR_QUERY || same_pairs(&then->scene, &now->scene));
}

/* An iteration over the pairs of a query, from first_pair on. */
struct walk {
    struct side *side;
    struct ignored ignored;
    size_t next_a, next_b;
    int64_t number; /* of the next pair */
    unsigned a, b;
    bool decided; /* neither ignored nor within a group */
};

static struct walk walk_begin(struct side *side)
{
    const struct scene_query *query = &side->query->scene;
    struct walk walk = {.side = side};
    if (query->which == FMB_PAIRS_LISTED)
        walk.number = query->first_pair;
    else
        query_ignored(query, side->ignored, &walk.ignored);
    return walk;
}

static bool walk_next(struct walk *walk)
{
    const struct scene_query *query = &walk->side->query->scene;
    const struct query_placement *placement = query->placement;
    if (query->which == FMB_PAIRS_LISTED) {
        if (walk->number >= query->index_count / 2)
            return false;
        walk->a = query->pair[walk->number][0];
        walk->b = query->pair[walk->number][1];
        walk->decided = true;
        walk->number++;
        return true;
    }
    const struct pair_numbers of = {query->which == FMB_PAIRS_ACROSS, (size_t) walk->side->count,
                                    (size_t) query->split};
    do {
        if (!pair_find(of, &walk->next_a, &walk->next_b))
            return false;
        walk->a = (unsigned) walk->next_a;
        walk->b = (unsigned) walk->next_b++;
    } while (walk->number++ < query->first_pair);
    const int64_t group = placement[walk->a].placed.group;
    walk->decided = !(group != 0 && group == placement[walk->b].placed.group) &&
                    !ignored_has(&walk->ignored, walk->a, walk->b);
    return true;
}

static int32_t *cell_of(const struct align *align, unsigned a, unsigned b)
{
    return &align->cell[a < b ? a * align->n + b : b * align->n + a];
}

/* The position of the answer to the pair before walk->number; *named: verdicts before it. */
static struct replayed_at at_of(const struct walk *walk, int32_t *named)
{
    const struct scene_result *result = walk->side->result;
    struct replayed_at at = {REPLAYED_NOT_ANSWERED, 0};
    if (!result || walk->number > result->end_pair)
        return at;
    if (*named < result->verdict_count &&
        (!result->names_pairs ||
         (result->pair[*named][0] == walk->a && result->pair[*named][1] == walk->b))) {
        at.verdict = (*named)++;
        at.contact = walk->side->contact[at.verdict];
    } else if (walk->decided) {
        at.verdict = REPLAYED_NOT_NAMED;
    }
    return at;
}

static void fill_cells(struct align *align)
{
    struct side *side = &align->side[THEN];
    const size_t n = (size_t) side->count;
    if (n * n > align->cells) {
        free(align->cell);
        align->cell = allocate(align->cells = n * n, sizeof *align->cell);
    }
    align->n = n;
    memset(align->cell, 0, n * n * sizeof *align->cell);
    int32_t named = 0;
    for (struct walk walk = walk_begin(side); walk_next(&walk);) {
        const struct replayed_at at = at_of(&walk, &named);
        if (walk.decided || at.verdict >= 0)
            *cell_of(align, walk.a, walk.b) = at.verdict + CELL_VERDICT;
    }
}

/* Counts a pair of bodies that both queries have; only: the other query does not decide it. */
static void count_pair(const struct walk *walk, bool only)
{
    struct side *side = walk->side;
    side->pairs++;
    if (only && side->only++ == 0) {
        side->first[0] = walk->a;
        side->first[1] = walk->b;
    }
}

static void match_pairs(struct align *align)
{
    struct side *then = &align->side[THEN], *now = &align->side[NOW];
    struct replayed_match *match = &align->match;
    int32_t named = 0;
    for (struct walk walk = walk_begin(now); walk_next(&walk);) {
        const int32_t a = now->other[walk.a], b = now->other[walk.b];
        const bool both = a != NO_BODY && b != NO_BODY;
        int32_t *cell = both ? cell_of(align, (unsigned) a, (unsigned) b) : NULL;
        const int32_t of_then = cell ? abs(*cell) : CELL_NONE;
        struct replayed_at at = {REPLAYED_NOT_ANSWERED, 0}, at_now = at_of(&walk, &named);
        if (both && walk.decided)
            count_pair(&walk, of_then == CELL_NONE);
        if (of_then != CELL_NONE) {
            *cell = walk.decided ? -of_then : *cell;
            at.verdict = of_then - CELL_VERDICT;
        }
        if (at.verdict < 0 && at_now.verdict < 0)
            continue;
        bool swapped = false;
        if (at.verdict >= 0) {
            const unsigned *pair =
                then->result->names_pairs
                    ? then->result->pair[at.verdict]
                    : then->query->scene.pair[then->query->scene.first_pair + at.verdict];
            at.contact = then->contact[at.verdict];
            swapped = pair[0] != (unsigned) a;
        }
        match->pair[match->count].a = walk.a;
        match->pair[match->count].b = walk.b;
        match->pair[match->count].swapped = swapped;
        match->pair[match->count].then = at;
        match->pair[match->count++].now = at_now;
    }
    for (struct walk walk = walk_begin(then); walk_next(&walk);)
        if (walk.decided && then->other[walk.a] != NO_BODY && then->other[walk.b] != NO_BODY)
            count_pair(&walk, *cell_of(align, walk.a, walk.b) > 0);
}

/* ---- For people ---- */

/* Appends to the detail, which is truncated. */
__attribute__((format(printf, 2, 3))) static void say(struct replayed_match *match,
                                                      const char *format, ...)
{
    const size_t used = strlen(match->detail);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(match->detail + used, sizeof match->detail - used, format, arguments);
    va_end(arguments);
}

static const char *name_of(const struct side *side, unsigned body, char text[NUMBER_TEXT_MAX])
{
    return report_body(*side->name[body] ? side->name[body] : NULL, side->placement[body].placed.id,
                       text);
}

/* "post, crate and 3 more are new" */
static void say_bodies(struct replayed_match *match, const struct side *side, const char *before,
                       const char *what)
{
    enum { NAMED = 3 };
    int32_t count = 0, said = 0;
    char text[NUMBER_TEXT_MAX];
    for (int32_t i = 0; i < side->count; i++)
        count += side->other[i] == NO_BODY;
    if (count == 0)
        return;
    for (int32_t i = 0; i < side->count && said < NAMED; i++)
        if (side->other[i] == NO_BODY)
            say(match, "%s%.40s", said++ ? ", " : before, name_of(side, (unsigned) i, text));
    if (count > NAMED)
        say(match, " and %" PRId32 " more", count - NAMED);
    say(match, " %s %s", count > 1 ? "are" : "is", what);
}

static void say_pair(struct replayed_match *match, const struct side *side, const char *what)
{
    char text[2][NUMBER_TEXT_MAX];
    if (side->only > 0)
        say(match, "; %s%.40s with %.40s%s", side->only > 1 ? "for example " : "",
            name_of(side, side->first[0], text[0]), name_of(side, side->first[1], text[1]), what);
}

static void say_detail(struct align *align)
{
    const struct side *then = &align->side[THEN], *now = &align->side[NOW];
    struct replayed_match *match = &align->match;
    bool bodies = false;
    for (int32_t i = 0; i < then->count; i++)
        bodies = bodies || then->other[i] == NO_BODY;
    for (int32_t i = 0; i < now->count; i++)
        bodies = bodies || now->other[i] == NO_BODY;
    if (bodies) {
        say(match, "the recording has %" PRId32 " bodies, the query %" PRId32, then->count,
            now->count);
        say_bodies(match, now, ": ", "new");
        say_bodies(match, then, strchr(match->detail, ':') ? "; " : ": ", "missing");
    }
    if (!bodies && now->query->kind == LOG_PAIR_QUERY)
        say(match, "the recording has the bodies in the other order");
    if (then->only + now->only == 0)
        return;
    say(match, "%sthe recording decides %" PRId64 " pairs, the query %" PRId64,
        bodies ? "; of the others " : "", then->pairs, now->pairs);
    say_pair(match, then, " is missing");
    say_pair(match, now, " is new");
}

/* ---- Results ---- */

/* Sets the result of a side, unless it answers nothing. Returns false if it is none to its query.
 */
static bool take_result(struct side *side, const struct logged_result *result)
{
    side->pairs = side->only = 0;
    side->result = NULL;
    if (side->query->kind == LOG_PAIR_QUERY || result->scene.status != FMB_OK)
        return true;
    if (!logged_result_fits(&side->query->scene, &result->scene))
        return false;
    side->result = &result->scene;
    int32_t contact = 0;
    for (int32_t k = 0; k < side->result->verdict_count; k++) {
        side->contact[k] = contact;
        contact += side->result->verdict[k] >= FMB_TOUCHING;
    }
    return true;
}

/* Whether the indices of a query are in range, as those of one that was answered. */
static bool is_good(struct align *align, const struct side *side)
{
    const struct scene_query *query = &side->query->scene;
    align->none.end_pair = query->first_pair;
    return logged_result_fits(query, &align->none);
}

const struct replayed_match *align_results(struct align *align, const struct logged_result *then,
                                           const struct logged_result *now)
{
    struct replayed_match *match = &align->match;
    match->count = 0;
    match->detail[0] = 0;
    match->fits = take_result(&align->side[THEN], then);
    match->fits = take_result(&align->side[NOW], now) && match->fits;
    if (align->side[NOW].query->kind == LOG_SCENE_QUERY && is_good(align, &align->side[THEN]) &&
        is_good(align, &align->side[NOW])) {
        fill_cells(align);
        match_pairs(align);
    }
    say_detail(align);
    return match;
}
