/* Scenes against fmb_decide() of each pair: the same pairs, numbers and bits, whatever the kind of
 * pairs, the slots, the wants and the first pair. */

#include "unit.h"

#include <math.h>

#include "draw.h"
#include "fmb.h"

enum {
    SOME = 48,
    PLACEMENTS_MAX = 160,
    FRAMES_MAX = 90,
    LISTED_MAX = 400,
    IGNORED_MAX = 60,
    GUARDS = 64
};

/* A scene with everything it refers to. */
struct world {
    int dim;
    size_t count;
    struct fmb_frame frame[PLACEMENTS_MAX][FRAMES_MAX];
    struct fmb_body body[PLACEMENTS_MAX];
    struct fmb_placement placement[PLACEMENTS_MAX];
    unsigned pair[LISTED_MAX][2], ignored[IGNORED_MAX][2];
    struct fmb_scene scene;
};

static int below(struct draw *draw, int end)
{
    return (int) (draw_bits(draw) % (uint64_t) end);
}

/* ---- Drawing ---- */

/* Small whole numbers, so that contacts of every kind are common. */
static void draw_frame(struct draw *draw, int dim, int spread, struct fmb_frame *out)
{
    const int shape = 1 + below(draw, 4);
    double number[12];
    size_t count;
    if (shape == FMB_FACE && dim == 2) {
        draw_frame(draw, dim, spread, out);
        return;
    }
    count = shape == FMB_BOX ? 2 * (size_t) dim
                             : (size_t) (dim * (1 + fmb_component_count(dim, shape)));
    for (size_t i = 0; i < count; i++)
        number[i] = i < (size_t) dim   ? below(draw, 2 * spread + 1) - spread
                    : shape == FMB_BOX ? below(draw, 4)
                                       : below(draw, 7) - 3;
    if (below(draw, 8) == 0)
        for (size_t i = 0; i < count; i++)
            number[i] = number[i] * 0.1;
    assert_int_equal(fmb_frame_make(dim, shape, number, count, out), FMB_OK);
}

static void draw_orientation(struct draw *draw, int dim, struct fmb_placement *out)
{
    const int numbers = dim == 2 ? 2 : 4, kind = below(draw, 4);
    if (kind == 0)
        return;
    out->orientation_count = numbers;
    do {
        for (int i = 0; i < numbers; i++)
            out->orientation[i] = kind == 1 ? draw_uniform(draw, -1, 1) : below(draw, 3) - 1;
    } while (out->orientation[0] == 0 && out->orientation[1] == 0 && out->orientation[2] == 0 &&
             out->orientation[3] == 0);
}

static void draw_pose(struct draw *draw, int wide, bool moving, struct fmb_placement *out)
{
    const int dim = out->body->dim;
    out->orientation_count = 0;
    memset(out->orientation, 0, sizeof out->orientation);
    draw_orientation(draw, dim, out);
    for (int axis = 0; axis < dim; axis++) {
        out->position[axis] = below(draw, 2 * wide + 1) - wide;
        out->velocity[axis] = moving && below(draw, 2) ? below(draw, 5) - 2 : 0;
    }
}

static void draw_placements(struct draw *draw, size_t most_frames, struct world *out)
{
    const int wide = 2 + below(draw, 12);
    const bool moving = below(draw, 2);
    for (size_t i = 0; i < out->count; i++) {
        const size_t frames = 1 + (size_t) below(draw, (int) most_frames);
        for (size_t k = 0; k < frames; k++)
            draw_frame(draw, out->dim, frames > 1 ? 1 + (int) frames / 10 : 1, &out->frame[i][k]);
        assert_int_equal(fmb_body_make_frames(out->frame[i], frames, &out->body[i]), FMB_OK);
        struct fmb_placement *placement = &out->placement[i];
        *placement = (struct fmb_placement){.body = &out->body[below(draw, (int) i + 1)]};
        draw_pose(draw, wide, moving, placement);
    }
}

static void draw_two(struct draw *draw, size_t count, unsigned out[2])
{
    out[0] = (unsigned) below(draw, (int) count);
    do
        out[1] = (unsigned) below(draw, (int) count);
    while (out[1] == out[0]);
}

