/* Which pairs may meet: boxes against rational numbers, trees against testing every frame, whatever
 * the scene: so no pair that meets is lost. What a tree costs is counted in nodes, not in time. */

#include "unit.h"

#include <float.h>
#include <gmp.h>
#include <limits.h>
#include <math.h>

#include "draw.h"
#include "question.h"
#include "referee.h"
#include "tree.h"

enum { GUARD = 0xa5, GUARDS = 64 };

/* ---- Scenes ---- */

/* How the solids of a scene are drawn: number i of count. On input: its dimension, shape and
 * whether it is moving; the rest is 0. */
typedef void drawing(struct draw *draw, size_t i, size_t count, struct solid *solid);

struct scene {
    size_t count;
    double duration;
    struct solid *solid;        /* [count] */
    struct ready *ready;        /* [count]: what the frames refer to */
    struct fmb_prepared *frame; /* [count] */
};

/* On output: *out, which refers to *ready. */
static void prepare(const struct solid *solid, struct ready *ready, struct fmb_prepared *out)
{
    const struct question question = {*solid, *solid, 1};
    referee_ready(&question, ready);
    assert_int_equal(fmb_prepare(&ready->pair.a, 0, 1, out), FMB_OK);
}

static void scene_prepare(struct scene *scene, size_t i)
{
    prepare(&scene->solid[i], &scene->ready[i], &scene->frame[i]);
}

static void scene_open(size_t count, double duration, struct scene *out)
{
    out->count = count;
    out->duration = duration;
    out->solid = calloc(count + 1, sizeof *out->solid);
    out->ready = calloc(count + 1, sizeof *out->ready);
    out->frame = calloc(count + 1, sizeof *out->frame);
    assert_true(out->solid && out->ready && out->frame);
}

static void scene_close(struct scene *scene)
{
    free(scene->solid);
    free(scene->ready);
    free(scene->frame);
}

static void scene_draw(struct draw *draw, drawing *how, int dim, bool moving, struct scene *scene)
{
    for (size_t i = 0; i < scene->count; i++) {
        struct solid *solid = &scene->solid[i];
        *solid = (struct solid){.dim = dim,
                                .shape = question_draw_shape(draw, dim),
                                .moving = moving && draw_coin(draw)};
        how(draw, i, scene->count, solid);
        scene_prepare(scene, i);
    }
}

static void whole_numbers(struct draw *draw, size_t i, size_t count, struct solid *solid)
{
    (void) i;
    const int most = count > 30 ? (int) cbrt((double) count) : 3;
    draw_integers(draw, solid->dim, -most, most, solid->origin);
    draw_integers(draw, solid->dim, -2, 2, solid->velocity);
    for (int c = 0; c < solid_count(solid); c++)
        draw_integers(draw, solid->dim, -1, 1, solid->component[c]);
}

static void tenths(struct draw *draw, size_t i, size_t count, struct solid *solid)
{
    whole_numbers(draw, i, count, solid);
    for (int axis = 0; axis < solid->dim; axis++) {
        solid->origin[axis] *= 0.1;
        solid->velocity[axis] *= 0.1;
        for (int c = 0; c < solid_count(solid); c++)
            solid->component[c][axis] *= 0.1;
    }
}

static void draw_numbers(struct draw *draw, double (*number)(struct draw *draw),
                         struct solid *solid)
{
    for (int axis = 0; axis < solid->dim; axis++) {
        solid->origin[axis] = number(draw);
        solid->velocity[axis] = number(draw);
        for (int c = 0; c < solid_count(solid); c++)
            solid->component[c][axis] = draw_int(draw, 0, 4) ? number(draw) : 0;
    }
}

static void any_numbers(struct draw *draw, size_t i, size_t count, struct solid *solid)
{
    (void) i, (void) count;
    draw_numbers(draw, draw_finite, solid);
}

static double least_number(struct draw *draw)
{
    return draw_int(draw, -40, 40) * 0x1p-1074;
}

static double largest_number(struct draw *draw)
{
    static const double some[] = {DBL_MAX, DBL_MAX / 2, DBL_MAX * (1 - 0x1p-53), 0x1p1023, 0x1p970};
    const double x = some[draw_int(draw, 0, (int) COUNT(some) - 1)];
    return draw_coin(draw) ? x : -x;
}

