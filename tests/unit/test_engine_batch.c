/* Many pairs at once: what fmb_decide_batch() and fmb_decide_prepared() say is what the
 * method certified says, bit for bit, for each instruction set, in any order, at any address; and
 * that agrees with the exact method, and on samples with the oracle. */

#include "unit.h"

#include <float.h>
#include <limits.h>
#include <math.h>

#include "batch.h"
#include "draw.h"
#include "family.h"
#include "gmp_allocations.h"
#include "instruction_sets.h"
#include "oracle.h"
#include "pair_draw.h"
#include "question.h"
#include "referee.h"

enum { FRAMES = 128, PAIRS_MAX = 1000, GUARD = 0xa5, GUARDS = 64 };

/* ---- What a batch says of a pair ---- */

struct said {
    unsigned char verdict;
    double contact[2], box[2][FMB_DIM_MAX];
};

static void say_nothing(struct said *out)
{
    out->verdict = 0;
    for (int end = 0; end < 2; end++) {
        out->contact[end] = NAN;
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            out->box[end][axis] = NAN;
    }
}

static bool same_number(double one, double other)
{
    return (isnan(one) && isnan(other)) || memcmp(&one, &other, sizeof one) == 0;
}

static bool same_numbers(const double *one, const double *other, int count)
{
    for (int i = 0; i < count; i++)
        if (!same_number(one[i], other[i]))
            return false;
    return true;
}

/* ---- A world: frames, and pairs of them ---- */

struct world {
    struct solid solid[FRAMES];
    struct ready ready[FRAMES]; /* what the frames refer to */
    struct fmb_prepared frame[FRAMES];
    double duration;
    unsigned pair[PAIRS_MAX][2];
    size_t count;
    struct said expected[PAIRS_MAX];
    enum fmb_status status; /* of the first pair refused */
};

static const struct solid *solid_at(const struct world *world, unsigned index)
{
    return &world->solid[index];
}

static struct question question_of(const struct world *world, const unsigned pair[2])
{
    return (struct question){*solid_at(world, pair[0]), *solid_at(world, pair[1]), world->duration};
}

static void prepare(struct world *world, unsigned i)
{
    const struct question question = {world->solid[i], world->solid[i], 1};
    referee_ready(&question, &world->ready[i]);
    assert_int_equal(fmb_prepare(&world->ready[i].pair.a, 0, 1, &world->frame[i]), FMB_OK);
}

/* Windows of a length that the pairs of a campaign have, and others. */
static double draw_duration(struct draw *draw)
{
    static const double others[] = {0, -0.0, 0x1p-1074, 1e-300, 0.1, 3, 1e300, DBL_MAX};
    return draw_coin(draw) ? 1 : others[draw_int(draw, 0, (int) COUNT(others) - 1)];
}

/* Frames 2 i and 2 i + 1 come from one question. cell: all of them are of it; NULL: of any. */
static void draw_frames(struct draw *draw, const struct cell *cell, double duration,
                        struct world *world)
{
    world->duration = duration;
    for (int i = 0; i < FRAMES; i += 2) {
        const struct cell any = cell ? *cell : pair_draw_cell(draw);
        struct question question;
        (draw_int(draw, 0, 7) ? pair_draw : pair_draw_stretched)(draw, &any, &question);
        if (duration > 0x1p-1000)
            pair_set_duration(&question, duration);
        world->solid[i] = question.a;
        world->solid[i + 1] = question.b;
        prepare(world, (unsigned) i);
        prepare(world, (unsigned) i + 1);
    }
}

static unsigned draw_frame(struct draw *draw)
{
    return (unsigned) draw_int(draw, 0, FRAMES - 1);
}

/* Of frames that make a pair: neighbours in either order, any two, one with itself, an
 * earlier pair again or the other way round. */
static void draw_pair(struct draw *draw, struct world *world, size_t i)
{
    unsigned *pair = world->pair[i];
    pair[0] = draw_frame(draw);
    pair[1] = pair[0] ^ 1;
    switch (draw_int(draw, 0, 7)) {
    case 0: do { pair[1] = draw_frame(draw);
        } while (solid_at(world, pair[0])->dim != solid_at(world, pair[1])->dim);
        break;
    case 1: pair[1] = pair[0]; break;
    case 2:
        if (i > 0) {
            const unsigned *earlier = world->pair[draw_int(draw, 0, (int) i - 1)];
            const bool turned = draw_coin(draw);
            pair[0] = earlier[turned];
            pair[1] = earlier[!turned];
        }
        break;
    default: break;
    }
}

static void draw_pairs(struct draw *draw, size_t count, struct world *world)
{
    world->count = count;
    for (size_t i = 0; i < count; i++)
        draw_pair(draw, world, i);
}