static void draw_world(struct draw *draw, size_t count, size_t most_frames, struct world *out)
{
    static unsigned worlds; /* so far */
    memset(out, 0, sizeof *out);
    out->dim = 2 + below(draw, 2);
    out->count = count;
    draw_placements(draw, most_frames, out);
    struct fmb_scene *scene = &out->scene;
    *scene = (struct fmb_scene){
        .placements = out->placement,
        .placement_count = count,
        .duration = below(draw, 3),
        .want = (unsigned) (below(draw, 2) * FMB_WANT_TIMES + below(draw, 2) * FMB_WANT_BOX +
                            (below(draw, 3) == 0) * FMB_WANT_GAP) |
                (worlds++ % 3 == 0 ? FMB_WANT_POINT : 0),
        .margin = below(draw, 3) ? 0 : 0.25 * below(draw, 12),
        .which = (enum fmb_pairs) below(draw, 3)};
    if (scene->which == FMB_PAIRS_ACROSS)
        scene->split = (size_t) below(draw, (int) count + 1);
    if (scene->which == FMB_PAIRS_LISTED && count > 1) {
        scene->pairs = (const unsigned(*)[2]) out->pair;
        scene->pair_count = (size_t) below(draw, most_frames > 1 ? 60 : LISTED_MAX);
        for (size_t i = 0; i < scene->pair_count; i++)
            draw_two(draw, count, out->pair[i]);
    } else if (count > 1 && below(draw, 2)) {
        scene->ignored = (const unsigned(*)[2]) out->ignored;
        scene->ignored_count = (size_t) below(draw, IGNORED_MAX);
        for (size_t i = 0; i < scene->ignored_count; i++)
            draw_two(draw, count, out->ignored[i]);
    }
    scene->instant = scene->duration == 0;
    for (size_t i = 0; i < count && scene->which != FMB_PAIRS_LISTED && below(draw, 4) > 0; i++)
        out->placement[i].group = below(draw, 3) - 1;
    for (size_t i = count; i > 1 && scene->which != FMB_PAIRS_LISTED && below(draw, 8) > 0; i--)
        out->placement[i - 1].group = 1; /* obstacles */
    if (below(draw, 2))
        scene->first_pair = draw_bits(draw) % (fmb_scene_pair_count(scene) + 1);
}

/* ---- Truth ---- */

static bool is_ignored(const struct fmb_scene *scene, unsigned a, unsigned b)
{
    const struct fmb_placement *placement = scene->placements;
    if (placement[a].group != 0 && placement[a].group == placement[b].group)
        return true;
    for (size_t i = 0; i < scene->ignored_count; i++)
        if ((scene->ignored[i][0] == a && scene->ignored[i][1] == b) ||
            (scene->ignored[i][0] == b && scene->ignored[i][1] == a))
            return true;
    return false;
}

/* Goes on to the next pair, in the order of the numbers. False: there is none. */
static bool next_pair(const struct fmb_scene *scene, unsigned long long number, unsigned pair[2])
{
    const unsigned n = (unsigned) scene->placement_count;
    if (scene->which == FMB_PAIRS_LISTED) {
        if (number == scene->pair_count)
            return false;
        memcpy(pair, scene->pairs[number], 2 * sizeof *pair);
        return true;
    }
    const bool across = scene->which == FMB_PAIRS_ACROSS;
    const unsigned rows = across ? (unsigned) scene->split : n;
    unsigned b = number == 0 ? (across ? rows : 1) : pair[1] + 1, a = number == 0 ? 0 : pair[0];
    for (; a < rows; a++, b = across ? rows : a + 1)
        if (b < n) {
            pair[0] = a;
            pair[1] = b;
            return true;
        }
    return false;
}

struct truth {
    unsigned pair[2];
    unsigned long long number;
    struct fmb_answer answer;
};

static bool wants_gaps(const struct fmb_scene *scene)
{
    return scene->want & FMB_WANT_GAP || scene->margin > 0;
}

static bool is_near(const struct fmb_scene *scene, const struct fmb_answer *answer)
{
    return scene->margin > 0 && answer->verdict == FMB_SEPARATED &&
           answer->gap.bounds[0] <= scene->margin;
}

