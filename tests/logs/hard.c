/* Pairs that are hard for a reason: of each family of the campaigns one for each cell that it has.
 * At rest those of a family are listed in one scene, with boxes; what moves is queried pair by
 * pair, since windows differ, and some once more, by handle and the other way round. Methods,
 * certificates, boxes and gaps are drawn. */
#include "kinds.h"

#include "log_client.h"
#include "family.h"
#include "parts.h"
#include "turn_family.h"

#include <string.h>

static const uint64_t seed = 20240101;

struct hard {
    struct log_client log_client;
    struct draw draw; /* how to query */
    int64_t body_id;  /* the last one given */
    struct scene_query scene;
    struct scene_result scene_result;
};

enum { AT_REST = 1, MOVING = 2, TURNING = 4 };

static struct question draw_question(const struct family *family, const struct cell *cell)
{
    struct draw draw = cell_draw(seed, family->name, cell, 0);
    struct question question;
    family_draw(family, cell, &draw, &question);
    return question;
}

/* The service's own choice more often than any other one: see pair_query_t.lcm. */
static int32_t draw_method(struct draw *draw)
{
    static const int32_t methods[] = {0, 0, 4, 1, 2, 3};
    return methods[draw_int(draw, 0, 5)];
}

/* The inexact methods give none. */
static int32_t draw_gap(struct draw *draw, int32_t method)
{
    return draw_coin(draw) && fmb_method_by_number(method)->certain ? FMB_WANT_GAP : 0;
}

/* ---- One by one ---- */

static void query_again(struct hard *hard, const struct pair_query *query)
{
    struct pair_query swapped = *query;
    struct pair_result result;
    swapped.placement[0] = query->placement[1];
    swapped.placement[1] = query->placement[0];
    log_client_pair(&hard->log_client, &swapped, &result);
}

/* Methods in doubles refuse pairs that turn: for half of these the service chooses the method. */
static void query_pair(struct hard *hard, const struct question *question, bool turns)
{
    struct draw *draw = &hard->draw;
    struct pair_query query = {.duration = question->duration, .method = draw_method(draw)};
    struct pair_result result;
    const bool again = draw_int(draw, 0, 7) == 0;
    if (turns && draw_coin(draw))
        query.method = 0;
    if (draw_coin(draw))
        query.want |= FMB_WANT_BOX;
    if (draw_int(draw, 0, 3) == 0)
        query.want |= FMB_WANT_CERTIFICATE;
    query.want |= draw_gap(draw, query.method);
    if (turns && fmb_method_by_number(query.method)->certain && draw_coin(draw))
        query.want |= FMB_WANT_POINT;
    part_place(&question->a, again ? ++hard->body_id : 0, &query.placement[0]);
    part_place(&question->b, again ? ++hard->body_id : 0, &query.placement[1]);
    log_client_pair(&hard->log_client, &query, &result);
    if (again)
        query_again(hard, &query);
}

/* ---- Scenes ---- */

static void append_pair(struct scene_query *query, const struct question *question)
{
    const unsigned first = (unsigned) query->placement_count;
    unsigned *pair = query->pair[query->index_count / 2];
    part_place(&question->a, 0, &query->placement[first]);
    part_place(&question->b, 0, &query->placement[first + 1]);
    pair[0] = first;
    pair[1] = first + 1;
    query->placement_count += 2;
    query->index_count += 2;
}

static void query_scene(struct hard *hard)
{
    if (hard->scene.placement_count > 0)
        log_client_scene(&hard->log_client, &hard->scene, &hard->scene_result);
}

static void begin_scene(struct hard *hard)
{
    struct scene_query *query = &hard->scene;
    query->duration = 1;
    query->which = FMB_PAIRS_LISTED;
    query->method = draw_method(&hard->draw);
    query->want = FMB_WANT_BOX | draw_gap(&hard->draw, query->method);
    query->placement_count = query->index_count = 0;
}

/* ---- All ---- */

static void query_family(struct hard *hard, const struct family *family, int dim, bool moving)
{
    struct cell cells[CELL_WITH_FACES];
    const int count = family_cells(family, cells);
    begin_scene(hard);
    for (int i = 0; i < count; i++) {
        if (cells[i].dim != dim || cells[i].moving != moving)
            continue;
        const struct question question = draw_question(family, &cells[i]);
        if (moving)
            query_pair(hard, &question, false);
        else
            append_pair(&hard->scene, &question);
    }
    query_scene(hard);
}

/* Queries single pairs; then the pairs with a window of one second again, in a scene for each
 * dimension. Sines, cosines and powers differ between machines: families that draw them are left
 * out. */
static void query_turning_family(struct hard *hard, const struct family *family)
{
    static const char *const whole[] = {"turn-table", "turn-lift",  "turn-land",  "turn-tumble",
                                        "turn-door",  "turn-whole", "turn-graze", "turn-straight"};
    bool drawn = strcmp(family->name, "turn-flat") == 0;
    for (size_t i = 0; i < sizeof whole / sizeof *whole; i++)
        drawn = drawn || strncmp(family->name, whole[i], strlen(whole[i])) == 0;
    for (int dim = 3; dim >= (family->cells & FAMILY_3D ? 3 : 2) && drawn; dim--) {
        const struct cell cell = {.dim = dim};
        struct draw draw = cell_draw(seed, family->name, &cell, 0);
        begin_scene(hard);
        for (int n = 0; n < (dim == 2 ? 10 : 3); n++) { /* few families are in 2D */
            struct question question;
            family_draw(family, &cell, &draw, &question);
            query_pair(hard, &question, true);
            if (question.duration == 1)
                append_pair(&hard->scene, &question);
        }
        query_scene(hard);
    }
}

static bool query_families(struct tape *tape, int dim, int motions)
{
    const struct instance_options options = {.prefix = "", .server_id = 2718281828, .frames = 1024};
    static struct hard hard;
    struct instance instance;
    if (!instance_open(&instance, tape, &options))
        return false;
    hard = (struct hard){
        .log_client = {.instance = &instance, .client_id = QUERY_ID_MAX, .next_number = 1000},
        .draw = {seed}};
    for (int moving = 0; moving < 2; moving++)
        for (size_t i = 0; family_at(i) && motions >> moving & 1; i++)
            query_family(&hard, family_at(i), dim, moving);
    for (size_t i = 0; family_turning_at(i) && motions == TURNING; i++)
        query_turning_family(&hard, family_turning_at(i));
    instance_beat(&instance);
    instance_close(&instance);
    return true;
}

bool kind_hard_plane(struct tape *tape)
{
    return query_families(tape, 2, AT_REST | MOVING);
}

bool kind_hard_space(struct tape *tape)
{
    return query_families(tape, 3, AT_REST);
}

bool kind_hard_moving(struct tape *tape)
{
    return query_families(tape, 3, MOVING);
}

bool kind_turns(struct tape *tape)
{
    return query_families(tape, 0, TURNING);
}