static void least_numbers(struct draw *draw, size_t i, size_t count, struct solid *solid)
{
    (void) i, (void) count;
    draw_numbers(draw, least_number, solid);
}

static void largest_numbers(struct draw *draw, size_t i, size_t count, struct solid *solid)
{
    (void) i, (void) count;
    draw_numbers(draw, largest_number, solid);
}

/* Each has a size of its own, and is about as far out as that. */
static void of_every_size(struct draw *draw, size_t i, size_t count, struct solid *solid)
{
    (void) i, (void) count;
    const int e = draw_int(draw, -1000, 1000);
    for (int axis = 0; axis < solid->dim; axis++) {
        solid->origin[axis] = draw_log(draw, e, e + 2);
        solid->velocity[axis] = draw_log(draw, e - 3, e);
        for (int c = 0; c < solid_count(solid); c++)
            solid->component[c][axis] = draw_log(draw, e - 3, e);
    }
}

static void scattered(struct draw *draw, size_t i, size_t count, struct solid *solid)
{
    (void) i;
    const double wide = cbrt((double) count);
    for (int axis = 0; axis < solid->dim; axis++) {
        solid->origin[axis] = draw_uniform(draw, 0, wide);
        solid->velocity[axis] = draw_uniform(draw, -0.5, 0.5);
        for (int c = 0; c < solid_count(solid); c++)
            solid->component[c][axis] = draw_uniform(draw, -0.5, 0.5);
    }
}

static void all_equal(struct draw *draw, size_t i, size_t count, struct solid *solid)
{
    (void) draw, (void) i, (void) count;
    solid->shape = FMB_CUBOID;
    for (int axis = 0; axis < solid->dim; axis++) {
        solid->origin[axis] = 0.3;
        solid->component[axis][axis] = 1;
    }
}

/* Around one centre, each of another size, in no order. */
static void nested(struct draw *draw, size_t i, size_t count, struct solid *solid)
{
    (void) draw;
    const double half = (double) ((i * 37) % count + 1);
    solid->shape = FMB_CUBOID;
    for (int axis = 0; axis < solid->dim; axis++) {
        solid->origin[axis] = -half;
        solid->component[axis][axis] = 2 * half;
    }
}

/* Queries about the middle lie on one side of all others. */
static void odd_sequence(struct draw *draw, size_t i, size_t count, struct solid *solid)
{
    scattered(draw, i, count, solid);
    solid->origin[0] = (double) ((i * 37) % count);
    if (i % ((count + 15) / 16) == 0)
        solid->origin[0] = -1e6 - (double) i;
}

static drawing *const drawings[] = {whole_numbers, tenths,          any_numbers,   least_numbers,
                                    scattered,     largest_numbers, of_every_size, all_equal,
                                    nested,        odd_sequence};

/* ---- Boxes ---- */

static mpq_t exact, scratch;

static int set_up(void **state)
{
    mpq_inits(exact, scratch, NULL);
    return 0;
}

static int tear_down(void **state)
{
    mpq_clears(exact, scratch, NULL);
    return 0;
}

static void add_exactly(double x, double times)
{
    mpq_t factor;
    mpq_init(factor);
    mpq_set_d(scratch, x);
    mpq_set_d(factor, times);
    mpq_mul(scratch, scratch, factor);
    mpq_add(exact, exact, scratch);
    mpq_clear(factor);
}

/* Puts the lower end on an axis into exact, or minus the upper one for a sign of -1; the sum of the
 * magnitudes of what is added up is returned. */
static double exact_end(const struct solid *solid, double duration, int axis, int sign)
{
    double size = fabs(solid->origin[axis]), least = 0;
    mpq_set_d(exact, sign * solid->origin[axis]);
    for (int c = 0; c < solid_count(solid); c++) {
        const double x = sign * solid->component[c][axis];
        least = x < least ? x : least;
        if (solid->shape == FMB_CUBOID && x < 0) {
            add_exactly(x, 1);
            size -= x;
        }
    }
    if (solid->shape != FMB_CUBOID) {
        add_exactly(least, 1);
        size -= least;
    }
    if (solid->moving && sign * solid->velocity[axis] < 0) {
        add_exactly(sign * solid->velocity[axis], duration);
        size -= sign * solid->velocity[axis] * duration;
    }
    return size;
}

