/* Each part of an answer, contact, box, gap or certificate, has the same bits whatever else is
 * wanted, in single pairs, batches, scenes and the service. */

#include "unit.h"

#include <math.h>

#include "answer_now.h"
#include "client_scene.h"
#include "fmb_batch.h"
#include "hull_draw.h"
#include "round.h"
#include "scene_truth.h"
#include "trial.h"
#include "wire.h"

enum { ALL = FMB_WANT_BOX | FMB_WANT_TIMES | FMB_WANT_GAP | FMB_WANT_POINT };

static struct answerer *answerer;
static struct answer_job *job;

static int set_up(void **state)
{
    const struct answerer_options options = {1000, .server_id = 99, .secret = {1, 2}};
    answerer = answerer_create(&options);
    job = answer_job_create();
    return answerer && job ? 0 : -1;
}

static int tear_down(void **state)
{
    answer_job_destroy(job);
    answerer_destroy(answerer);
    return 0;
}

/* A pair, its answer with everything wanted, and its question if it has one. */
struct subject {
    const struct pair *pair;
    const struct question *question;
    struct fmb_answer whole;
};

/* The parts given are those of the whole answer, and there are no others. */
static void expect(const struct subject *subject, unsigned given, const struct fmb_answer *answer,
                   const char *way)
{
    struct fmb_answer expected = subject->whole;
    expected.has_contact = expected.has_contact && given & FMB_WANT_TIMES;
    expected.has_box = expected.has_box && given & FMB_WANT_BOX;
    expected.has_gap = expected.has_gap && given & FMB_WANT_GAP;
    expected.has_point = expected.has_point && given & FMB_WANT_POINT;
    if (query_same_answer(&expected, answer))
        return;
    if (subject->question)
        question_print(subject->question);
    fail_msg("%s, parts %u: other bits in parts %u", way, given,
             query_parts_that_differ(&expected, answer));
}

/* ---- In process ---- */

static void expect_single(struct subject *subject)
{
    for (int m = trial_methods() - 1; m >= 0; m--) { /* certified last: its answer is kept */
        const struct fmb_method *method = fmb_method_at((size_t) m);
        const unsigned all = method->certain ? ALL : FMB_WANT_BOX | FMB_WANT_TIMES;
        struct fmb_answer answer;
        if (pair_decide(method, subject->pair, all, &subject->whole) != FMB_OK)
            continue;
        for (unsigned want = 0; want <= all; want++)
            if ((want & ~all) == 0) {
                assert_int_equal(pair_decide(method, subject->pair, want, &answer), FMB_OK);
                expect(subject, want | FMB_WANT_TIMES, &answer, method->name);
            }
    }
}

static void expect_batch(const struct subject *subject, unsigned want, bool listing)
{
    static const unsigned pair[1][2] = {{0, 1}};
    struct fmb_prepared frames[2];
    struct fmb_gap gap;
    double contact[1][2] = {{NAN}}, box[1][2][FMB_DIM_MAX] = {{{NAN}}};
    double point[1][1 + FMB_DIM_MAX] = {{NAN}};
    unsigned char verdict;
    size_t open[1], count = 0;
    assert_int_equal(fmb_prepare(&subject->pair->a, 0, 1, &frames[0]), FMB_OK);
    assert_int_equal(fmb_prepare(&subject->pair->b, 0, 1, &frames[1]), FMB_OK);
    struct fmb_batch batch = {.frames = frames,
                              .frame_count = 2,
                              .pairs = pair,
                              .pair_count = 1,
                              .duration = subject->pair->duration,
                              .instant = subject->pair->duration == 0,
                              .verdicts = &verdict,
                              .contacts = want & FMB_WANT_TIMES ? contact : NULL,
                              .boxes = want & FMB_WANT_BOX ? box : NULL,
                              .points = want & FMB_WANT_POINT ? point : NULL,
                              .gaps = want & FMB_WANT_GAP ? &gap : NULL,
                              .open = listing ? open : NULL,
                              .open_count = listing ? &count : NULL};
    enum fmb_verdict prepared;
    assert_int_equal(
        fmb_decide_prepared(&frames[0], &frames[1], subject->pair->duration, &prepared), FMB_OK);
    assert_int_equal(prepared, subject->whole.verdict);
    assert_int_equal(fmb_decide_batch(&batch), FMB_OK);
    if (count > 0) /* left open: decided without a limit */
        return;
    struct fmb_answer answer = {.verdict = (enum fmb_verdict) verdict,
                                .has_contact = !isnan(contact[0][0]),
                                .has_box = !isnan(box[0][0][0]),
                                .has_point = !isnan(point[0][0]),
                                .has_gap = want & FMB_WANT_GAP};
    memcpy(answer.contact, contact, sizeof answer.contact);
    memcpy(answer.box, box, sizeof answer.box);
    memcpy(answer.point, point, sizeof answer.point);
    if (answer.has_gap)
        answer.gap = gap;
    expect(subject, want, &answer, "batch");
}

