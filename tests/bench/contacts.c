/* Pairs that touch, or nearly so, beside random ones: what a verdict costs, and how often it is
 * wrong, by the engine, by other methods and by other libraries. */
#include "bench.h"

#include <stdlib.h>
#include <string.h>

#include "family.h"
#include "gap_pairs.h"
#include "posed.h"

/* ---- Pairs ---- */

enum { ALL = 0, ONLY_BOXES = 1, BUT_BOXES = 2 };

/* How pairs are drawn: by a family; touching by features, in whole numbers; else random. Boxes in
 * any pose, and random pairs, with a gap are shifted to it. */
static const struct scenario {
    const char *name, *family;
    double gap;
    int which;
    int touches; /* 1 by a vertex, 2 by an edge, 3 (2D: 2) by a face of each */
    bool in_contact;
} scenarios[] = {{"random, meet", .in_contact = true},
                 {"random, apart"},
                 {"gap 1e-9", "gap-1e-9", 1e-9},
                 {"shallow, 1e-6", .gap = -1e-6, .which = BUT_BOXES},
                 {"overlap 1e-6", "overlap-1e-6", -1e-6},
                 {"overlap 1e-9", "overlap-1e-9", -1e-9},
                 {"touch, vertex", .which = BUT_BOXES, .touches = 1},
                 {"touch, edge", .which = BUT_BOXES, .touches = 2},
                 {"touch, face", .which = BUT_BOXES, .touches = 3},
                 {"touch, turned", "pose-turns", .which = ONLY_BOXES},
                 {"grid, pitch 1", "grid-integer"},
                 {"grid, pitch 0.1", "grid-0.1"}};

static bool is_boxes(const struct cell *cell)
{
    return cell->shape[0] == FMB_BOX;
}

/* Whether the pairs are those of gap_pairs.h, which are in 3D and at rest. */
static bool is_shifted(const struct scenario *scenario, const struct cell *cell)
{
    return scenario->gap != 0 && (is_boxes(cell) || !scenario->family);
}

static bool has(const struct scenario *scenario, const struct cell *cell)
{
    return scenario->which != (is_boxes(cell) ? BUT_BOXES : ONLY_BOXES) &&
           scenario->touches <= cell->dim &&
           !(is_shifted(scenario, cell) && (cell->dim == 2 || cell->moving));
}

static const struct family *family_of(const char *name)
{
    const struct family *family = family_by_name(name);
    for (size_t i = 0; !family; i++)
        if (strcmp(family_posed_at(i)->name, name) == 0)
            family = family_posed_at(i);
    return family;
}

static void draw_touching(struct draw *draw, const struct cell *cell, int touches,
                          struct question *out)
{
    const struct features features = {touches - 1, touches - 1, false};
    struct meeting meeting = meet_exactly(draw, cell, features, 9, 1);
    meeting_move_anyhow(draw, cell, &meeting);
    *out = meeting.question;
}

/* A cuboid along the axes as a box. */
static void make_box(struct solid *solid)
{
    double edge[FMB_DIM_MAX] = {0};
    for (int axis = 0; axis < solid->dim; axis++)
        for (int c = 0; c < solid->dim; c++)
            edge[axis] += solid->component[c][axis];
    memset(solid->component, 0, sizeof solid->component);
    for (int axis = 0; axis < solid->dim; axis++) {
        solid->component[axis][axis] = edge[axis] < 0 ? -edge[axis] : edge[axis];
        solid->local[axis] = edge[axis] / 2;
    }
    solid->shape = FMB_BOX;
}

/* Motion is scaled to a window of a second: windows are powers of two. */
static void draw_question(struct draw *draw, const struct cell *cell,
                          const struct scenario *scenario, struct question *out)
{
    const bool grid_of_boxes = is_boxes(cell) && scenario->which == ALL;
    struct cell drawn = *cell;
    if (grid_of_boxes)
        drawn.shape[0] = drawn.shape[1] = FMB_CUBOID;
    if (scenario->touches)
        draw_touching(draw, &drawn, scenario->touches, out);
    else
        family_draw(family_of(scenario->family), &drawn, draw, out);
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        for (int axis = 0; axis < cell->dim; axis++)
            solid->velocity[axis] *= cell->moving ? out->duration : 0;
        if (grid_of_boxes)
            make_box(solid);
    }
}

static struct scene scene_of_scenario(const struct bench *bench, const struct cell *cell,
                                      const struct scenario *scenario)
{
    struct draw draw = cell_draw(bench->seed, scenario->name, cell, 0);
    struct question *question = scene_allocate(bench->pairs, sizeof *question);
    for (size_t i = 0; i < bench->pairs; i++)
        draw_question(&draw, cell, scenario, &question[i]);
    const struct scene scene = scene_of_questions(question, bench->pairs);
    free(question);
    return scene;
}

static struct scene scene_of_gaps(const struct bench *bench, const struct cell *cell, double gap)
{
    struct gap_pairs pairs;
    gap_pairs_draw(cell, gap, bench->pairs, bench->seed, &pairs);
    const struct scene scene = pairs.scene;
    pairs.scene = (struct scene){.count = 0};
    gap_pairs_free(&pairs);
    return scene;
}

static void open_arena(const struct bench *bench, const struct cell *cell,
                       const struct scenario *scenario, struct arena *out)
{
    if (!scenario->family && !scenario->touches && scenario->gap == 0)
        arena_open(bench, cell, scenario->in_contact, out);
    else
        arena_of(bench,
                 is_shifted(scenario, cell) ? scene_of_gaps(bench, cell, scenario->gap)
                                            : scene_of_scenario(bench, cell, scenario),
                 pairs_side_by_side(bench->pairs), out);
}