static size_t find_truth(const struct fmb_scene *scene, struct truth *out)
{
    const struct fmb_method *method = scene->method ? scene->method : fmb_method_default();
    unsigned pair[2] = {0, 0};
    unsigned long long number = 0;
    size_t count = 0;
    for (; next_pair(scene, number, pair); number++) {
        struct truth *truth = &out[count];
        if (number < scene->first_pair || is_ignored(scene, pair[0], pair[1]))
            continue;
        truth->number = number;
        memcpy(truth->pair, pair, sizeof pair);
        fmb_decide(method, &scene->placements[pair[0]], &scene->placements[pair[1]],
                   scene->duration,
                   (scene->want & (FMB_WANT_BOX | FMB_WANT_POINT)) |
                       (wants_gaps(scene) ? FMB_WANT_GAP : 0),
                   &truth->answer);
        count += scene->which == FMB_PAIRS_LISTED || truth->answer.verdict != FMB_SEPARATED ||
                 is_near(scene, &truth->answer);
    }
    assert_int_equal(number, fmb_scene_pair_count(scene));
    return count;
}

/* ---- Comparing ---- */

static void check_numbers(const double *got, const double *truth, size_t count, bool is_there)
{
    for (size_t i = 0; i < count; i++)
        if (is_there)
            assert_memory_equal(&got[i], &truth[i], sizeof *got);
        else
            assert_true(isnan(got[i]));
}

static void check_gap(const struct fmb_scene *scene, const struct fmb_gap *got,
                      const struct fmb_answer *truth)
{
    const struct fmb_gap *gap = &truth->gap;
    if (!truth->has_gap || (truth->verdict == FMB_SEPARATED && !(scene->want & FMB_WANT_GAP) &&
                            gap->bounds[0] > scene->margin)) {
        assert_true(isnan(got->bounds[0]) && isnan(got->bounds[1]));
        return;
    }
    assert_memory_equal(got->bounds, gap->bounds, sizeof gap->bounds);
    assert_memory_equal(got->direction, gap->direction, sizeof gap->direction);
    assert_int_equal(got->has_witness, gap->has_witness);
    assert_memory_equal(&got->time, &gap->time, sizeof gap->time);
    assert_memory_equal(got->witness, gap->witness, sizeof gap->witness);
    assert_memory_equal(got->frame, gap->frame, sizeof gap->frame);
}

static void check_answer(const struct fmb_scene *scene, const struct fmb_scene_answers *answers,
                         size_t k, const struct truth *truth)
{
    assert_memory_equal(answers->pairs[k], truth->pair, sizeof truth->pair);
    assert_int_equal(answers->verdicts[k], truth->answer.verdict);
    assert_true(!!(scene->want & FMB_WANT_TIMES) == !!answers->contacts);
    assert_true(!!(scene->want & FMB_WANT_BOX) == !!answers->boxes);
    assert_true(!!(scene->want & FMB_WANT_POINT) == !!answers->points);
    assert_true(wants_gaps(scene) == !!answers->gaps);
    if (answers->gaps)
        check_gap(scene, &answers->gaps[k], &truth->answer);
    if (answers->contacts)
        check_numbers(answers->contacts[k], truth->answer.contact, 2, truth->answer.has_contact);
    if (answers->boxes)
        for (int end = 0; end < 2; end++)
            check_numbers(answers->boxes[k][end], truth->answer.box[end],
                          (size_t) scene->placements->body->dim, truth->answer.has_box);
    if (answers->points)
        check_numbers(answers->points[k], truth->answer.point, 1 + FMB_DIM_MAX,
                      truth->answer.has_point);
}

static size_t near_pairs; /* so far */

/* Returns how many of the pairs meet. */
static size_t check_steps(const struct fmb_scene *scene, struct fmb_scene_state *state)
{
    static struct truth truth[LISTED_MAX + PLACEMENTS_MAX * PLACEMENTS_MAX];
    const size_t count = find_truth(scene, truth);
    struct fmb_scene_answers answers;
    size_t at = 0, meeting = 0;
    for (bool done = false; !done;) {
        done = fmb_scene_step(state, &answers);
        for (size_t k = 0; k < answers.count; k++, at++) {
            assert_true(at < count);
            check_answer(scene, &answers, k, &truth[at]);
            assert_int_equal(fmb_scene_number(state, k), truth[at].number);
            meeting += truth[at].answer.verdict > FMB_SEPARATED;
            near_pairs += is_near(scene, &truth[at].answer);
        }
        const unsigned long long next = fmb_scene_next_pair(state);
        assert_true(at == 0 || truth[at - 1].number < next);
        assert_true(at == count || truth[at].number >= next);
        assert_true(done == (next == fmb_scene_pair_count(scene)));
    }
    assert_int_equal(at, count);
    return meeting;
}