/* ---- What is expected ---- */

static void expect_right(const struct question *question, const struct pair *pair,
                         const struct fmb_answer *answer, bool check_oracle)
{
    struct fmb_answer exact;
    char why[200];
    assert_int_equal(pair_decide(fmb_method_by_name("exact"), pair, 0, &exact), FMB_OK);
    if (answer->verdict != exact.verdict)
        referee_fail(question, "the exact method has another verdict");
    if (check_oracle && !oracle_check(pair, FMB_WANT_BOX, answer, why, sizeof why))
        referee_fail(question, why);
}

/* As the method certified decides a valid pair. */
static void set_expected(const struct world *world, const unsigned pair[2], bool check_oracle,
                         struct said *out)
{
    const struct question question = question_of(world, pair);
    struct ready ready;
    struct fmb_answer answer;
    say_nothing(out);
    referee_ready(&question, &ready);
    assert_int_equal(
        pair_decide(fmb_method_by_name("certified"), &ready.pair, FMB_WANT_BOX, &answer), FMB_OK);
    expect_right(&question, &ready.pair, &answer, check_oracle);
    out->verdict = (unsigned char) answer.verdict;
    if (answer.has_contact)
        memcpy(out->contact, answer.contact, sizeof out->contact);
    if (answer.has_box)
        memcpy(out->box, answer.box, sizeof out->box);
}

/* Of all pairs; the oracle decides one in so many. */
static void set_all_expected(struct world *world, int oracle_of)
{
    world->status = FMB_OK;
    for (size_t i = 0; i < world->count; i++)
        set_expected(world, world->pair[i], (int) (i % (size_t) oracle_of) == 0,
                     &world->expected[i]);
}

/* ---- Batches ---- */

/* Memory for one array of answers with guards on both sides. */
struct guarded {
    unsigned char *all;
    size_t size;
};

static void *guarded_new(struct guarded *guarded, size_t size)
{
    guarded->size = size;
    guarded->all = malloc(size + 2 * GUARDS);
    assert_non_null(guarded->all);
    memset(guarded->all, GUARD, size + 2 * GUARDS);
    return guarded->all + GUARDS;
}

static bool is_untouched(const unsigned char *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++)
        if (bytes[i] != GUARD)
            return false;
    return true;
}

static void expect_guards(const struct guarded *guarded)
{
    assert_true(is_untouched(guarded->all, GUARDS));
    assert_true(is_untouched(guarded->all + GUARDS + guarded->size, GUARDS));
}

/* How a batch is called. */
struct way {
    int instructions;
    bool contacts, boxes;
};

struct answers {
    struct guarded verdicts, contacts, boxes;
    struct fmb_batch batch;
    enum fmb_status status;
};

static void answers_free(struct answers *answers)
{
    free(answers->verdicts.all);
    free(answers->contacts.all);
    free(answers->boxes.all);
}

/* frames: those of the world, wherever they lie. */
static void decide(const struct world *world, const struct fmb_prepared *frames,
                   const struct way *way, struct answers *out)
{
    const size_t n = world->count;
    out->batch =
        (struct fmb_batch){.frames = frames,
                           .frame_count = FRAMES,
                           .pairs = world->pair,
                           .pair_count = n,
                           .duration = world->duration,
                           .instant = world->duration == 0,
                           .verdicts = guarded_new(&out->verdicts, n),
                           .contacts = guarded_new(&out->contacts, n * sizeof *out->batch.contacts),
                           .boxes = guarded_new(&out->boxes, n * sizeof *out->batch.boxes)};
    if (!way->contacts)
        out->batch.contacts = NULL;
    if (!way->boxes)
        out->batch.boxes = NULL;
    out->status = batch_decide(&out->batch, (enum instructions) way->instructions, INFINITY);
    expect_guards(&out->verdicts);
    expect_guards(&out->contacts);
    expect_guards(&out->boxes);
    if (!way->contacts)
        assert_true(is_untouched(out->contacts.all, out->contacts.size));
    if (!way->boxes)
        assert_true(is_untouched(out->boxes.all, out->boxes.size));
}

/* ---- Allocations of GMP ---- */

static int count_allocations(void **state)
{
    gmp_count_allocations();
    return 0;
}

static const char *way_text(const struct way *way)
{
    static char text[80];
    snprintf(text, sizeof text, "%s%s%s", instructions_name(way->instructions),
             way->contacts ? ", contacts" : "", way->boxes ? ", boxes" : "");
    return text;
}