/* The sign of x - exact; of an infinite x, its own. */
static int side_of(double x)
{
    if (isinf(x))
        return x < 0 ? -1 : 1;
    mpq_set_d(scratch, x);
    return mpq_cmp(scratch, exact);
}

/* low <= the exact end, and at most some units in the last place of what was added up below it. */
static void expect_end(const struct solid *solid, double duration, double low, double size,
                       bool rounds)
{
    const struct question question = {*solid, *solid, duration};
    if (!(side_of(low) <= 0))
        referee_fail(&question, "the box does not hold the frame");
    if (!rounds && side_of(low) != 0)
        referee_fail(&question, "the box is wide though nothing rounds");
    if (isinf(low)) {
        assert_true(size >= DBL_MAX / 2);
        return;
    }
    mpq_set_d(scratch, low);
    mpq_sub(scratch, exact, scratch);
    assert_true(mpq_get_d(scratch) <= size * 0x1p-49 + 0x1p-1072);
}

static void boxes_hold_their_frames_and_are_tight(void **state)
{
    static const double durations[] = {0, 0x1p-1074, 1e-300, 0.1, 1, 2, 3, 1e300, DBL_MAX};
    struct draw draw;
    draw_begin(&draw, "boxes_hold_their_frames_and_are_tight");
    for (long n = draw_sample(40000); n > 0; n--) {
        const int kind = draw_int(&draw, 0, (int) COUNT(drawings) - 1);
        struct solid solid = {.dim = draw_int(&draw, 2, 3), .moving = draw_coin(&draw)};
        solid.shape = question_draw_shape(&draw, solid.dim);
        drawings[kind](&draw, (size_t) draw_int(&draw, 0, 9), 30, &solid);
        const bool whole = drawings[kind] == whole_numbers || drawings[kind] == nested;
        const double duration = whole ? draw_int(&draw, 0, 3)
                                      : durations[draw_int(&draw, 0, (int) COUNT(durations) - 1)];
        struct ready ready;
        struct fmb_prepared frame;
        prepare(&solid, &ready, &frame);
        const struct aabb box = aabb_of(&frame, duration);
        for (int axis = 0; axis < solid.dim; axis++)
            for (int end = 0; end < 2; end++) {
                const double size = exact_end(&solid, duration, axis, end ? -1 : 1);
                expect_end(&solid, duration, box.end[axis][end], size, !whole);
            }
    }
}

/* The sum by itself, with numbers that are hard to add: the sign of its error is what counts. */
static void sums_step_down_just_where_they_were_rounded_up(void **state)
{
    struct draw draw;
    long stepped = 0, kept = 0;
    draw_begin(&draw, "sums_step_down_just_where_they_were_rounded_up");
    for (long n = draw_sample(100000); n > 0; n--) {
        const double x = draw_coin(&draw) ? draw_finite(&draw) : draw_log(&draw, 960, 1023);
        int e = 0;
        frexp(x, &e);
        const int most = e < -1000 ? -1000 : e > 1023 ? 1023 : e;
        const double y = -fabs(draw_log(&draw, most - 60 < -1074 ? -1074 : most - 60, most));
        const lanes sum = aabb_sum_down((lanes){x, -x}, (lanes){y, y});
        for (int lane = 0; lane < 2; lane++) {
            const double from = lane ? -x : x;
            mpq_set_d(exact, from);
            mpq_set_d(scratch, y);
            mpq_add(exact, exact, scratch);
            assert_true(side_of(sum[lane]) <= 0);
            if (isinf(from + y))
                continue;
            const bool held = side_of(from + y) <= 0;
            const bool near_end = fabs(from) > DBL_MAX / 4 || fabs(y) > DBL_MAX / 4;
            assert_true(near_end || held == (sum[lane] == from + y));
            kept += held;
            stepped += !held;
        }
    }
    assert_true(kept > 0 && stepped > 0);
}

/* ---- Trees ---- */

struct planted {
    struct fmb_tree tree;
    char *memory, *at;
    size_t bytes;
    unsigned *found, *expected; /* [count] */
};