static size_t check_scene(const struct fmb_scene *scene, size_t slots)
{
    struct fmb_scene_limits limits;
    fmb_scene_limits_of(scene, &limits);
    limits.slots = slots ? slots : limits.slots;
    const size_t bytes = fmb_scene_bytes(&limits);
    unsigned char *memory = malloc(bytes + GUARDS);
    struct fmb_scene_state *state;
    assert_non_null(memory);
    memset(memory, 0xa5, bytes + GUARDS);
    assert_int_equal(fmb_scene_begin(scene, &limits, memory, &state), FMB_OK);
    const size_t meeting = check_steps(scene, state);
    for (size_t i = bytes; i < bytes + GUARDS; i++)
        assert_int_equal(memory[i], 0xa5);
    free(memory);
    return meeting;
}

static struct world world;

static int rounds(int usual)
{
    return getenv("FMB_FAST") ? usual / 3 : usual;
}

static void random_scenes(void **state)
{
    struct draw draw = {0x5ce9e5};
    size_t meeting = 0;
    const size_t scenes = (size_t) draw_sample(400);
    for (size_t n = 0; n < scenes; n++) {
        const size_t frames = n % 4 == 0 ? 1 : n % 4 == 1 ? 4 : n % 4 == 2 ? 20 : FRAMES_MAX;
        const int most = n % 100 == 0 ? PLACEMENTS_MAX : frames < 20 ? SOME : 8;
        const size_t count = (size_t) below(&draw, most + 1);
        draw_world(&draw, count, frames, &world);
        meeting += check_scene(&world.scene, 0);
        meeting += check_scene(&world.scene, FMB_SCENE_SLOTS_MIN + (size_t) below(&draw, 30));
    }
    assert_true(meeting > 15 * scenes / 2);
    assert_true(near_pairs > 3 * scenes / 4);
}

/* Scenes in which the first placements move, begun again after any number of steps. */
static void scenes_again(void **state)
{
    struct draw draw = {0xa9a1};
    size_t meeting = 0;
    const size_t scenes = 12 + (size_t) draw_sample(50);
    for (size_t n = 0; n < scenes; n++) {
        const size_t frames = n % 4 == 0 ? 20 : n % 4 == 1 ? 4 : 1;
        const size_t few = 1 + (size_t) below(&draw, frames == 20 ? 8 : SOME);
        const bool large = n % 10 == 2;
        do
            draw_world(&draw, large ? PLACEMENTS_MAX : few, large ? 1 + n / 10 % 2 : frames,
                       &world);
        while (large && world.scene.which == FMB_PAIRS_LISTED);
        struct fmb_scene_limits limits;
        fmb_scene_limits_of(&world.scene, &limits);
        if (below(&draw, 2))
            limits.slots = FMB_SCENE_SLOTS_MIN + (size_t) below(&draw, 30);
        void *memory = malloc(fmb_scene_bytes(&limits));
        struct fmb_scene_state *scene;
        struct fmb_scene_answers answers;
        const bool moving = world.scene.duration > 0 && below(&draw, 2);
        size_t moved = 0;
        assert_int_equal(fmb_scene_begin(&world.scene, &limits, memory, &scene), FMB_OK);
        for (int round = 0; round < 5; round++) {
            if (below(&draw, 2))
                meeting += check_steps(&world.scene, scene);
            else
                for (int steps = below(&draw, 5); steps > 0; steps--)
                    if (fmb_scene_step(scene, &answers))
                        break;
            if (below(&draw, 2))
                moved = below(&draw, 3) ? moved + (size_t) below(&draw, 4)
                                        : (size_t) below(&draw, (int) world.count / 2 + 1);
            moved = moved < world.count ? moved : world.count;
            for (size_t i = 0; i < moved; i++)
                draw_pose(&draw, 2 + below(&draw, 12), moving, &world.placement[i]);
            assert_int_equal(fmb_scene_again(scene, moved), FMB_OK);
        }
        meeting += check_steps(&world.scene, scene);
        free(memory);
    }
    assert_true(meeting > 20 * scenes);
}