static void fail_at(const struct world *world, const struct way *way, size_t i, const char *what)
{
    const struct question question = question_of(world, world->pair[i]);
    printf("# pair %zu of %zu, %u with %u; %s\n", i, world->count, world->pair[i][0],
           world->pair[i][1], way_text(way));
    referee_fail(&question, what);
}

static void expect_said(const struct world *world, const struct way *way,
                        const struct answers *answers)
{
    const struct fmb_batch *batch = &answers->batch;
    assert_int_equal(answers->status, world->status);
    for (size_t i = 0; i < world->count; i++) {
        const struct said *expected = &world->expected[i];
        if (batch->verdicts[i] != expected->verdict)
            fail_at(world, way, i, "another verdict in a batch");
        if (way->contacts && !same_numbers(batch->contacts[i], expected->contact, 2))
            fail_at(world, way, i, "other times in a batch");
        if (way->boxes && !same_numbers(batch->boxes[i][0], expected->box[0], 2 * FMB_DIM_MAX))
            fail_at(world, way, i, "another box in a batch");
    }
}

static void expect_decided(const struct world *world, const struct fmb_prepared *frames,
                           const struct way *way)
{
    struct answers answers;
    decide(world, frames, way, &answers);
    expect_said(world, way, &answers);
    answers_free(&answers);
}

/* Decides the pairs of a batch that it lists as open, each by a batch of its own. Returns how many
 * there are. */
static size_t decide_open(const struct world *world, const struct fmb_batch *whole)
{
    const size_t count = *whole->open_count;
    for (size_t n = 0; n < count; n++) {
        const size_t i = whole->open[n];
        assert_true(i < world->count && (n == 0 || i > whole->open[n - 1]));
        assert_int_equal(whole->verdicts[i], 0);
        assert_true(!whole->contacts ||
                    (isnan(whole->contacts[i][0]) && isnan(whole->contacts[i][1])));
        for (int end = 0; end < 2 && whole->boxes; end++)
            for (int axis = 0; axis < FMB_DIM_MAX; axis++)
                assert_true(isnan(whole->boxes[i][end][axis]));
        struct fmb_batch one = *whole;
        one.pairs = &whole->pairs[i];
        one.pair_count = 1;
        one.verdicts = &whole->verdicts[i];
        one.contacts = whole->contacts ? &whole->contacts[i] : NULL;
        one.boxes = whole->boxes ? &whole->boxes[i] : NULL;
        one.open = one.open_count = NULL;
        assert_int_equal(fmb_decide_batch(&one), FMB_OK);
    }
    return count;
}

/* A batch that lists what it leaves open: without GMP, and the same with what is then decided. */
static size_t expect_two_steps(const struct world *world, const struct way *way)
{
    struct answers answers;
    struct guarded open;
    size_t count = world->count + 1;
    decide(world, world->frame, way, &answers);
    answers.batch.open = guarded_new(&open, world->count * sizeof *answers.batch.open);
    answers.batch.open_count = &count;
    memset(answers.verdicts.all + GUARDS, GUARD, answers.verdicts.size);
    memset(answers.contacts.all + GUARDS, GUARD, answers.contacts.size);
    memset(answers.boxes.all + GUARDS, GUARD, answers.boxes.size);
    const long before = gmp_allocations;
    answers.status = fmb_decide_batch(&answers.batch);
    assert_int_equal(gmp_allocations, before);
    expect_guards(&open);
    assert_int_equal(decide_open(world, &answers.batch), count);
    expect_guards(&answers.verdicts);
    expect_said(world, way, &answers);
    answers_free(&answers);
    free(open.all);
    return count;
}

/* With all instructions of this machine, contacts and boxes wanted or not. */
static void expect_all_ways(const struct world *world)
{
    for (int instructions = INSTRUCTIONS_BEST; instructions <= INSTRUCTIONS_AVX512; instructions++)
        for (int wants = 0; instructions_supported(instructions) && wants < 4; wants++) {
            const struct way way = {instructions, wants & 1, wants & 2};
            expect_decided(world, world->frame, &way);
            expect_two_steps(world, &way);
        }
}

static void expect_meet(const struct world *world)
{
    for (size_t i = 0; i < world->count; i++) {
        const struct fmb_prepared *a = &world->frame[world->pair[i][0]];
        const struct fmb_prepared *b = &world->frame[world->pair[i][1]];
        const enum fmb_verdict expected = (enum fmb_verdict) world->expected[i].verdict;
        const struct way way = {0};
        enum fmb_verdict there, back;
        assert_int_equal(fmb_decide_prepared(a, b, world->duration, &there), FMB_OK);
        assert_int_equal(fmb_decide_prepared(b, a, world->duration, &back), FMB_OK);
        if (there != expected || back != expected)
            fail_at(world, &way, i, "fmb_decide_prepared() has another verdict");
    }
}