/* ---- Races ---- */

/* BATCH_BOX after BATCH: the table shows the difference. */
static const enum contender own[] = {CONTENDER_BATCH, CONTENDER_BATCH_BOX, CONTENDER_SINGLE,
                                     CONTENDER_QUERY, CONTENDER_SAT,       CONTENDER_OBB};

static int list_raced(const struct cell *cell, enum contender raced[CONTENDERS_AND_PEERS])
{
    int count = 0;
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (contender_runs(own[i], cell))
            raced[count++] = own[i];
    for (int i = CONTENDERS; contender_name((enum contender) i); i++)
        if (contender_runs((enum contender) i, cell))
            raced[count++] = (enum contender) i;
    return count;
}

static bool any_meets(const unsigned char *verdict, size_t count)
{
    bool any = false;
    for (size_t i = 0; i < count; i++)
        any = any || verdict[i] != FMB_SEPARATED;
    return any;
}

/* Those of the engine are always right. */
static bool may_be_wrong(enum contender contender)
{
    return contender != CONTENDER_BATCH && contender != CONTENDER_BATCH_BOX &&
           contender != CONTENDER_SINGLE && contender != CONTENDER_QUERY;
}

static void put_method(struct bench *bench, enum contender contender, const struct spread *ns,
                       double wrong)
{
    if (may_be_wrong(contender))
        printf(" %5.1f", 100 * wrong);
    json_begin(&bench->json, NULL, '{');
    json_string(&bench->json, "name", contender_name(contender));
    json_number(&bench->json, "ns", ns->median);
    json_number(&bench->json, "low", ns->low);
    json_number(&bench->json, "high", ns->high);
    json_number(&bench->json, "wrong", wrong);
    json_end(&bench->json, '}');
}

static void race(struct bench *bench, const struct work *work, const enum contender *raced,
                 int count)
{
    struct race race = bench->race;
    struct spread times[CONTENDERS_AND_PEERS];
    unsigned char *certified = scene_allocate(work->count, 1);
    race.blocks = race.blocks < 7 ? race.blocks : 7;
    race_run(&race, work, raced, count, times);
    contender_run(CONTENDER_QUERY, work);
    memcpy(certified, work->verdicts, work->count);
    json_begin(&bench->json, "methods", '[');
    for (int i = 0; i < count; i++) {
        if (raced[i] != CONTENDER_BATCH_BOX)
            printf(" %8.1f", times[i].median);
        else if (any_meets(certified, work->count))
            printf(" %8.1f", times[i].median - times[i - 1].median);
        else
            printf(" %8s", "");
        put_method(bench, raced[i], &times[i], contender_wrong(raced[i], work, certified));
    }
    json_end(&bench->json, ']');
    free(certified);
}

/* ---- Tables ---- */

static void row(struct bench *bench, const struct cell *cell, const struct scenario *scenario,
                const enum contender *raced, int count)
{
    struct arena arena;
    bench_progress(scenario->name);
    open_arena(bench, cell, scenario, &arena);
    struct peer_solid *solids = scene_solids(&arena.scene);
    arena.work.peers = peers_open(solids, arena.scene.count);
    bench_progress(NULL);
    printf("%-15s", scenario->name);
    json_begin(&bench->json, NULL, '{');
    bench_put_cell(&bench->json, cell);
    json_string(&bench->json, "pairs_are", scenario->name);
    json_number(&bench->json, "pairs", (double) bench->pairs);
    race(bench, &arena.work, raced, count);
    json_end(&bench->json, '}');
    putchar('\n');
    peers_close(arena.work.peers);
    free(solids);
    arena_close(&arena);
}

static void table(struct bench *bench, const struct cell *cell)
{
    enum contender raced[CONTENDERS_AND_PEERS];
    char text[CELL_TEXT_MAX];
    const int count = list_raced(cell, raced);
    printf("\n%-15s", cell_text(cell, text));
    for (int i = 0; i < count; i++)
        printf(" %*s", may_be_wrong(raced[i]) ? 14 : 8,
               raced[i] == CONTENDER_BATCH_BOX ? "+box" : contender_name(raced[i]));
    putchar('\n');
    for (size_t i = 0; i < sizeof scenarios / sizeof *scenarios; i++)
        if (has(&scenarios[i], cell))
            row(bench, cell, &scenarios[i], raced, count);
}

void contacts_run(struct bench *bench)
{
    static const enum fmb_shape shapes[][2] = {{FMB_CUBOID, FMB_CUBOID},
                                               {FMB_CUBOID, FMB_TETRAHEDRON},
                                               {FMB_TETRAHEDRON, FMB_TETRAHEDRON},
                                               {FMB_BOX, FMB_BOX}};
    if (!bench_wants(bench, "contacts"))
        return;
    printf(
        "\nPairs that touch or nearly so, beside random ones; nanoseconds a pair, distinct pairs.\n"
        "After the time of each method that may be wrong, the percentage of its verdicts that "
        "are;\n"
        "touching is contact.\n");
    peers_help();
    json_begin(&bench->json, "contacts", '[');
    for (int dim = 3; dim >= 2; dim--)
        for (int moving = 0; moving < 2; moving++)
            for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
                table(bench, &(struct cell){dim, moving, {shapes[i][0], shapes[i][1]}});
    json_end(&bench->json, ']');
}