/* What fmb_scene_again() refuses leaves the scene as it was. */
static void refused_moves(void **state)
{
    struct draw draw = {7};
    do
        draw_world(&draw, SOME, 1, &world);
    while (!world.scene.instant || world.scene.which != FMB_PAIRS_ALL);
    struct fmb_scene_limits limits;
    fmb_scene_limits_of(&world.scene, &limits);
    void *memory = malloc(fmb_scene_bytes(&limits));
    struct fmb_scene_state *scene;
    assert_int_equal(fmb_scene_begin(&world.scene, &limits, memory, &scene), FMB_OK);
    const struct fmb_placement before = world.placement[1];
    assert_int_equal(fmb_scene_again(scene, SOME + 1), FMB_WRONG_COUNT);
    world.placement[1].position[0] = NAN;
    assert_int_equal(fmb_scene_again(scene, 2), FMB_NOT_FINITE);
    world.placement[1] = before;
    check_steps(&world.scene, scene);
    free(memory);
}

/* In a heap, where all boxes meet, there is no memory for all pairs at once; in a row there is. Few
 * placements need none. */
static void heaps_and_rows(void **state)
{
    struct draw draw = {41};
    size_t meeting = 0;
    for (int n = 0; n < rounds(12); n++) {
        const bool heap = n % 2;
        draw_world(&draw, n % 4 < 2 ? SOME : PLACEMENTS_MAX, 1, &world);
        for (size_t i = 0; i < world.count; i++)
            for (int axis = 0; axis < world.dim; axis++) {
                world.placement[i].position[axis] = heap || axis ? 0 : 4 * (double) i;
                world.placement[i].velocity[axis] = 0;
            }
        world.scene.which = FMB_PAIRS_ALL;
        world.scene.split = world.scene.pair_count = 0;
        world.scene.margin = heap ? 100 : 0;
        world.scene.first_pair = (unsigned long long) below(&draw, 2 * PLACEMENTS_MAX);
        meeting += check_scene(&world.scene, 0);
    }
    assert_true(meeting > 1000);
}

/* The answers to two halves are those to the whole. */
static void any_first_pair(void **state)
{
    struct draw draw = {77};
    for (int n = 0; n < rounds(12); n++) {
        draw_world(&draw, 9, n % 2 ? 1 : 20, &world);
        const unsigned long long total = fmb_scene_pair_count(&world.scene);
        for (world.scene.first_pair = 0; world.scene.first_pair <= total; world.scene.first_pair++)
            check_scene(&world.scene, FMB_SCENE_SLOTS_MIN);
    }
}

static void every_method(void **state)
{
    struct draw draw = {4};
    size_t refused = 0;
    for (int n = 0; n < 60; n++) {
        draw_world(&draw, 8, n % 2 ? 1 : 5, &world);
        world.scene.method = fmb_method_at((size_t) n / 2 % 4);
        if (!world.scene.method->boxes)
            world.scene.want &= ~(unsigned) FMB_WANT_BOX;
        if (!world.scene.method->certain)
            world.scene.margin = 0, world.scene.want &= ~(unsigned) (FMB_WANT_GAP | FMB_WANT_POINT);
        if (!world.scene.method->certain && world.scene.which != FMB_PAIRS_LISTED)
            continue;
        check_scene(&world.scene, 0);
        for (size_t i = 0; i < world.scene.pair_count; i++) {
            struct fmb_answer answer;
            refused +=
                fmb_decide(world.scene.method, &world.placement[world.pair[i][0]],
                           &world.placement[world.pair[i][1]], 1, 0, &answer) == FMB_CANNOT_DECIDE;
        }
    }
    assert_true(refused > 10);
}

/* Numbers at the end of the doubles: boxes of bodies without ends, and positions that swallow the
 * body. */