/* ---- Tests: answers ---- */

static struct world *world_new(void)
{
    struct world *world = calloc(1, sizeof *world);
    assert_non_null(world);
    return world;
}

struct tally {
    long verdict[4], contacts, boxes;
};

static void count_said(const struct world *world, struct tally *tally)
{
    for (size_t i = 0; i < world->count; i++) {
        const struct said *said = &world->expected[i];
        tally->verdict[said->verdict]++;
        tally->contacts += !isnan(said->contact[0]);
        tally->boxes += !isnan(said->box[0][0]);
    }
}

static void expect_all_seen(const struct tally *tally)
{
    printf("# %ld separated, %ld touching, %ld overlapping; %ld contacts, %ld boxes\n",
           tally->verdict[1], tally->verdict[2], tally->verdict[3], tally->contacts, tally->boxes);
    for (int verdict = 1; verdict < 4; verdict++)
        assert_true(tally->verdict[verdict] > 0);
    assert_true(tally->contacts > 0 && tally->boxes == tally->verdict[2] + tally->verdict[3]);
}

/* All kinds side by side. */
static void mixed_batches_are_certified(void **state)
{
    struct draw draw;
    struct tally tally = {0};
    struct world *world = world_new();
    draw_begin(&draw, "mixed_batches_are_certified");
    for (long n = draw_sample(16); n > 0; n--) {
        draw_frames(&draw, NULL, draw_duration(&draw), world);
        draw_pairs(&draw, (size_t) draw_int(&draw, 1, 400), world);
        set_all_expected(world, 20);
        expect_all_ways(world);
        expect_meet(world);
        count_said(world, &tally);
    }
    free(world);
    expect_all_seen(&tally);
}

/* Batches of one kind take shorter ways. */
static void batches_of_one_kind_are_certified(void **state)
{
    struct draw draw;
    struct tally tally = {0};
    struct cell cells[CELL_WITH_FACES];
    struct world *world = world_new();
    const int count = cell_list(true, cells);
    draw_begin(&draw, "batches_of_one_kind_are_certified");
    for (long n = draw_sample(2 * count); n > 0; n--) {
        const double duration = draw_int(&draw, 0, 3) ? 1 : draw_duration(&draw);
        draw_frames(&draw, &cells[n % count], duration, world);
        draw_pairs(&draw, (size_t) draw_int(&draw, 1, 200), world);
        set_all_expected(world, 40);
        expect_all_ways(world);
        count_said(world, &tally);
    }
    free(world);
    expect_all_seen(&tally);
}

static void set_random_frames(struct draw *draw, const struct cell *cell, struct world *world)
{
    world->duration = 1;
    for (int i = 0; i < FRAMES; i += 2) {
        struct question question;
        family_draw_random(draw, cell, &question);
        world->solid[i] = question.a;
        world->solid[i + 1] = question.b;
        prepare(world, (unsigned) i);
        prepare(world, (unsigned) i + 1);
        memcpy(world->pair[i / 2], ((unsigned[2]){(unsigned) i, (unsigned) i + 1}),
               sizeof world->pair[0]);
    }
    world->count = FRAMES / 2;
}

/* Doubles decide random pairs: no verdict is left open, and few contacts and boxes are. */
static void random_pairs_are_not_left_open(void **state)
{
    struct draw draw;
    struct cell cells[CELL_WITH_FACES];
    struct world *world = world_new();
    const int count = cell_list(true, cells);
    long pairs = 0;
    size_t contacts = 0, boxes = 0;
    draw_begin(&draw, "random_pairs_are_not_left_open");
    for (long n = draw_sample(2 * count); n > 0; n--) {
        set_random_frames(&draw, &cells[n % count], world);
        set_all_expected(world, 1000);
        assert_int_equal(expect_two_steps(world, &(struct way){0}), 0);
        contacts += expect_two_steps(world, &(struct way){.contacts = true});
        boxes += expect_two_steps(world, &(struct way){.contacts = true, .boxes = true});
        pairs += FRAMES / 2;
    }
    free(world);
    printf("# of %ld pairs, %zu contacts and %zu boxes left open\n", pairs, contacts, boxes);
    assert_true((long) (contacts + boxes) * 100 < pairs);
}