static void put_box(const void *context, unsigned index, double box[2][FMB_DIM_MAX])
{
    const struct scene *scene = context;
    fmb_box_of(&scene->frame[index], scene->duration, box);
}

/* At any address, with guards after it. */
static void plant(struct draw *draw, const struct scene *scene, struct planted *out)
{
    const size_t offset = (size_t) draw_int(draw, 0, 63);
    out->bytes = fmb_tree_bytes(scene->count);
    assert_true(out->bytes <= 100 * scene->count + 400);
    out->memory = malloc(offset + out->bytes + GUARDS);
    out->found = calloc(scene->count + 1, sizeof *out->found);
    out->expected = calloc(scene->count + 1, sizeof *out->expected);
    assert_true(out->memory && out->found && out->expected);
    out->at = out->memory + offset;
    memset(out->memory, GUARD, offset + out->bytes + GUARDS);
    out->found[scene->count] = out->expected[scene->count] = UINT_MAX;
    const struct fmb_boxes boxes = {
        scene->count && !(prepared_kind(scene->frame) & PREPARED_3D) ? 2 : 3, put_box, scene, NULL};
    assert_int_equal(fmb_tree_build(&boxes, scene->count, scene->duration, out->at, &out->tree),
                     FMB_OK);
}

static void uproot(struct planted *planted)
{
    for (char *guard = planted->memory; guard < planted->at; guard++)
        assert_int_equal((unsigned char) *guard, GUARD);
    for (int i = 0; i < GUARDS; i++)
        assert_int_equal((unsigned char) planted->at[planted->bytes + (size_t) i], GUARD);
    free(planted->memory);
    free(planted->found);
    free(planted->expected);
}

/* By testing every frame, without code of the tree. */
static size_t find_all(const struct scene *scene, const struct fmb_prepared *frame, unsigned from,
                       unsigned *out)
{
    const struct aabb one = aabb_of(frame, scene->duration);
    size_t found = 0;
    for (unsigned i = from; i < scene->count; i++) {
        const struct aabb other = aabb_of(&scene->frame[i], scene->duration);
        bool meet = true;
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            meet = meet && one.end[axis][0] <= -other.end[axis][1] &&
                   other.end[axis][0] <= -one.end[axis][1];
        if (meet)
            out[found++] = i;
    }
    return found;
}

static void expect_same(const struct scene *scene, struct planted *planted,
                        const struct fmb_prepared *frame, unsigned from)
{
    const struct aabb box = aabb_of(frame, scene->duration);
    const size_t count = tree_query(&planted->tree, &box, from, planted->found);
    const size_t expected = find_all(scene, frame, from, planted->expected);
    assert_int_equal(count, expected);
    assert_memory_equal(planted->found, planted->expected, count * sizeof *planted->found);
    assert_int_equal(planted->found[scene->count], UINT_MAX);
}

static void query_some(struct draw *draw, const struct scene *scene, struct planted *planted,
                       const struct scene *others)
{
    for (int n = 0; n < 40 && scene->count; n++) {
        const unsigned i = (unsigned) (draw_bits(draw) % scene->count);
        expect_same(scene, planted, &scene->frame[i], draw_coin(draw) ? i + 1 : 0);
        expect_same(scene, planted, &scene->frame[i], (unsigned) (draw_bits(draw) % scene->count));
        expect_same(scene, planted, &others->frame[i], 0);
    }
}

/* Counts in times[i * count + j] how often fmb_tree_pairs() returns the pair, in calls of any
 * capacity. */
static void count_pairs(struct draw *draw, const struct fmb_tree *a, const struct fmb_tree *b,
                        unsigned char *times)
{
    enum { MOST = 200 };
    unsigned pairs[MOST + 1][2];
    struct fmb_tree_cursor cursor = {0};
    for (size_t count = 1; count > 0;) {
        const size_t capacity = (size_t) draw_int(draw, FMB_TREE_CAPACITY_MIN, MOST);
        pairs[capacity][0] = UINT_MAX;
        assert_int_equal(fmb_tree_pairs(a, b, &cursor, pairs, capacity, &count), FMB_OK);
        assert_true(count <= capacity && pairs[capacity][0] == UINT_MAX);
        for (size_t k = 0; k < count; k++) {
            assert_true(pairs[k][0] < a->frame_count && pairs[k][1] < b->frame_count);
            times[pairs[k][0] * b->frame_count + pairs[k][1]]++;
        }
    }
}