/* margin: at least the gap. */
static void expect_scene(const struct subject *subject, unsigned want, double margin)
{
    static const unsigned pair[1][2] = {{0, 1}};
    const struct fmb_placement placements[2] = {subject->pair->a, subject->pair->b};
    const struct fmb_scene scene = {.placements = placements,
                                    .placement_count = 2,
                                    .duration = subject->pair->duration,
                                    .instant = subject->pair->duration == 0,
                                    .want = want,
                                    .margin = margin,
                                    .which = FMB_PAIRS_LISTED,
                                    .pairs = pair,
                                    .pair_count = 1};
    struct fmb_scene_limits limits;
    fmb_scene_limits_of(&scene, &limits);
    void *memory = malloc(fmb_scene_bytes(&limits));
    struct fmb_scene_state *state;
    struct fmb_scene_answers answers;
    size_t count = 0;
    assert_non_null(memory);
    assert_int_equal(fmb_scene_begin(&scene, &limits, memory, &state), FMB_OK);
    for (bool done = false; !done; count += answers.count) {
        struct fmb_answer answer;
        done = fmb_scene_step(state, &answers);
        if (answers.count == 0)
            continue;
        fmb_scene_answer(&answers, 0, &answer);
        expect(subject, want | (margin > 0 ? FMB_WANT_GAP : 0), &answer, "scene");
    }
    assert_int_equal(count, 1);
    free(memory);
}

/* ---- The service ---- */

static unsigned char geometry[2][QUERY_BYTES_MAX];

static void expect_pair_query(const struct subject *subject, const struct query_placement *of,
                              unsigned want, const char *certificate)
{
    const struct pair_query query = {
        .duration = subject->pair->duration, .want = (int32_t) want, .placement = {of[0], of[1]}};
    struct pair_result result;
    answer_pair(answerer, &query, &result);
    assert_int_equal(result.status, FMB_OK);
    expect(subject, (want & ALL) | FMB_WANT_TIMES, &result.answer, "pair query");
    assert_string_equal(result.certificate ? result.certificate : "",
                        want & FMB_WANT_CERTIFICATE ? certificate : "");
}

static void expect_scene_query(const struct subject *subject, const struct query_placement *of,
                               unsigned want)
{
    static struct scene_query query;
    static struct scene_result result;
    struct fmb_answer answer;
    int32_t contact = 0;
    query.duration = subject->pair->duration;
    query.want = (int32_t) want;
    query.which = FMB_PAIRS_LISTED;
    query.index_count = 2;
    query.pair[0][1] = 1;
    query.placement_count = 2;
    memcpy(query.placement, of, 2 * sizeof *of);
    scene_answer(job, answerer, &query, &result);
    assert_int_equal(result.verdict_count, 1);
    wire_scene_answer(&result, 0, &contact, &answer);
    expect(subject, want, &answer, "scene query");
}

static void expect_service(const struct subject *subject)
{
    static char certificate[FMB_CERTIFICATE_MAX];
    const struct fmb_placement *placement[2] = {&subject->pair->a, &subject->pair->b};
    struct query_placement of[2];
    size_t length;
    for (int f = 0; f < 2; f++) {
        assert_true(client_scene_geometry_bytes(placement[f]->body) < QUERY_BYTES_MAX / 2);
        client_scene_placement(placement[f], NULL, geometry[f], &of[f]);
    }
    const bool certified =
        pair_certificate(subject->pair, certificate, sizeof certificate, &length) == FMB_OK;
    for (unsigned want = 0; want <= (ALL | FMB_WANT_CERTIFICATE); want++) {
        if (!(want & FMB_WANT_TIMES) && (certified || !(want & FMB_WANT_CERTIFICATE)))
            expect_pair_query(subject, of, want, certificate);
        if (!(want & FMB_WANT_CERTIFICATE))
            expect_scene_query(subject, of, want);
    }
}

/* ---- Pairs ---- */

static void expect_parts(const struct pair *pair, const struct question *question)
{
    struct subject subject = {pair, question};
    expect_single(&subject);
    const double least = subject.whole.gap.bounds[0];
    const bool single = pair->a.body->frame_count == 1 && pair->b.body->frame_count == 1;
    for (unsigned want = 0; want <= ALL; want++) {
        if (want & FMB_WANT_CERTIFICATE)
            continue;
        if (single)
            for (int listing = 0; listing < 2; listing++)
                expect_batch(&subject, want, listing);
        expect_scene(&subject, want, 0);
        if (isfinite(least) && least != 0)
            expect_scene(&subject, want, fabs(least));
    }
    expect_service(&subject);
}

static void parts_of_all_shapes(void **state)
{
    const long sample = draw_sample(3); /* of eight cells */
    long pairs = 0;
    for (size_t f = 0; family_all_at(f); f++) {
        const struct family *family = family_all_at(f);
        struct cell cells[CELL_OF_ALL_SHAPES];
        const int count = family_cells(family, cells);
        for (int c = (int) (f % 8); c < count; c += draw_step(3)) {
            struct draw draw = cell_draw(3, family->name, &cells[c], 0);
            struct question question;
            static struct trial trial;
            if (c % 8 >= sample)
                continue;
            family_draw(family, &cells[c], &draw, &question);
            trial_begin(&question, &trial);
            expect_parts(&trial.pair[0], &question);
            trial_end(&trial);
            pairs++;
        }
    }
    printf("# %ld pairs\n", pairs);
}

/* Doubles give ends that are tight enough more often for contacts than for boxes, or the other way
 * round. */
static void parts_of_small_hulls(void **state)
{
    static struct hull_pair_draw small;
    struct draw draw;
    draw_begin(&draw, "parts_of_small_hulls");
    for (long i = draw_sample(800); i > 0; i--) {
        hull_draw_small(&draw, &small);
        expect_parts(&small.pair, NULL);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_of_all_shapes),
        cmocka_unit_test(parts_of_small_hulls),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