/* Rectangles with edges x and (-x[1], x[0]), side by side: each touches the next. */
static void set_row_of_rectangles(double along, double across, struct world *world)
{
    world->duration = 1;
    for (unsigned i = 0; i < FRAMES; i++) {
        world->solid[i] = (struct solid){.dim = 2,
                                         .shape = FMB_CUBOID,
                                         .moving = true,
                                         .origin = {along * i, across * i},
                                         .velocity = {-across * (i % 2), along * (i % 2)},
                                         .component = {{along, across}, {-across, along}}};
        prepare(world, i);
    }
    for (world->count = 0; world->count < 3 * 128 - 1; world->count++) {
        world->pair[world->count][0] = 0;
        world->pair[world->count][1] = 1;
    }
    set_all_expected(world, 1000);
}

/* Pairs that take the filter two passes are not left open; of those that need integers, and of
 * contacts that the filter does not give, 32 in each 128 are decided if that needs no GMP. */
static void touching_pairs_are_left_open(void **state)
{
    struct world *world = world_new();
    const struct way verdicts = {0}, contacts = {.contacts = true};
    const struct way boxes = {.contacts = true, .boxes = true};
    const size_t decided = 3 * 32;
    set_row_of_rectangles(3, 0, world);
    assert_int_equal(expect_two_steps(world, &verdicts), 0);
    assert_int_equal(expect_two_steps(world, &contacts), world->count - decided);
    assert_int_equal(expect_two_steps(world, &boxes), world->count - decided);
    set_row_of_rectangles(0.3, 0.1, world);
    assert_int_equal(expect_two_steps(world, &verdicts), world->count - decided);
    assert_int_equal(expect_two_steps(world, &contacts), world->count); /* exact times */
    free(world);
}

/* ---- Tests: the same bytes ---- */

static bool is_separated(struct world *world, unsigned i)
{
    enum fmb_verdict verdict;
    prepare(world, i + 1);
    assert_int_equal(fmb_decide_prepared(&world->frame[i], &world->frame[i + 1], 1, &verdict),
                     FMB_OK);
    return verdict == FMB_SEPARATED;
}

/* Moves the frame after i away from it until they are apart by some rounding errors. False if that
 * does not separate them. */
static bool set_near_bound(struct draw *draw, unsigned i, struct world *world)
{
    const struct solid a = world->solid[i], b = world->solid[i + 1];
    double near = 0, far = 64;
    for (int step = -1; step < 64; step++) {
        const double middle = step < 0 ? far : near + (far - near) / 2;
        for (int axis = 0; axis < a.dim; axis++)
            world->solid[i + 1].origin[axis] =
                a.origin[axis] + middle * (b.origin[axis] - a.origin[axis]);
        const bool separated = is_separated(world, i);
        if (step < 0 && !separated)
            return false;
        *(separated ? &far : &near) = middle;
    }
    far *= 1 + draw_int(draw, 0, 400) * 0x1p-53;
    for (int axis = 0; axis < a.dim; axis++)
        world->solid[i + 1].origin[axis] = a.origin[axis] + far * (b.origin[axis] - a.origin[axis]);
    prepare(world, i + 1);
    return true;
}

static void set_frames_near_bound(struct draw *draw, const struct cell *cell, struct world *world)
{
    world->duration = 1;
    for (unsigned i = 0; i < FRAMES; i += 2)
        do {
            struct question question;
            family_draw_random(draw, cell, &question);
            world->solid[i] = question.a;
            world->solid[i + 1] = question.b;
            prepare(world, i);
        } while (!set_near_bound(draw, i, world));
    world->count = PAIRS_MAX;
    for (size_t k = 0; k < world->count; k++) {
        world->pair[k][0] = 2 * (unsigned) draw_int(draw, 0, FRAMES / 2 - 1);
        world->pair[k][1] = world->pair[k][0] + 1;
    }
}

static size_t decide_verdicts(const struct world *world, const struct way *way,
                              unsigned char verdicts[PAIRS_MAX])
{
    size_t open[PAIRS_MAX], count;
    struct answers answers;
    decide(world, world->frame, way, &answers);
    answers.batch.open = open;
    answers.batch.open_count = &count;
    assert_int_equal(fmb_decide_batch(&answers.batch), FMB_OK);
    memcpy(verdicts, answers.batch.verdicts, PAIRS_MAX);
    answers_free(&answers);
    return count;
}

/* Kernels of instruction sets that fuse operations are unsure of other pairs than those that do
 * not, and every pair that is decided by itself leaves another one open. */