static void expect_same_pairs(struct draw *draw, const struct scene *scene, struct planted *planted,
                              const struct scene *others, const struct planted *second)
{
    unsigned char *times = calloc(scene->count * others->count + 1, 1);
    assert_non_null(times);
    count_pairs(draw, &planted->tree, &second->tree, times);
    for (unsigned i = 0; i < scene->count; i++) {
        const unsigned from = scene == others ? i + 1 : 0;
        const size_t found = find_all(others, &scene->frame[i], from, second->expected);
        for (size_t k = 0; k < found; k++)
            times[i * others->count + second->expected[k]] ^= 1;
    }
    for (size_t k = 0; k < scene->count * others->count; k++)
        assert_int_equal(times[k], 0);
    free(times);
}

static void pairs_of_trees_are_what_testing_every_pair_finds(void **state)
{
    struct draw draw;
    draw_begin(&draw, "pairs_of_trees_are_what_testing_every_pair_finds");
    for (long n = draw_sample(160); n > 0; n--) {
        struct scene scene, others;
        struct planted planted, second;
        const int dim = draw_int(&draw, 2, 3);
        drawing *how = drawings[n % (long) COUNT(drawings)];
        scene_open((size_t) draw_int(&draw, 0, 200), 1, &scene);
        scene_open((size_t) draw_int(&draw, 0, 200), 1, &others);
        scene_draw(&draw, how, dim, true, &scene);
        scene_draw(&draw, how, dim, false, &others);
        plant(&draw, &scene, &planted);
        plant(&draw, &others, &second);
        expect_same_pairs(&draw, &scene, &planted, &scene, &planted);
        expect_same_pairs(&draw, &scene, &planted, &others, &second);
        uproot(&planted);
        uproot(&second);
        scene_close(&scene);
        scene_close(&others);
    }
}

static double draw_duration(struct draw *draw)
{
    static const double some[] = {0, 1, 1, 1, 0.1, 1e-300, 1e300};
    return some[draw_int(draw, 0, (int) COUNT(some) - 1)];
}

static size_t draw_count(struct draw *draw)
{
    switch (draw_int(draw, 0, 3)) {
    case 0: return (size_t) draw_int(draw, 0, 20);
    case 1: return (size_t) draw_int(draw, 50, 80);
    case 2: return (size_t) draw_int(draw, 100, 300);
    default: return (size_t) draw_int(draw, 300, 2500);
    }
}

/* Queried with their own frames, and with those of another scene. */
static void trees_find_what_testing_every_frame_finds(void **state)
{
    struct draw draw;
    draw_begin(&draw, "trees_find_what_testing_every_frame_finds");
    for (long n = draw_sample(240); n > 0; n--) {
        drawing *first = drawings[n % (long) COUNT(drawings)];
        drawing *second = drawings[draw_int(&draw, 0, (int) COUNT(drawings) - 1)];
        const size_t count = draw_count(&draw);
        const int dim = draw_int(&draw, 2, 3);
        const bool moving = draw_coin(&draw);
        struct scene scene, others;
        struct planted planted;
        scene_open(count, draw_duration(&draw), &scene);
        scene_open(count, scene.duration, &others);
        scene_draw(&draw, first, dim, moving, &scene);
        scene_draw(&draw, second, dim, moving, &others);
        plant(&draw, &scene, &planted);
        query_some(&draw, &scene, &planted, &others);
        uproot(&planted);
        scene_close(&scene);
        scene_close(&others);
    }
}

/* The order is all frames, and what is below a node lies in its box. */
static void expect_sound(const struct fmb_tree *tree)
{
    unsigned char *seen = calloc(tree->frame_count + 1, 1);
    size_t next = 0;
    assert_non_null(seen);
    for (size_t k = 0; k < tree->frame_count; k++)
        seen[tree->order[k]]++;
    for (size_t k = 0; k < tree->frame_count; k++)
        assert_int_equal(seen[k], 1);
    for (size_t at = 0; at < tree->node_count; at++) {
        const struct fmb_tree_node *node = &tree->nodes[at];
        assert_true(node->skip > at && node->skip <= tree->node_count);
        assert_true(node->count <= TREE_LEAF);
        if (node->count) {
            assert_int_equal(node->first, next);
            next += node->count;
        }
    }
    assert_int_equal(next, tree->frame_count);
    free(seen);
}