static void extremes(void **state)
{
    static const double scale[] = {1e308, 1e300, 1e150, 1e16, 1e-160, 1e-310};
    struct draw draw = {9};
    size_t meeting = 0;
    for (int n = 0; n < rounds(60); n++) {
        draw_world(&draw, 6, 3, &world);
        for (size_t i = 0; i < world.count; i++) {
            for (size_t k = 0; k < 3 && k < world.body[i].frame_count; k++) {
                const double s = scale[below(&draw, 6)];
                const double number[6] = {0, 0, 0, s, s / 3, s / 7};
                assert_int_equal(fmb_frame_make(world.dim, FMB_BOX, number + (world.dim == 2),
                                                2 * (size_t) world.dim, &world.frame[i][k]),
                                 FMB_OK);
            }
            assert_int_equal(
                fmb_body_make_frames(world.frame[i], world.body[i].frame_count, &world.body[i]),
                FMB_OK);
            for (int axis = 0; axis < world.dim; axis++)
                world.placement[i].position[axis] *= scale[below(&draw, 6)] * 0.01;
        }
        meeting += check_scene(&world.scene, 0);
    }
    assert_true(meeting > 2 * (size_t) rounds(60));
}

static enum fmb_status begin(const struct fmb_scene *scene)
{
    struct fmb_scene_limits limits;
    fmb_scene_limits_of(scene, &limits);
    struct fmb_scene_state *state;
    void *memory = malloc(fmb_scene_bytes(&limits));
    const enum fmb_status status = fmb_scene_begin(scene, &limits, memory, &state);
    free(memory);
    return status;
}

static void draw_good(enum fmb_pairs which)
{
    struct draw draw = {1};
    do
        draw_world(&draw, 5, 3, &world);
    while (world.scene.which != which ||
           (which == FMB_PAIRS_LISTED && world.scene.pair_count < 5) ||
           (which == FMB_PAIRS_ALL && world.scene.ignored_count == 0));
    assert_int_equal(begin(&world.scene), FMB_OK);
}

static void expect_refusal(const struct fmb_scene *scene, enum fmb_status status, const char *place)
{
    char why[100];
    assert_int_equal(begin(scene), status);
    assert_int_equal(fmb_scene_check(scene, why, sizeof why), status);
    assert_memory_equal(why, place, strlen(place));
}

static void bad_scenes(void **state)
{
    struct fmb_scene *scene = &world.scene;
    draw_good(FMB_PAIRS_LISTED);
    world.pair[3][1] = 5;
    expect_refusal(scene, FMB_BAD_PAIR, "pairs[3]: ");
    world.pair[3][1] = world.pair[3][0];
    expect_refusal(scene, FMB_BAD_PAIR, "pairs[3]: ");
    draw_good(FMB_PAIRS_LISTED);
    world.placement[world.pair[2][0]].group = world.placement[world.pair[2][1]].group = -1;
    expect_refusal(scene, FMB_BAD_PAIR, "pairs["); /* this one, or one that is equal */
    world.placement[world.pair[2][0]].group = 1;
    assert_int_equal(begin(scene), FMB_OK);
    draw_good(FMB_PAIRS_LISTED);
    scene->first_pair = scene->pair_count + 1;
    expect_refusal(scene, FMB_BAD_PAIR, "first_pair: ");
    draw_good(FMB_PAIRS_LISTED);
    scene->split = 1;
    expect_refusal(scene, FMB_BAD_PAIR, "split: ");
    draw_good(FMB_PAIRS_LISTED);
    scene->ignored = scene->pairs;
    scene->ignored_count = 1;
    expect_refusal(scene, FMB_WRONG_COUNT, "ignored_count: not with which = FMB_PAIRS_LISTED");
    draw_good(FMB_PAIRS_ALL);
    scene->pairs = scene->ignored;
    scene->pair_count = 1;
    expect_refusal(scene, FMB_WRONG_COUNT, "pair_count: needs which = FMB_PAIRS_LISTED");
    draw_good(FMB_PAIRS_ALL);
    world.ignored[0][0] = 7;
    expect_refusal(scene, FMB_BAD_PAIR, "ignored[0]: ");
    draw_good(FMB_PAIRS_ALL);
    scene->which = (enum fmb_pairs) 3;
    expect_refusal(scene, FMB_BAD_PAIR, "which: ");
    draw_good(FMB_PAIRS_ALL);
    scene->margin = 0, scene->want = 0;
    scene->method = fmb_method_by_name("fmb");
    expect_refusal(scene, FMB_CANNOT_DECIDE, "method: ");
    draw_good(FMB_PAIRS_LISTED);
    scene->want |= FMB_WANT_GAP;
    scene->method = fmb_method_by_name("sat");
    expect_refusal(scene, FMB_CANNOT_DECIDE, "method: ");
    draw_good(FMB_PAIRS_ALL);
    scene->want |= FMB_WANT_CERTIFICATE;
    expect_refusal(scene, FMB_UNKNOWN_WANT, "want: ");
    static const double margins[] = {-0x1p-1074, INFINITY, NAN};
    for (int i = 0; i < 3; i++) {
        draw_good(FMB_PAIRS_ALL);
        scene->margin = margins[i];
        expect_refusal(scene, FMB_BAD_MARGIN, "margin: ");
    }
    draw_good(FMB_PAIRS_ALL);
    scene->duration = -1;
    expect_refusal(scene, FMB_BAD_DURATION, "duration: ");
    draw_good(FMB_PAIRS_ALL);
    world.placement[2].position[1] = NAN;
    expect_refusal(scene, FMB_NOT_FINITE, "placements[2]: ");
    draw_good(FMB_PAIRS_ALL);
    world.placement[2].body = NULL;
    expect_refusal(scene, FMB_NO_FRAMES, "placements[2]: ");
}