static void what_is_left_open_does_not_depend_on_instructions(void **state)
{
    struct draw draw;
    struct cell cells[CELL_WITH_FACES];
    struct world *world = world_new();
    const int count = cell_list(true, cells);
    size_t open = 0;
    draw_begin(&draw, "what_is_left_open_does_not_depend_on_instructions");
    for (long n = draw_sample(4 * count); n > 0; n--) {
        unsigned char plain[PAIRS_MAX], other[PAIRS_MAX];
        set_frames_near_bound(&draw, &cells[n % count], world);
        for (int contacts = 0; contacts < 2; contacts++) {
            open +=
                decide_verdicts(world, &(struct way){INSTRUCTIONS_PLAIN, contacts, false}, plain);
            for (int set = INSTRUCTIONS_BEST; set <= INSTRUCTIONS_AVX512; set++) {
                const struct way way = {set, contacts, false};
                if (!instructions_supported(set))
                    continue;
                decide_verdicts(world, &way, other);
                for (size_t i = 0; i < world->count; i++)
                    if (other[i] != plain[i])
                        fail_at(world, &way, i, "another verdict");
            }
        }
    }
    free(world);
    printf("# %zu left open\n", open);
    assert_true(open > 0);
}

/* Where blocks begin and end. */
static void any_count_is_answered(void **state)
{
    static const size_t counts[] = {0, 1, 127, 128, 129, 1000};
    struct draw draw;
    struct world *world = world_new();
    draw_begin(&draw, "any_count_is_answered");
    for (size_t i = 0; i < COUNT(counts); i++) {
        draw_frames(&draw, NULL, 1, world);
        draw_pairs(&draw, counts[i], world);
        set_all_expected(world, 1000);
        expect_all_ways(world);
    }
    free(world);
}

/* Arrays may be missing where there is nothing. */
static void nothing_is_answered(void **state)
{
    const struct fmb_batch batch = {.duration = 1};
    assert_int_equal(fmb_decide_batch(&batch), FMB_OK);
    size_t count = 1, open[1];
    const struct fmb_batch listing = {.duration = 1, .open = open, .open_count = &count};
    assert_int_equal(fmb_decide_batch(&listing), FMB_OK);
    assert_int_equal(count, 0);
}

/* ---- Tests: order and address ---- */

static void exchange_frames(struct world *world, unsigned i, unsigned j)
{
    const struct solid solid = world->solid[i];
    const struct fmb_prepared frame = world->frame[i];
    world->solid[i] = world->solid[j];
    world->frame[i] = world->frame[j];
    world->solid[j] = solid;
    world->frame[j] = frame;
    for (size_t k = 0; k < world->count; k++)
        for (int f = 0; f < 2; f++) {
            unsigned *index = &world->pair[k][f];
            *index = *index == i ? j : *index == j ? i : *index;
        }
}

static void exchange_pairs(struct world *world, size_t i, size_t j)
{
    const struct said said = world->expected[i];
    const unsigned pair[2] = {world->pair[i][0], world->pair[i][1]};
    world->expected[i] = world->expected[j];
    memcpy(world->pair[i], world->pair[j], sizeof pair);
    world->expected[j] = said;
    memcpy(world->pair[j], pair, sizeof pair);
}

static void turn_pair(unsigned pair[2])
{
    const unsigned first = pair[0];
    pair[0] = pair[1];
    pair[1] = first;
}

/* What is expected stays as it was. */
static void shuffle(struct draw *draw, struct world *world)
{
    for (int n = 0; n < FRAMES; n++)
        exchange_frames(world, draw_frame(draw), draw_frame(draw));
    for (size_t i = 0; i < world->count; i++) {
        exchange_pairs(world, i, (size_t) draw_int(draw, 0, (int) world->count - 1));
        if (draw_coin(draw))
            turn_pair(world->pair[i]);
    }
}

static void order_does_not_matter(void **state)
{
    struct draw draw;
    struct world *world = world_new();
    draw_begin(&draw, "order_does_not_matter");
    for (long n = draw_sample(8); n > 0; n--) {
        draw_frames(&draw, NULL, draw_duration(&draw), world);
        draw_pairs(&draw, (size_t) draw_int(&draw, 1, 300), world);
        set_all_expected(world, 1000);
        shuffle(&draw, world);
        expect_all_ways(world);
        expect_meet(world);
    }
    free(world);
}

/* Any address that doubles may have. */
static void address_does_not_matter(void **state)
{
    struct draw draw;
    struct world *world = world_new();
    unsigned char *memory = aligned_alloc(64, sizeof world->frame + 64);
    assert_non_null(memory);
    draw_begin(&draw, "address_does_not_matter");
    draw_frames(&draw, NULL, 1, world);
    draw_pairs(&draw, 300, world);
    set_all_expected(world, 1000);
    for (size_t at = 0; at < 64; at += 8) {
        struct fmb_prepared *frames = (struct fmb_prepared *) (void *) (memory + at);
        memcpy(frames, world->frame, sizeof world->frame);
        for (int instructions = INSTRUCTIONS_BEST; instructions <= INSTRUCTIONS_AVX512;
             instructions++) {
            const struct way way = {instructions, at & 8, false};
            if (instructions_supported(instructions))
                expect_decided(world, frames, &way);
        }
        assert_memory_equal(frames, world->frame, sizeof world->frame); /* nothing is written */
    }
    free(memory);
    free(world);
}