static void trees_of_every_small_number_are_sound(void **state)
{
    struct draw draw;
    draw_begin(&draw, "trees_of_every_small_number_are_sound");
    for (size_t count = 0; count < 300; count++) {
        struct scene scene;
        struct planted planted;
        scene_open(count, 1, &scene);
        scene_draw(&draw, drawings[count % COUNT(drawings)], 3, false, &scene);
        plant(&draw, &scene, &planted);
        expect_sound(&planted.tree);
        uproot(&planted);
        scene_close(&scene);
    }
}

/* ---- What a tree costs ---- */

static void cube_at(const double origin[3], const double size[3], struct solid *out)
{
    *out = (struct solid){.dim = 3, .shape = FMB_CUBOID};
    for (int axis = 0; axis < 3; axis++) {
        out->origin[axis] = origin[axis];
        out->component[axis][axis] = size[axis];
    }
}

/* Scenes in space, whose frames have few neighbours each, but whose boxes are of no help in one way
 * or another. */

static void line(int axis, double at, struct solid *out)
{
    double origin[3] = {0}, size[3] = {0.5, 0.5, 0.5};
    origin[axis] = at;
    cube_at(origin, size, out);
}

static void line_x(struct draw *draw, size_t i, size_t count, struct solid *out)
{
    (void) draw, (void) count;
    line(0, (double) i, out);
}

static void line_y_backwards(struct draw *draw, size_t i, size_t count, struct solid *out)
{
    (void) draw;
    line(1, (double) (count - i), out);
}

static void line_z_mixed(struct draw *draw, size_t i, size_t count, struct solid *out)
{
    (void) draw;
    line(2, (double) ((i * 7919) % count), out);
}

/* As long as all of them reach, and more, along x. */
static void planks(struct draw *draw, size_t i, size_t count, struct solid *out)
{
    const double size[3] = {1e9, 0.5, 0.5};
    (void) count;
    cube_at((double[3]){draw_uniform(draw, 0, 1e8), (double) i, 0}, size, out);
}

static void grid(struct draw *draw, size_t i, size_t count, struct solid *out)
{
    const size_t side = (size_t) ceil(cbrt((double) count));
    const double size[3] = {1, 1, 1};
    (void) draw;
    cube_at(
        (double[3]){(double) (i / side / side), (double) (i / side % side), (double) (i % side)},
        size, out);
}

static void cloud(struct draw *draw, size_t i, size_t count, struct solid *out)
{
    const double wide = cbrt((double) count), size[3] = {0.5, 0.5, 0.5};
    (void) i;
    cube_at((double[3]){draw_uniform(draw, 0, wide), draw_uniform(draw, 0, wide),
                        draw_uniform(draw, 0, wide)},
            size, out);
}

/* With some as far out as numbers go, and one that holds everything. */
static void cloud_and_outliers(struct draw *draw, size_t i, size_t count, struct solid *out)
{
    const double all[3] = {DBL_MAX, DBL_MAX, DBL_MAX}, size[3] = {0.5, 0.5, 0.5};
    if (i == count / 3)
        cube_at((double[3]){-DBL_MAX / 2, -DBL_MAX / 2, -DBL_MAX / 2}, all, out);
    else if (i % 1000 == 7)
        cube_at((double[3]){draw_log(draw, 900, 1000), draw_log(draw, 900, 1000), 0}, size, out);
    else
        cloud(draw, i, count, out);
}

/* Clouds within clouds, each by far smaller than the one before. */
static void clouds_of_every_size(struct draw *draw, size_t i, size_t count, struct solid *out)
{
    const double scale = ldexp(1, -900 + 30 * (int) (i % 60)), wide = cbrt((double) count / 60);
    const double size[3] = {scale / 2, scale / 2, scale / 2};
    cube_at((double[3]){draw_uniform(draw, 1, wide + 1) * scale,
                        draw_uniform(draw, 1, wide + 1) * scale,
                        draw_uniform(draw, 1, wide + 1) * scale},
            size, out);
}