/* Two cubes that overlap at time 0 and move apart, or are at rest. */
static struct fmb_scene two_cubes(double velocity)
{
    static const double size[3] = {1, 1, 1};
    static struct fmb_body cube;
    static struct fmb_placement placement[2];
    assert_int_equal(fmb_body_make(3, FMB_BOX, size, 3, &cube), FMB_OK);
    placement[0] = (struct fmb_placement){.body = &cube};
    placement[1] = (struct fmb_placement){
        .body = &cube, .position = {0.5, 0, 0}, .velocity = {0, 0, velocity}};
    return (struct fmb_scene){.placements = placement, .placement_count = 2};
}

static void all_pairs_are_the_default(void **state)
{
    static const unsigned pair[1][2] = {{0, 1}};
    struct fmb_scene scene = two_cubes(0);
    assert_int_equal(check_scene(&scene, 0), 1);
    scene.pairs = pair;
    scene.pair_count = 1;
    assert_int_equal(begin(&scene), FMB_WRONG_COUNT);
    scene = two_cubes(0);
    scene.split = 1;
    assert_int_equal(begin(&scene), FMB_BAD_PAIR);
}

static void bodies_that_move_need_a_window(void **state)
{
    for (int moving = 0; moving < 2; moving++)
        for (int duration = 0; duration < 2; duration++)
            for (int instant = 0; instant < 2; instant++) {
                struct fmb_scene scene = two_cubes(moving);
                const bool given = duration ? !instant : instant || !moving;
                scene.duration = duration;
                scene.instant = instant;
                if (given) {
                    assert_int_equal(begin(&scene), FMB_OK);
                    assert_int_equal(check_scene(&scene, 0), 1);
                } else
                    expect_refusal(&scene, FMB_BAD_DURATION,
                                   instant ? "duration: not 0, but instant is set"
                                           : "duration: it is 0, but body 1 moves");
            }
}

static void limits_hold(void **state)
{
    struct fmb_scene_state *out;
    static char memory[1 << 20];
    draw_good(FMB_PAIRS_ALL);
    for (int n = 0; n < 4; n++) {
        struct fmb_scene_limits limits;
        fmb_scene_limits_of(&world.scene, &limits);
        assert_true(fmb_scene_bytes(&limits) < sizeof memory);
        limits.placements -= n == 0;
        limits.frames -= n == 1;
        limits.ignored -= n == 2;
        limits.slots = n == 3 ? FMB_SCENE_SLOTS_MIN - 1 : limits.slots;
        assert_int_equal(fmb_scene_begin(&world.scene, &limits, memory, &out), FMB_OVER_LIMIT);
    }
    const struct fmb_scene_limits huge = {SIZE_MAX, 1, 1, 64};
    assert_true(fmb_scene_bytes(&huge) == SIZE_MAX);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_scenes),
        cmocka_unit_test(scenes_again),
        cmocka_unit_test(refused_moves),
        cmocka_unit_test(heaps_and_rows),
        cmocka_unit_test(any_first_pair),
        cmocka_unit_test(every_method),
        cmocka_unit_test(extremes),
        cmocka_unit_test(bad_scenes),
        cmocka_unit_test(limits_hold),
        cmocka_unit_test(all_pairs_are_the_default),
        cmocka_unit_test(bodies_that_move_need_a_window),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