/* ---- Tests: what is refused ---- */

/* The refused frames are the first ones. */
enum { ALL_ZERO, NOT_PREPARED, BAD_FRAMES };

static void spoil_frames(struct world *world)
{
    const struct question question = {world->solid[NOT_PREPARED], world->solid[NOT_PREPARED], 1};
    static const struct fmb_prepared zero;
    struct ready ready;
    memset(&world->frame[ALL_ZERO], 0, sizeof world->frame[ALL_ZERO]);
    memset(&world->frame[NOT_PREPARED], GUARD, sizeof world->frame[NOT_PREPARED]);
    referee_ready(&question, &ready);
    ready.pair.a.position[1] = NAN;
    assert_int_equal(fmb_prepare(&ready.pair.a, 0, 1, &world->frame[NOT_PREPARED]), FMB_NOT_FINITE);
    assert_memory_equal(&world->frame[NOT_PREPARED], &zero, sizeof zero);
}

/* On output: a pair that is refused, and why. */
static enum fmb_status draw_refused(struct draw *draw, const struct world *world, unsigned pair[2])
{
    static const unsigned beyond[] = {FRAMES, FRAMES + 1, INT_MAX, UINT_MAX};
    enum fmb_status status = FMB_DIMENSIONS_DIFFER;
    pair[0] = BAD_FRAMES + draw_frame(draw) % (FRAMES - BAD_FRAMES);
    switch (draw_int(draw, 0, 2)) {
    case 0:
        pair[1] = beyond[draw_int(draw, 0, (int) COUNT(beyond) - 1)];
        pair[0] = draw_int(draw, 0, 3) ? pair[0] : ALL_ZERO;
        status = FMB_OVER_LIMIT;
        break;
    case 1:
        pair[1] = (unsigned) draw_int(draw, ALL_ZERO, NOT_PREPARED);
        pair[0] = draw_int(draw, 0, 3) ? pair[0] : ALL_ZERO;
        status = FMB_NOT_FINITE;
        break;
    default: do { pair[1] = BAD_FRAMES + draw_frame(draw) % (FRAMES - BAD_FRAMES);
        } while (world->solid[pair[0]].dim == world->solid[pair[1]].dim);
        break;
    }
    if (draw_coin(draw))
        turn_pair(pair);
    return status;
}

static bool has_bad_frame(const unsigned pair[2])
{
    return pair[0] < BAD_FRAMES || pair[1] < BAD_FRAMES;
}

/* One pair in so many is refused, from one of them on. */
static void refuse_some(struct draw *draw, int one_in, struct world *world)
{
    const size_t from = (size_t) draw_int(draw, 0, (int) world->count - 1);
    world->status = FMB_OK;
    spoil_frames(world);
    for (size_t i = 0; i < world->count; i++) {
        const bool refused = i >= from && draw_int(draw, 1, one_in) == 1;
        if (refused) {
            const enum fmb_status status = draw_refused(draw, world, world->pair[i]);
            world->status = world->status == FMB_OK ? status : world->status;
            say_nothing(&world->expected[i]);
            continue;
        }
        while (has_bad_frame(world->pair[i]))
            world->pair[i][0] = world->pair[i][1] = draw_frame(draw);
        set_expected(world, world->pair[i], false, &world->expected[i]);
    }
}

/* fmb_decide_prepared() of the same pairs, which leaves the verdict as it was where it refuses. */
static void expect_meet_refuses(const struct world *world)
{
    for (size_t i = 0; i < world->count; i++) {
        const unsigned *pair = world->pair[i];
        if (pair[0] >= FRAMES || pair[1] >= FRAMES)
            continue;
        const struct fmb_prepared *a = &world->frame[pair[0]], *b = &world->frame[pair[1]];
        enum fmb_verdict verdict = (enum fmb_verdict) 0;
        const enum fmb_status status = fmb_decide_prepared(a, b, world->duration, &verdict);
        assert_int_equal(verdict, world->expected[i].verdict);
        assert_int_equal(status, verdict != (enum fmb_verdict) 0 ? FMB_OK
                                 : has_bad_frame(pair)           ? FMB_NOT_FINITE
                                                                 : FMB_DIMENSIONS_DIFFER);
    }
}