struct cost {
    double visits, found; /* of a frame that is queried */
};

static struct cost cost_of(struct draw *draw, drawing *how, size_t count)
{
    struct scene scene;
    struct planted planted;
    size_t visits = 0, found = 0;
    scene_open(count, 1, &scene);
    for (size_t i = 0; i < count; i++) {
        how(draw, i, count, &scene.solid[i]);
        scene_prepare(&scene, i);
    }
    plant(draw, &scene, &planted);
    for (unsigned i = 0; i < count; i++) {
        const struct aabb box = aabb_of(&scene.frame[i], 1);
        found += tree_query_unsorted(&planted.tree, &box, 0, planted.found, &visits);
    }
    uproot(&planted);
    scene_close(&scene);
    return (struct cost){(double) visits / (double) count, (double) found / (double) count};
}

static void queries_cost_no_more_than_a_few_nodes_a_level(void **state)
{
    static const struct {
        const char *name;
        drawing *how;
    } scenes[] = {{"line along x", line_x},
                  {"line along y, backwards", line_y_backwards},
                  {"line along z, mixed", line_z_mixed},
                  {"planks", planks},
                  {"grid", grid},
                  {"cloud", cloud},
                  {"cloud and outliers", cloud_and_outliers},
                  {"clouds of every size", clouds_of_every_size}};
    struct draw draw;
    draw_begin(&draw, "queries_cost_no_more_than_a_few_nodes_a_level");
    const size_t most = draw_sample(8) == 8 ? 16000 : 4000;
    for (size_t k = 0; k < COUNT(scenes); k++)
        for (size_t count = 1000; count <= most; count *= 4) {
            const struct cost cost = cost_of(&draw, scenes[k].how, count);
            printf("# %-24s %6zu frames: %6.1f nodes, %5.2f found\n", scenes[k].name, count,
                   cost.visits, cost.found);
            assert_true(cost.found < 30);
            assert_true(cost.visits <= 6 * log2((double) count) + 5 * cost.found);
        }
}

/* Where all are found, no node is visited twice; and of boxes around one centre, those that are too
 * small are left out together. */
static void boxes_with_one_centre_cost_what_is_found(void **state)
{
    enum { FRAMES = 3000 };
    struct draw draw;
    draw_begin(&draw, "boxes_with_one_centre_cost_what_is_found");
    for (int kind = 0; kind < 2; kind++) {
        struct scene scene;
        struct planted planted;
        size_t visits = 0;
        scene_open(FRAMES, 1, &scene);
        scene_draw(&draw, kind ? nested : all_equal, 3, false, &scene);
        plant(&draw, &scene, &planted);
        const struct aabb box = aabb_of(&scene.frame[0], 1);
        assert_int_equal(tree_query_unsorted(&planted.tree, &box, 0, planted.found, &visits),
                         FRAMES);
        assert_int_equal(visits, planted.tree.node_count);
        const struct aabb outside = {{{FRAMES - 100, 100 - FRAMES}, {0, 0}, {0, 0}}};
        visits = 0;
        assert_int_equal(tree_query_unsorted(&planted.tree, &outside, 0, planted.found, &visits),
                         kind ? 101 : 0);
        assert_true(visits < 60);
        uproot(&planted);
        scene_close(&scene);
    }
}

/* ---- What is refused ---- */