static void refused_pairs_stop_no_other(void **state)
{
    struct draw draw;
    struct world *world = world_new();
    long seen[FMB_STATUS_COUNT] = {0};
    draw_begin(&draw, "refused_pairs_stop_no_other");
    for (long n = draw_sample(32); n > 0; n--) {
        draw_frames(&draw, NULL, draw_duration(&draw), world);
        draw_pairs(&draw, (size_t) draw_int(&draw, 1, 300), world);
        refuse_some(&draw, 1 << draw_int(&draw, 0, 8), world);
        seen[world->status]++;
        expect_all_ways(world);
        expect_meet_refuses(world);
    }
    free(world);
    printf("# first refused: %ld not finite, %ld over the limit, %ld of other dimensions; %ld ok\n",
           seen[FMB_NOT_FINITE], seen[FMB_OVER_LIMIT], seen[FMB_DIMENSIONS_DIFFER], seen[FMB_OK]);
    assert_true(seen[FMB_NOT_FINITE] + seen[FMB_OVER_LIMIT] + seen[FMB_DIMENSIONS_DIFFER] > 0);
}

/* ---- Tests: what is refused as a whole ---- */

static void expect_whole_refused(const struct world *world, const struct way *way,
                                 enum fmb_status status)
{
    struct answers answers;
    decide(world, world->frame, way, &answers);
    assert_int_equal(answers.status, status);
    assert_true(is_untouched(answers.verdicts.all, answers.verdicts.size + GUARDS));
    assert_true(is_untouched(answers.contacts.all, answers.contacts.size + GUARDS));
    assert_true(is_untouched(answers.boxes.all, answers.boxes.size + GUARDS));
    answers_free(&answers);
}

static void frames_that_move_need_a_window(void **state)
{
    static const double size[3] = {1, 1, 1};
    static const unsigned pair[1][2] = {{0, 1}};
    struct fmb_body cube;
    assert_int_equal(fmb_body_make(3, FMB_BOX, size, 3, &cube), FMB_OK);
    for (int moving = 0; moving < 2; moving++)
        for (int duration = 0; duration < 2; duration++)
            for (int instant = 0; instant < 2; instant++) {
                const struct fmb_placement placement[2] = {
                    {.body = &cube}, {.body = &cube, .velocity = {0, 0, moving}}};
                const bool given = duration ? !instant : instant || !moving;
                struct fmb_prepared frame[2];
                unsigned char verdict = 77;
                for (int f = 0; f < 2; f++)
                    assert_int_equal(fmb_prepare(&placement[f], 0, 1, &frame[f]), FMB_OK);
                const struct fmb_batch batch = {.frames = frame,
                                                .frame_count = 2,
                                                .pairs = pair,
                                                .pair_count = 1,
                                                .duration = duration,
                                                .instant = instant,
                                                .verdicts = &verdict};
                assert_int_equal(fmb_decide_batch(&batch), given ? FMB_OK : FMB_BAD_DURATION);
                assert_int_equal(verdict, given ? FMB_OVERLAPPING : 77);
            }
}

static void durations_that_are_none_are_refused(void **state)
{
    static const double bad[] = {NAN, -NAN, INFINITY, -INFINITY, -1, -0x1p-1074, -DBL_MAX};
    const struct way way = {0, true, true};
    enum fmb_verdict verdict;
    struct draw draw;
    struct world *world = world_new();
    draw_begin(&draw, "durations_that_are_none_are_refused");
    draw_frames(&draw, NULL, 1, world);
    draw_pairs(&draw, 10, world);
    for (size_t i = 0; i < COUNT(bad); i++) {
        world->duration = bad[i];
        expect_whole_refused(world, &way, FMB_BAD_DURATION);
        for (size_t k = 0; k < world->count; k++)
            assert_int_equal(
                fmb_decide_prepared(&world->frame[world->pair[k][0]],
                                    &world->frame[world->pair[k][1]], bad[i], &verdict),
                FMB_BAD_DURATION);
    }
    free(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mixed_batches_are_certified),
        cmocka_unit_test(batches_of_one_kind_are_certified),
        cmocka_unit_test(random_pairs_are_not_left_open),
        cmocka_unit_test(touching_pairs_are_left_open),
        cmocka_unit_test(what_is_left_open_does_not_depend_on_instructions),
        cmocka_unit_test(any_count_is_answered),
        cmocka_unit_test(nothing_is_answered),
        cmocka_unit_test(order_does_not_matter),
        cmocka_unit_test(address_does_not_matter),
        cmocka_unit_test(refused_pairs_stop_no_other),
        cmocka_unit_test(durations_that_are_none_are_refused),
        cmocka_unit_test(frames_that_move_need_a_window),
    };
    return cmocka_run_group_tests(tests, count_allocations, NULL);
}