static void queries_that_are_not_supported_are_refused(void **state)
{
    struct draw draw;
    struct scene deep;
    struct planted planted;
    size_t count = 7;
    draw_begin(&draw, "queries_that_are_not_supported_are_refused");
    scene_open(4, 1, &deep);
    scene_draw(&draw, whole_numbers, 3, false, &deep);
    plant(&draw, &deep, &planted);
    struct fmb_tree *tree = &planted.tree, other;
    struct fmb_tree_cursor cursor = {0};
    unsigned pairs[FMB_TREE_CAPACITY_MIN][2];
    assert_int_equal(fmb_tree_pairs(tree, tree, &cursor, pairs, FMB_TREE_CAPACITY_MIN - 1, &count),
                     FMB_OVER_LIMIT);
    other = *tree;
    other.dim = 2;
    assert_int_equal(fmb_tree_pairs(tree, &other, &cursor, pairs, FMB_TREE_CAPACITY_MIN, &count),
                     FMB_DIMENSIONS_DIFFER);
    other.dim = 3;
    other.duration = 2;
    assert_int_equal(fmb_tree_pairs(tree, &other, &cursor, pairs, FMB_TREE_CAPACITY_MIN, &count),
                     FMB_BAD_DURATION);
    assert_int_equal(count, 0);
    assert_true(fmb_tree_bytes(SIZE_MAX) == SIZE_MAX);
    assert_true(fmb_tree_bytes(SIZE_MAX / 64) == SIZE_MAX);
    assert_true(fmb_tree_bytes(UINT_MAX) == SIZE_MAX);
    uproot(&planted);
    scene_close(&deep);
}

/* ---- Boxes that a program gives ---- */

/* In the plane the third numbers of boxes are not read. */
static void put_flat_box(const void *context, unsigned index, double box[2][FMB_DIM_MAX])
{
    const double(*at)[2] = context;
    for (int axis = 0; axis < 2; axis++)
        box[0][axis] = box[1][axis] = at[index][axis];
    box[0][2] = NAN;
    box[1][2] = -INFINITY;
}

static void boxes_in_the_plane(void **state)
{
    static const double at[4][2] = {{0, 0}, {1, 0}, {0, 0}, {1, -0.0}};
    static const unsigned expected[2][2] = {{0, 2}, {1, 3}};
    const struct fmb_boxes boxes = {2, put_flat_box, at, NULL};
    struct fmb_tree tree;
    struct fmb_tree_cursor cursor = {0};
    unsigned pairs[FMB_TREE_CAPACITY_MIN][2];
    size_t count;
    void *memory = malloc(fmb_tree_bytes(4));
    assert_int_equal(fmb_tree_build(&boxes, 4, 1, memory, &tree), FMB_OK);
    assert_int_equal(fmb_tree_pairs(&tree, &tree, &cursor, pairs, FMB_TREE_CAPACITY_MIN, &count),
                     FMB_OK);
    assert_int_equal(count, 2);
    assert_memory_equal(pairs, expected, sizeof expected);
    free(memory);
}

static void boxes_that_cannot_be_are_refused(void **state)
{
    static const double bad[] = {-1, -0x1p-1074, INFINITY, NAN};
    struct fmb_boxes boxes = {3, put_flat_box, NULL, NULL};
    struct fmb_tree tree;
    for (size_t i = 0; i < COUNT(bad); i++) {
        tree.frame_count = 7;
        assert_int_equal(fmb_tree_build(&boxes, 3, bad[i], NULL, &tree), FMB_BAD_DURATION);
        assert_int_equal(tree.frame_count, 0);
    }
    assert_int_equal(fmb_tree_build(&boxes, UINT_MAX, 1, NULL, &tree), FMB_OVER_LIMIT);
    assert_int_equal(fmb_tree_build(&boxes, 0, 1, NULL, &tree), FMB_OK);
    assert_int_equal(tree.frame_count, 0);
    boxes.dim = 4;
    assert_int_equal(fmb_tree_build(&boxes, 3, 1, NULL, &tree), FMB_WRONG_DIMENSION);
    boxes.dim = 1;
    assert_int_equal(fmb_tree_build(&boxes, 3, 1, NULL, &tree), FMB_WRONG_DIMENSION);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_hold_their_frames_and_are_tight),
        cmocka_unit_test(sums_step_down_just_where_they_were_rounded_up),
        cmocka_unit_test(trees_of_every_small_number_are_sound),
        cmocka_unit_test(trees_find_what_testing_every_frame_finds),
        cmocka_unit_test(pairs_of_trees_are_what_testing_every_pair_finds),
        cmocka_unit_test(queries_cost_no_more_than_a_few_nodes_a_level),
        cmocka_unit_test(boxes_with_one_centre_cost_what_is_found),
        cmocka_unit_test(queries_that_are_not_supported_are_refused),
        cmocka_unit_test(boxes_in_the_plane),
        cmocka_unit_test(boxes_that_cannot_be_are_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
