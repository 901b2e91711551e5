/* The client library against the service: every answer is that of libfmb, to the bit, in the order
 * of the pairs, whatever the size of the scene and whatever the service holds. */
#include "unit.h"

#include "client_scene.h"
#include "relay.h"
#include "wire.h"

#include <math.h>
#include <pthread.h>

enum { ALL_WANTS = FMB_WANT_BOX | FMB_WANT_TIMES | FMB_WANT_POINT };

static struct fmb_placement *frames_of(size_t count, int dim, double size, int64_t first_id)
{
    struct fmb_placement *frame = malloc((count + 1) * sizeof *frame);
    relay_draw(frame, count, dim, size, first_id, 7);
    return frame;
}

static struct fmb_scene scene_of(const struct fmb_placement *frame, size_t count,
                                 enum fmb_pairs which, unsigned want)
{
    return (struct fmb_scene){.placements = frame,
                              .placement_count = count,
                              .which = which,
                              .duration = 0.75,
                              .want = want};
}

static unsigned (*list_of(size_t count, size_t frames))[2]
{
    unsigned(*pair)[2] = malloc((count + 1) * sizeof *pair);
    srand(3);
    for (size_t i = 0; i < count; i++) {
        pair[i][0] = (unsigned) rand() % (unsigned) frames;
        pair[i][1] =
            ((unsigned) rand() % (unsigned) (frames - 1) + pair[i][0] + 1) % (unsigned) frames;
    }
    return pair;
}

/* ---- Sizes and orders ---- */

static void small_scenes_of_every_kind_are_answered(void **state)
{
    relay_start(1000, 5, 6);
    for (size_t count = 0; count < 40; count += count < 4 ? 1 : 9)
        for (int dim = 2; dim <= 3; dim++)
            for (unsigned want = 0; want <= (ALL_WANTS | FMB_WANT_GAP); want++) {
                if (want & FMB_WANT_CERTIFICATE)
                    continue;
                struct fmb_placement *frame = frames_of(count, dim, 3, 1);
                struct fmb_scene scene = scene_of(frame, count, FMB_PAIRS_ALL, want);
                scene.margin = (want + count) % 2 ? 0.5 : 0;
                relay_query(test.client, &scene);
                scene.which = FMB_PAIRS_ACROSS;
                for (scene.split = 0; scene.split <= count; scene.split += 1 + count / 3)
                    relay_query(test.client, &scene);
                scene.which = FMB_PAIRS_LISTED;
                scene.split = 0;
                scene.pair_count = count < 2 ? 0 : 2 * count;
                unsigned(*pair)[2] = list_of(scene.pair_count, count);
                scene.pairs = (const unsigned(*)[2]) pair;
                relay_query(test.client, &scene);
                free(pair);
                free(frame);
            }
    assert_int_equal(relay_dropped(test.relay), 0);
    assert_int_equal(relay_counts(test.client).malformed, 0);
}

static void all_pairs_of_many_bodies_are_answered(void **state)
{
    const size_t count = relay_size(5000, 1300);
    relay_start(65536, 5, 6);
    struct fmb_placement *frame = frames_of(count, 3, cbrt(4.0 * (double) count), 1);
    const struct fmb_scene scene = scene_of(frame, count, FMB_PAIRS_ALL, ALL_WANTS);
    relay_query(test.client, &scene);
    assert_true(relay_counts(test.client).queries > 10);
    assert_int_equal(relay_dropped(test.relay), 0);
    free(frame);
}

/* Results with no room for all answers: nearly all pairs meet. */
static void all_pairs_of_a_crowd_are_answered(void **state)
{
    const size_t count = relay_size(900, 300);
    relay_start(65536, 5, 6);
    struct fmb_placement *frame = frames_of(count, 2, 2, 1);
    struct fmb_scene scene = scene_of(frame, count, FMB_PAIRS_ALL, ALL_WANTS);
    relay_query(test.client, &scene);
    assert_true(relay_counts(test.client).queries > count * count / 27000);
    scene.which = FMB_PAIRS_ACROSS;
    scene.split = count / 3;
    relay_query(test.client, &scene);
    free(frame);
}

static void query_list(size_t count, size_t frames, unsigned want)
{
    struct fmb_placement *frame = frames_of(frames, 3, 8, 1);
    unsigned(*pair)[2] = list_of(count, frames);
    struct fmb_scene scene = scene_of(frame, frames, FMB_PAIRS_LISTED, want);
    scene.pairs = (const unsigned(*)[2]) pair;
    scene.pair_count = count;
    relay_query(test.client, &scene);
    assert_int_equal(relay_dropped(test.relay), 0);
    free(pair);
    free(frame);
}

static void many_listed_pairs_are_answered(void **state)
{
    const size_t count = relay_size(100000, 20000);
    relay_start(65536, 5, 6);
    query_list(count, 3000, 0);
    query_list(count, 3000, ALL_WANTS);
}

/* Bodies take no space beside their pairs. Queries become longer, up to a datagram, once it is
 * known how long the first ones take. */
static void pairs_of_few_bodies_fill_datagrams(void **state)
{
    relay_start(65536, 5, 6);
    query_list(80000, 3, 0);
    assert_in_range(relay_counts(test.client).queries, 80000 / QUERY_PAIRS_MAX, 80000 / 512);
}

static void never(void *user, const struct fmb_client_answer *answer)
{
    (void) user;
    (void) answer;
    fail();
}

static void wrong(struct fmb_client *client, const struct fmb_scene *scene, int status,
                  const char *place)
{
    assert_int_equal(fmb_client_query(client, scene, never, NULL), status);
    assert_memory_equal(fmb_client_why(client), place, strlen(place));
}

/* ---- Methods and certificates ---- */

/* Answers against fmb_decide(), called for each pair up to the one that is given. */
struct giving {
    const struct fmb_scene *scene;
    size_t given, undecided, separated;
    unsigned a, b; /* next pair */
};

static enum fmb_status decide(struct giving *giving, struct fmb_answer *answer)
{
    const struct fmb_scene *scene = giving->scene;
    const struct fmb_placement *a = &scene->placements[giving->a];
    const struct fmb_placement *b = &scene->placements[giving->b];
    const struct fmb_method *method = scene->method ? scene->method : fmb_method_default();
    if (++giving->b == scene->placement_count)
        giving->b = ++giving->a + 1;
    const unsigned want =
        (scene->want & (FMB_WANT_BOX | FMB_WANT_POINT)) | (scene->margin > 0 ? FMB_WANT_GAP : 0);
    const enum fmb_status status = fmb_decide(method, a, b, scene->duration, want, answer);
    if (!(scene->want & FMB_WANT_GAP))
        query_remove_far_gap(scene->margin, answer);
    return status;
}

static void check_method(void *user, const struct fmb_client_answer *answer)
{
    struct giving *giving = user;
    struct fmb_answer should;
    enum fmb_status status;
    unsigned a, b;
    bool separated;
    do {
        a = giving->a;
        b = giving->b;
        status = decide(giving, &should);
        separated = status == FMB_OK && should.verdict == FMB_SEPARATED &&
                    !(should.has_gap && should.gap.bounds[0] <= giving->scene->margin);
        giving->separated += separated;
    } while (separated && giving->scene->which != FMB_PAIRS_LISTED);
    assert_int_equal(answer->a, a);
    assert_int_equal(answer->b, b);
    assert_int_equal(answer->status, status);
    assert_int_equal(answer->answer.verdict, should.verdict);
    if (giving->scene->want & FMB_WANT_TIMES)
        assert_memory_equal(answer->answer.contact, should.contact, sizeof should.contact);
    assert_memory_equal(answer->answer.box, should.box, sizeof should.box);
    assert_memory_equal(answer->answer.point, should.point, sizeof should.point);
    assert_true(query_same_gap(&answer->answer.gap, &should.gap));
    giving->given++;
    giving->undecided += status != FMB_OK;
}

/* Returns all pairs of so many placements. */
static unsigned (*all_pairs_of(size_t placements))[2]
{
    unsigned(*pair)[2] = malloc(placements * placements * sizeof *pair), count = 0;
    for (unsigned a = 0; a < placements; a++)
        for (unsigned b = a + 1; b < placements; b++, count++)
            pair[count][0] = a, pair[count][1] = b;
    return pair;
}

/* fmb and sat decide listed pairs only. */
static void every_method_answers(void **state)
{
    relay_start(1000, 5, 6);
    struct fmb_placement *frame = frames_of(60, 3, 3, 1);
    unsigned(*pair)[2] = all_pairs_of(60);
    for (size_t i = 0; fmb_method_at(i); i++) {
        struct fmb_scene scene = scene_of(frame, 60, FMB_PAIRS_ALL, ALL_WANTS);
        struct giving giving = {.scene = &scene, .b = 1};
        scene.method = fmb_method_at(i);
        if (!scene.method->certain) {
            wrong(test.client, &scene, FMB_CANNOT_DECIDE, "method: listed pairs only");
            scene.which = FMB_PAIRS_LISTED;
            scene.pairs = (const unsigned(*)[2]) pair;
            scene.pair_count = 60 * 59 / 2;
            scene.margin = 1;
            wrong(test.client, &scene, FMB_CANNOT_DECIDE, "method: gives no gaps");
            scene.margin = 0;
        }
        assert_int_equal(fmb_client_query(test.client, &scene, check_method, &giving), FMB_OK);
        assert_true(giving.given > 100);
        assert_true(giving.separated > 100);
        assert_true(fmb_method_at(i)->certain == (giving.undecided == 0));
    }
    free(pair);
    free(frame);
}

/* Near pairs, none missed, in the blocks that a large scene is divided into. */
static void near_pairs_of_many_bodies_are_answered(void **state)
{
    relay_start(65536, 5, 6);
    struct fmb_placement *frame = frames_of(800, 3, 25, 1);
    struct fmb_scene scene = scene_of(frame, 800, FMB_PAIRS_ALL, 0);
    scene.margin = 0.25;
    relay_query(test.client, &scene);
    assert_true(relay_counts(test.client).queries > 3);
    scene.method = fmb_method_by_name("exact"); /* is answered by lists */
    scene.placement_count = 60;
    for (size_t i = 0; i < 60; i++)
        for (int axis = 0; axis < 3; axis++)
            frame[i].position[axis] /= 4;
    for (scene.want = 0; scene.want <= FMB_WANT_GAP; scene.want += FMB_WANT_GAP) {
        struct giving giving = {.scene = &scene, .b = 1};
        assert_int_equal(fmb_client_query(test.client, &scene, check_method, &giving), FMB_OK);
        assert_true(giving.separated > 0 && giving.given > 0);
    }
    assert_int_equal(relay_counts(test.client).malformed, 0);
    free(frame);
}

static void check_certificate(void *user, const struct fmb_client_answer *answer)
{
    struct giving *giving = user;
    char why[200];
    assert_int_equal(answer->status, FMB_OK);
    assert_int_equal(answer->a, giving->a);
    assert_int_equal(answer->b, giving->b);
    struct fmb_answer should;
    assert_int_equal(decide(giving, &should), FMB_OK);
    assert_int_equal(answer->answer.verdict, should.verdict);
    assert_memory_equal(answer->answer.box, should.box, sizeof should.box);
    assert_true(query_same_gap(&answer->answer.gap, &should.gap));
    giving->separated += should.verdict == FMB_SEPARATED && should.has_gap;
    const struct fmb_placement *placements = giving->scene->placements;
    assert_non_null(answer->certificate);
    assert_true(fmb_certificate_holds(&placements[answer->a], &placements[answer->b],
                                      giving->scene->duration, answer->answer.verdict,
                                      answer->certificate, why, sizeof why));
    giving->given++;
}

static void all_pairs_have_certificates(void **state)
{
    relay_open(test.relay, 20); /* fewer than there are */
    test.client = relay_client(test.relay, 5, 1);
    struct fmb_placement *frame = frames_of(40, 2, 3, 1);
    relay_use_first_frames(frame, 40); /* certificates are of those */
    struct fmb_scene scene = scene_of(frame, 40, FMB_PAIRS_ALL, ALL_WANTS | FMB_WANT_CERTIFICATE);
    scene.margin = 0.25;
    struct giving giving = {.scene = &scene, .b = 1};
    assert_int_equal(fmb_client_query(test.client, &scene, check_certificate, &giving), FMB_OK);
    assert_int_equal(giving.given, 780);
    assert_in_range(giving.separated, 1, 779);
    assert_int_equal(relay_dropped(test.relay), 0);
    free(frame);
}

static void count_answer(void *user, const struct fmb_client_answer *answer)
{
    int *count = user;
    assert_int_equal(answer->status, FMB_OK);
    ++*count;
}

/* Returns a body with tetrahedra and faces of vertices, which its components round. */
static const struct fmb_body *by_vertices(const struct fmb_body *body)
{
    struct fmb_frame frame[3];
    for (unsigned i = 0; i < body->frame_count; i++) {
        double number[FMB_FRAME_NUMBERS_MAX];
        bool is_by_vertices;
        frame[i] = *fmb_body_frame(body, i);
        const size_t count = fmb_frame_numbers(&frame[i], &is_by_vertices, number, COUNT(number));
        for (int axis = 0; axis < body->dim; axis++)
            number[axis] += 1e5;
        if (frame[i].shape == FMB_TETRAHEDRON || frame[i].shape == FMB_FACE)
            assert_int_equal(
                fmb_frame_make_vertices(body->dim, (int) frame[i].shape, number, count, &frame[i]),
                FMB_OK);
    }
    return relay_body(frame, body->frame_count);
}

/* Returns a body of a hull, alone or behind the first frame of another body: of 1 to 60 vertices,
 * some of them equal, some of them in a plane. */
static const struct fmb_body *with_hull(const struct fmb_body *body, int number)
{
    enum { MOST = 60, BODIES = 400 };
    static double memory[BODIES][4 * MOST + 32];
    static int used;
    double vertices[FMB_DIM_MAX * MOST];
    struct fmb_frame frame[2] = {*fmb_body_frame(body, 0)};
    const int count = 1 + number * 7 % MOST, dim = body->dim;
    for (int i = 0; i < dim * count; i++)
        vertices[i] = sin(1.0 + number + i * (i % 5 + 1));
    for (int i = dim - 1; i < dim * count && number % 4 == 0; i += dim)
        vertices[i] = 0.5;
    memcpy(vertices + dim * (count - 1), vertices, (size_t) dim * sizeof *vertices);
    assert_true(used < BODIES);
    assert_int_equal(
        fmb_frame_make_hull(dim, vertices, (size_t) (dim * count), memory[used++], &frame[1]),
        FMB_OK);
    return number % 3 ? relay_body(frame + 1, 1) : relay_body(frame, 2);
}

/* Hulls by themselves and in bodies of several frames, whole and then by handle, in scenes and in
 * pairs: the bits of fmb_decide(). */
static void hulls(void **state)
{
    enum { BODIES = 120 };
    relay_start(4000, 5, 6);
    for (int dim = 2; dim <= 3; dim++) {
        struct fmb_placement *body = frames_of(BODIES, dim, dim == 2 ? 25 : 8, 1);
        for (int i = 0; i < BODIES; i++)
            body[i].body = i % 4 == 3 ? body[i].body : with_hull(body[i].body, i);
        struct fmb_scene scene = scene_of(body, BODIES, FMB_PAIRS_ALL, ALL_WANTS);
        for (int round = 0; round < 3; round++) { /* whole, by handle, with gaps */
            scene.want |= round == 2 ? FMB_WANT_GAP : 0;
            scene.margin = round == 2 ? 0.25 : 0;
            relay_query(test.client, &scene);
        }
        for (int i = 1; i < BODIES; i++) {
            struct fmb_client_answer got;
            struct fmb_answer expected;
            const unsigned want = FMB_WANT_BOX | FMB_WANT_GAP | FMB_WANT_POINT;
            assert_int_equal(fmb_client_query_pair(test.client, &body[i - 1], 1, want, &got),
                             FMB_OK);
            assert_int_equal(
                fmb_decide(fmb_method_default(), &body[i - 1], &body[i], 1, want, &expected),
                FMB_OK);
            assert_int_equal(got.answer.verdict, expected.verdict);
            assert_memory_equal(got.answer.contact, expected.contact, sizeof expected.contact);
            assert_memory_equal(got.answer.box, expected.box, sizeof expected.box);
            assert_memory_equal(got.answer.point, expected.point, sizeof expected.point);
            assert_true(query_same_gap(&got.answer.gap, &expected.gap));
        }
        free(body);
    }
    assert_true(relay_counts(test.client).by_handle > 0);
    assert_int_equal(relay_counts(test.client).malformed, 0);
}

/* Groups, names, a label, and frames by vertices, in queries of every kind. */
static void groups_names_and_vertices(void **state)
{
    enum { BODIES = 150 };
    relay_start(4000, 5, 6);
    for (int dim = 2; dim <= 3; dim++) {
        struct fmb_placement *body = frames_of(BODIES, dim, dim == 2 ? 28 : 9, 1);
        for (int i = 0; i < BODIES; i++) {
            body[i].group = i % 7 - 1;
            body[i].name = i % 3 ? "link \xe2\x82\xac" : NULL;
            body[i].body = by_vertices(body[i].body);
        }
        struct fmb_scene scene = scene_of(body, BODIES, FMB_PAIRS_ALL, ALL_WANTS);
        scene.label = "0123456789012345678901234567890123456789012345678901234567890123";
        for (int round = 0; round < 2; round++) { /* whole, then by handle */
            scene.margin = round * 0.5;
            scene.which = FMB_PAIRS_ALL;
            relay_query(test.client, &scene);
            scene.which = FMB_PAIRS_ACROSS;
            scene.split = 50;
            relay_query(test.client, &scene);
            scene.split = 0;
        }
        static const unsigned pairs[3][2] = {{1, 2}, {8, 2}, {9, 2}}; /* two of group 1 */
        scene.which = FMB_PAIRS_LISTED;
        scene.pairs = pairs;
        scene.pair_count = 2;
        relay_query(test.client, &scene);
        scene.pair_count = 3;
        wrong(test.client, &scene, FMB_BAD_PAIR, "pairs[2]: ");
        struct fmb_client_answer answer; /* which does not look at groups */
        const struct fmb_placement both[2] = {body[9], body[2]};
        assert_int_equal(fmb_client_query_pair(test.client, both, 1, 0, &answer), FMB_OK);
        free(body);
    }
    assert_int_equal(relay_counts(test.client).malformed, 0);
}

/* Each pair a query of its own: no pair within a group is sent. */
static void groups_where_pairs_are_listed(void **state)
{
    relay_start(1000, 5, 6);
    struct fmb_placement *body = frames_of(12, 3, 2, 1);
    relay_use_first_frames(body, 12);
    for (int i = 0; i < 10; i++)
        body[i].group = -3;
    struct fmb_scene scene = scene_of(body, 12, FMB_PAIRS_ALL, FMB_WANT_CERTIFICATE);
    int given = 0;
    assert_int_equal(fmb_client_query(test.client, &scene, count_answer, &given), FMB_OK);
    assert_int_equal(given, 12 * 11 / 2 - 10 * 9 / 2);
    assert_int_equal(relay_counts(test.client).queries, given);
    free(body);
}

static void one_pair_is_answered(void **state)
{
    relay_start(10, 5, 6);
    struct fmb_client_answer answer;
    struct fmb_placement pair[2];
    relay_draw(pair, 2, 2, 1, 1, 1);
    for (int k = 0; k < 2; k++)
        pair[1] = pair[0], pair[1].id = 2, pair[1].position[0] += 1;
    assert_int_equal(fmb_client_query_pair(test.client, pair, 1, 0, &answer), FMB_OK);
    assert_int_equal(answer.answer.verdict, FMB_TOUCHING);
    assert_null(answer.certificate);
    assert_false(answer.answer.has_gap);
    assert_int_equal(fmb_client_query_pair(test.client, pair, 1, FMB_WANT_GAP, &answer), FMB_OK);
    assert_true(answer.answer.has_gap && !answer.answer.gap.has_witness);
    assert_int_equal(fmb_client_query_pair(test.client, pair, 1, FMB_WANT_CERTIFICATE, &answer),
                     FMB_OK);
    assert_memory_equal(answer.certificate, "touching", 8);
    pair[1].position[1] = INFINITY;
    assert_int_equal(fmb_client_query_pair(test.client, pair, 1, 0, &answer), FMB_NOT_FINITE);
    assert_string_equal(answer.text, "placements[1]: not a finite number");
}

/* ---- Wrong scenes ---- */

static void wrong_scenes_are_refused(void **state)
{
    relay_start(10, 5, 6);
    struct fmb_placement frame[3], good[3];
    relay_draw(good, 3, 3, 1, 1, 1);
    memcpy(frame, good, sizeof good);
    struct fmb_scene scene = scene_of(frame, 3, FMB_PAIRS_LISTED, 0);
    frame[2].body = NULL;
    wrong(test.client, &scene, FMB_NO_FRAMES, "placements[2]: ");
    frame[2] = good[2], frame[2].name = "a\n";
    wrong(test.client, &scene, FMB_BAD_NAME, "placements[2].name: ");
    frame[2] = good[2];
    scene.label = "01234567890123456789012345678901234567890123456789012345678901234";
    wrong(test.client, &scene, FMB_OVER_LIMIT, "label: ");
    scene.label = NULL;
    frame[2].orientation_count = 3;
    wrong(test.client, &scene, FMB_WRONG_COUNT, "placements[2]: ");
    frame[2] = good[2], frame[2].end_count = 8;
    wrong(test.client, &scene, FMB_WRONG_COUNT, "placements[2]: ");
    frame[2] = good[2], frame[0].velocity[1] = NAN;
    wrong(test.client, &scene, FMB_NOT_FINITE, "placements[0]: ");
    frame[0] = good[0], frame[0].id = INT64_C(1) << 53;
    wrong(test.client, &scene, FMB_BAD_ID, "placements[0].id: ");
    frame[0].id = -1;
    wrong(test.client, &scene, FMB_BAD_ID, "placements[0].id: ");
    frame[0] = good[0];
    const unsigned same[][2] = {{0, 1}, {1, 1}}, beyond[][2] = {{0, 3}};
    scene.pairs = same, scene.pair_count = 2;
    wrong(test.client, &scene, FMB_BAD_PAIR, "pairs[1]: ");
    scene.pairs = beyond, scene.pair_count = 1;
    wrong(test.client, &scene, FMB_BAD_PAIR, "pairs[0]: ");
    scene.ignored = same, scene.ignored_count = 1, scene.pair_count = 0;
    wrong(test.client, &scene, FMB_WRONG_COUNT, "ignored_count: ");
    scene.which = FMB_PAIRS_ALL, scene.ignored_count = 2;
    wrong(test.client, &scene, FMB_BAD_PAIR, "ignored[1]: ");
    scene.ignored_count = 0;
    scene.which = FMB_PAIRS_ACROSS, scene.split = 4;
    wrong(test.client, &scene, FMB_BAD_PAIR, "split: ");
    scene.which = (enum fmb_pairs) 3;
    wrong(test.client, &scene, FMB_BAD_PAIR, "which: ");
    scene.which = FMB_PAIRS_ALL, scene.want = 2 * FMB_WANT_POINT;
    wrong(test.client, &scene, FMB_UNKNOWN_WANT, "want: ");
    scene.want = 0, scene.duration = -1;
    wrong(test.client, &scene, FMB_BAD_DURATION, "duration: ");
    const double margins[] = {-0x1p-1074, INFINITY, NAN};
    scene.duration = 0;
    for (int i = 0; i < 3; i++) {
        scene.margin = margins[i];
        wrong(test.client, &scene, FMB_BAD_MARGIN, "margin: ");
    }
    assert_int_equal(test.relay->queries, 0);
}

/* ---- Fields that are 0 ---- */

static const struct fmb_body *cube_of(double size)
{
    const double number[6] = {0, 0, 0, size, size, size};
    struct fmb_frame frame;
    assert_int_equal(fmb_frame_make(3, FMB_BOX, number, 6, &frame), FMB_OK);
    return relay_body(&frame, 1);
}

static void count_meeting(void *user, const struct fmb_client_answer *answer)
{
    assert_int_equal(answer->status, FMB_OK);
    *(int *) user += answer->answer.verdict >= FMB_TOUCHING;
}

static void a_scene_of_zeros_queries_all_pairs(void **state)
{
    static const unsigned pair[1][2] = {{0, 1}};
    struct fmb_placement placement[2] = {{.body = cube_of(1)}};
    struct fmb_scene scene = {.placements = placement, .placement_count = 2};
    int contacts = 0;
    placement[1] = placement[0];
    relay_start(10, 5, 6);
    assert_int_equal(fmb_client_query(test.client, &scene, count_meeting, &contacts), FMB_OK);
    assert_int_equal(contacts, 1);
    assert_int_equal(test.relay->queries, 1);
    scene.pairs = pair, scene.pair_count = 1;
    wrong(test.client, &scene, FMB_WRONG_COUNT, "pair_count: ");
    scene.pair_count = 0, scene.split = 1;
    wrong(test.client, &scene, FMB_BAD_PAIR, "split: ");
}

static void bodies_that_move_need_a_window(void **state)
{
    struct fmb_placement placement[2] = {{.body = cube_of(1)}};
    relay_start(10, 5, 6);
    for (int moving = 0; moving < 3; moving++)
        for (int duration = 0; duration < 2; duration++)
            for (int instant = 0; instant < 2; instant++) {
                const struct fmb_scene scene = {.placements = placement,
                                                .placement_count = 2,
                                                .duration = duration,
                                                .instant = instant};
                int contacts = 0;
                placement[1] = placement[0];
                placement[1].velocity[2] = moving == 1;
                placement[1].end_count = moving == 2 ? 3 : 0;
                if (duration ? instant : !instant && moving) {
                    wrong(test.client, &scene, FMB_BAD_DURATION,
                          instant ? "duration: " : "duration: it is 0, but body 1 moves");
                    continue;
                }
                if (moving < 2 || instant) {
                    assert_int_equal(
                        fmb_client_query(test.client, &scene, count_meeting, &contacts), FMB_OK);
                    assert_int_equal(contacts, 1);
                }
            }
    struct fmb_client_answer answer; /* of a pair query, whose duration 0 is an instant */
    assert_int_equal(fmb_client_query_pair(test.client, placement, 0, 0, &answer),
                     FMB_BAD_DURATION);
    assert_string_equal(answer.text, "duration: it is 0, but body 1 moves");
    placement[1] = placement[0], placement[1].velocity[0] = 1;
    assert_int_equal(fmb_client_query_pair(test.client, placement, 0, 0, &answer), FMB_OK);
    assert_int_equal(answer.answer.verdict, FMB_OVERLAPPING);
}

/* ---- Ends ---- */

struct ends {
    const struct fmb_scene *scene;
    unsigned last[2];
    size_t given, undecided;
};

static void check_end(void *user, const struct fmb_client_answer *of)
{
    struct ends *ends = user;
    const struct fmb_scene *scene = ends->scene;
    const unsigned want = FMB_WANT_BOX | FMB_WANT_POINT | FMB_WANT_GAP;
    struct fmb_answer answer;
    assert_int_equal(fmb_decide(fmb_method_default(), &scene->placements[of->a],
                                &scene->placements[of->b], scene->duration, want, &answer),
                     of->status);
    assert_true(scene->which == FMB_PAIRS_LISTED || ends->given == 0 || of->a > ends->last[0] ||
                (of->a == ends->last[0] && of->b > ends->last[1]));
    ends->last[0] = of->a;
    ends->last[1] = of->b;
    ends->given++;
    ends->undecided += of->status == FMB_CANNOT_DECIDE;
    if (of->status == FMB_OK)
        assert_true(query_same_answer(&of->answer, &answer));
    else
        assert_string_equal(of->text, fmb_status_text(FMB_CANNOT_DECIDE));
}

static size_t count_named(const struct fmb_scene *scene)
{
    struct fmb_answer answer;
    size_t count = 0;
    for (size_t b = 0; b < scene->placement_count; b++)
        for (size_t a = 0; a < b; a++) {
            fmb_decide(fmb_method_default(), &scene->placements[a], &scene->placements[b],
                       scene->duration, 0, &answer);
            count += answer.verdict != FMB_SEPARATED;
        }
    return count;
}

/* Status and answer are equal to the result of fmb_decide(). No undecided pair is taken for
 * separated. */
static void ends_are_answered(void **state)
{
    enum { BODIES = 40 };
    relay_start(65536, 5, 6);
    for (int dim = 2; dim <= 3; dim++) {
        const int turns = dim == 2 ? 2 : 4;
        struct fmb_placement *frame = frames_of(BODIES, dim, 4, 1);
        for (size_t i = 0; i < BODIES; i += 2) {
            memset(frame[i].velocity, 0, sizeof frame[i].velocity);
            frame[i].end_count = dim + frame[i].orientation_count;
            for (int axis = 0; axis < dim; axis++)
                frame[i].end_position[axis] = frame[i].position[axis] + 0.125 * (double) (i % 3);
            for (int k = 0; k < frame[i].orientation_count; k++)
                frame[i].end_orientation[k] =
                    frame[i].orientation[(k + 1) % turns] * 0.25 + frame[i].orientation[k];
        }
        struct fmb_scene scene = scene_of(frame, BODIES, FMB_PAIRS_ALL, ALL_WANTS | FMB_WANT_GAP);
        struct ends all = {.scene = &scene}, listed = {.scene = &scene};
        assert_int_equal(fmb_client_query(test.client, &scene, check_end, &all), FMB_OK);
        assert_int_equal(all.given, count_named(&scene));
        unsigned(*pair)[2] = list_of(60, BODIES);
        scene.which = FMB_PAIRS_LISTED;
        scene.pairs = (const unsigned(*)[2]) pair;
        scene.pair_count = 60;
        assert_int_equal(fmb_client_query(test.client, &scene, check_end, &listed), FMB_OK);
        assert_int_equal(listed.given, 60);
        /* At an instant, ends are ignored. */
        scene.duration = 0;
        scene.instant = true;
        struct fmb_placement still[BODIES];
        memcpy(still, frame, sizeof still);
        for (size_t i = 0; i < BODIES; i++)
            still[i].end_count = 0;
        struct fmb_scene truth = scene;
        truth.placements = still;
        struct ends instant = {.scene = &truth};
        assert_int_equal(fmb_client_query(test.client, &scene, check_end, &instant), FMB_OK);
        assert_int_equal(instant.given, 60);
        assert_int_equal(instant.undecided, 0);
        free(pair);
        free(frame);
    }
}

/* A method that the service does not know is refused by it, pair by pair. */
static void count_refusals(void *user, const struct fmb_client_answer *answer)
{
    assert_int_equal(answer->status, FMB_UNKNOWN_METHOD);
    assert_memory_equal(answer->text, "method: ", 8);
    ++*(int *) user;
}

static void refusals_of_the_service_are_given(void **state)
{
    int count = 0;
    relay_start(10, 5, 6);
    struct fmb_placement frame[5];
    relay_draw(frame, 5, 3, 1, 1, 1);
    struct fmb_scene scene = scene_of(frame, 5, FMB_PAIRS_ALL, 0);
    const struct fmb_method unknown = {.number = 77, .certain = true};
    scene.method = &unknown;
    assert_int_equal(fmb_client_query(test.client, &scene, count_refusals, &count), FMB_OK);
    assert_int_equal(count, 10);
}

/* ---- Handles ---- */

struct world {
    struct relay *relay;
    struct fmb_client *client;
    struct fmb_placement *frame;
    struct fmb_scene scene;
};

static void open_world(struct world *world, size_t bodies)
{
    memset(world, 0, sizeof *world);
    world->relay = relay_new();
    relay_open(world->relay, bodies);
    world->client = relay_client(world->relay, 5, 1);
    world->frame = frames_of(100, 3, 5, 1);
    relay_draw(world->frame, 100, 3, 5, 1, 8); /* no two of these share a slot of held.h */
    world->scene = scene_of(world->frame, 100, FMB_PAIRS_ALL, ALL_WANTS);
}

static void close_world(struct world *world)
{
    fmb_client_close(world->client);
    free(world->frame);
    relay_close(world->relay);
}

/* Queries the scene. On output: what was done for it. A query that was sent again, on a slow
 * machine, has been processed too: a service that begins later does not see it. */
static struct fmb_client_counts query_world(struct world *world)
{
    const struct fmb_client_counts before = relay_counts(world->client);
    relay_query(world->client, &world->scene);
    struct fmb_client_counts counts = relay_counts(world->client);
    relay_wait(world->relay, counts.queries + counts.repeated);
    counts.queries -= before.queries;
    counts.repeated -= before.repeated;
    counts.bytes -= before.bytes;
    counts.whole -= before.whole;
    counts.by_handle -= before.by_handle;
    return counts;
}

static int bytes_of_a_message(const struct fmb_client_counts *counts)
{
    return (int) (counts->bytes / (counts->queries + counts->repeated));
}

static void bodies_go_by_handle_the_second_time(void **state)
{
    struct world world;
    open_world(&world, 1000);
    world.frame[50].id = 0;
    const struct fmb_client_counts first = query_world(&world), second = query_world(&world);
    assert_int_equal(first.whole, 100);
    assert_int_equal(first.by_handle, 0);
    assert_int_equal(second.whole, 1);
    assert_int_equal(second.by_handle, 99);
    assert_int_equal(second.queries, 1);
    const int whole = bytes_of_a_message(&first), by_handle = bytes_of_a_message(&second);
    assert_true(by_handle < 2 * whole / 3);
    print_message("# 100 bodies whole: %d bytes, by handle: %d\n", whole, by_handle);
    /* A body that has other components, be it in the sign of a zero, goes whole. */
    const struct fmb_body *before = world.frame[3].body;
    world.frame[3].body = relay_change(before, 1, -0.0);
    assert_int_equal(query_world(&world).whole, 2);
    /* The body from before is still held. */
    world.frame[3].body = relay_change(before, 1, 0);
    assert_int_equal(query_world(&world).whole, 1);
    /* The pose does not matter. */
    world.frame[3].position[1] += 1;
    world.frame[3].orientation_count = 4;
    world.frame[3].orientation[2] += 0.5;
    assert_int_equal(query_world(&world).whole, 1);
    close_world(&world);
}

static void a_new_service_holds_no_bodies(void **state)
{
    struct world world;
    open_world(&world, 1000);
    query_world(&world);
    relay_restart(world.relay, 1000);
    const struct fmb_client_counts counts = query_world(&world);
    assert_int_equal(counts.queries, 2);
    assert_int_equal(counts.whole, 100);
    assert_int_equal(query_world(&world).whole, 0);
    close_world(&world);
}

static void a_cache_of_one_body_is_enough(void **state)
{
    for (size_t bodies = 1; bodies <= 64; bodies *= 4) {
        struct world world;
        open_world(&world, bodies);
        for (int i = 0; i < 4; i++)
            assert_true(query_world(&world).queries <= 3);
        close_world(&world);
    }
}

static size_t stolen;

/* Another client's scene comes before each query, and puts all bodies out of the cache. */
static void steal(struct relay *relay)
{
    relay_restart(relay, 1000);
    stolen++;
}

static void bodies_that_are_never_held_end(void **state)
{
    struct world world;
    open_world(&world, 1000);
    query_world(&world);
    world.relay->before = steal;
    for (int i = 0; i < 3; i++)
        assert_int_equal(query_world(&world).queries, 2);
    assert_true(stolen >= 6); /* a slow machine repeats queries, and some of them arrive late */
    struct fmb_client_answer answer;
    assert_int_equal(fmb_client_query_pair(world.client, world.frame, 1, 0, &answer), FMB_OK);
    close_world(&world);
}

/* ---- Ignored pairs, and bodies of many frames ---- */

static void ignored_pairs_are_left_out(void **state)
{
    struct world world;
    open_world(&world, 1000);
    enum { PAIRS = 500 };
    unsigned(*pair)[2] = list_of(PAIRS, 100);
    world.scene.ignored = (const unsigned(*)[2]) pair;
    world.scene.ignored_count = PAIRS;
    query_world(&world);
    world.scene.which = FMB_PAIRS_ACROSS;
    for (world.scene.split = 0; world.scene.split <= 100; world.scene.split += 25)
        query_world(&world);
    world.scene.which = FMB_PAIRS_ALL, world.scene.split = 0; /* more than fit into one datagram */
    free(pair);
    unsigned(*all)[2] = malloc(100 * 100 * sizeof *all);
    size_t count = 0;
    for (unsigned a = 0; a < 100; a++)
        for (unsigned b = 0; b < 100; b++)
            if (a != b && (a + b) % 10 != 0)
                all[count][0] = a, all[count++][1] = b;
    world.scene.ignored = (const unsigned(*)[2]) all;
    world.scene.ignored_count = count;
    query_world(&world);
    free(all);
    close_world(&world);
}

/* Two bodies that do not fit into one datagram together: their frames are sent first. */
static void bodies_of_many_frames_are_answered(void **state)
{
    enum { FRAMES = 500, BODIES = 5 };
    relay_start(20000, 5, 6);
    struct fmb_placement *placement = frames_of(BODIES * FRAMES, 3, 1, 1);
    struct fmb_frame *frame = malloc((size_t) BODIES * FRAMES * sizeof *frame);
    for (int i = 0; i < BODIES * FRAMES; i++) {
        const double number[] = {
            3 * (i % 7), 3 * (i % 11), 3 * (i % 13), 1, 0, 0, 0, 1, 0, 0, 0, 1};
        assert_int_equal(fmb_frame_make(3, FMB_CUBOID, number, 12, &frame[i]), FMB_OK);
    }
    for (int i = 0; i < BODIES; i++)
        placement[i].body = relay_body(frame + i * FRAMES, FRAMES);
    const struct fmb_scene scene = scene_of(placement, BODIES, FMB_PAIRS_ALL, ALL_WANTS);
    relay_query(test.client, &scene);
    const struct fmb_client_counts first = relay_counts(test.client);
    assert_in_range(first.whole, BODIES, 3 * BODIES); /* queries that are under way at once */
    relay_query(test.client, &scene);
    assert_int_equal(relay_counts(test.client).whole, first.whole);
    assert_int_equal(relay_counts(test.client).queries, first.queries + 1);
    relay_restart(test.relay, 20000);
    relay_query(test.client, &scene);
    /* Without ids there is no other way than both in one datagram. */
    placement[0].id = placement[1].id = 0;
    struct fmb_client_answer answer;
    assert_int_equal(fmb_client_query_pair(test.client, placement, 1, 0, &answer), FMB_OVER_LIMIT);
    placement[0].body = relay_body(frame, 700);
    assert_int_equal(fmb_client_query_pair(test.client, placement, 1, 0, &answer), FMB_OVER_LIMIT);
    assert_string_equal(fmb_client_why(test.client), "placements[0].body: over the limit");
    assert_int_equal(relay_counts(test.client).malformed, 0);
    free(placement);
    free(frame);
}

/* Returns a body of count frames: cuboids of them are cuboids, the others boxes. */
static const struct fmb_body *body_of(int count, int cuboids, int unique)
{
    struct fmb_frame *frame = malloc((size_t) count * sizeof *frame);
    for (int i = 0; i < count; i++) {
        const double cuboid[] = {i, unique, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
        const double box[] = {i, unique, 0, 1, 1, 1};
        assert_int_equal(
            fmb_frame_make(3, i < cuboids ? FMB_CUBOID : FMB_BOX, i < cuboids ? cuboid : box,
                           i < cuboids ? 12 : 6, &frame[i]),
            FMB_OK);
    }
    const struct fmb_body *body = relay_body(frame, (size_t) count);
    free(frame);
    return body;
}

/* Bytes of a message that a body in 3D takes which is at rest and not turned. */
static int bytes_of(int geometry)
{
    return 8 + HANDLE_BYTES + geometry + 4 + 1 + 8 + 3 * 8 + 3 * 4;
}

/* A listed pair in a query that is as large as a datagram, and a byte less, and a few more: then
 * the bodies are sent first. */
static void pairs_that_just_fit_into_a_datagram(void **state)
{
    enum { BOX = 49, MORE = 48 }; /* bytes of a box, and how many more a cuboid has */
    static const unsigned pair[1][2] = {{0, 1}};
    const int most = QUERY_BYTES_MAX - WIRE_SCENE_QUERY_BYTES - WIRE_PAIR_BYTES;
    relay_start(20000, 5, 6);
    for (int bytes = most - 1; bytes < most + 6; bytes++) {
        const int frames = bytes - 2 * bytes_of(GEOMETRY_NONE_BYTES);
        int count = frames / (BOX + MORE) + 1;
        while ((frames - BOX * count) % MORE != 0)
            count++;
        const int cuboids = (frames - BOX * count) / MORE, half = count / 2;
        struct fmb_placement body[2] = {
            {.id = 2 * bytes, .body = body_of(half, cuboids < half ? cuboids : half, bytes)},
            {.id = 2 * bytes + 1,
             .body = body_of(count - half, cuboids < half ? 0 : cuboids - half, bytes),
             .position = {100}}};
        assert_int_equal(bytes_of((int) client_scene_geometry_bytes(body[0].body)) +
                             bytes_of((int) client_scene_geometry_bytes(body[1].body)),
                         bytes);
        struct fmb_scene scene = scene_of(body, 2, FMB_PAIRS_LISTED, 0);
        scene.pairs = pair;
        scene.pair_count = 1;
        const uint64_t before = relay_counts(test.client).queries;
        relay_query(test.client, &scene);
        const uint64_t queries = relay_counts(test.client).queries - before;
        assert_true(bytes <= most ? queries == 1 : queries > 1);
    }
}

/* The answers from first_pair on, of lists, of one block and of many. */
static void scenes_may_begin_with_any_pair(void **state)
{
    relay_start(4000, 5, 6);
    struct fmb_placement *frame = frames_of(800, 3, 16, 1);
    unsigned(*pair)[2] = list_of(500, 800);
    for (int kind = 0; kind < 4; kind++) {
        struct fmb_scene scene = scene_of(frame, kind < 2 ? 800 : 40, FMB_PAIRS_ALL, 0);
        if (kind == 0) {
            scene.which = FMB_PAIRS_LISTED;
            scene.pairs = (const unsigned(*)[2]) pair;
            scene.pair_count = 500;
        }
        if (kind == 3)
            scene.which = FMB_PAIRS_ACROSS, scene.split = 20;
        const unsigned long long count = fmb_scene_pair_count(&scene);
        for (int k = 1; k <= 3; k++) {
            scene.first_pair = count * (unsigned) k / 3;
            relay_query(test.client, &scene);
        }
        scene.first_pair++;
        wrong(test.client, &scene, FMB_BAD_PAIR, "first_pair: ");
    }
    free(pair);
    free(frame);
}

/* ---- Several clients ---- */

enum { THREAD_QUERIES = 8 };

/* cmocka's asserts are for the thread that runs the tests. */
struct thread {
    const struct fmb_scene *scene;
    struct relay *relay;
    struct fmb_client *client;
    uint64_t contacts;
    int failed;
};

static void count_contacts(void *user, const struct fmb_client_answer *answer)
{
    struct thread *thread = user;
    thread->contacts += answer->answer.verdict != FMB_SEPARATED;
    thread->failed += answer->status != FMB_OK;
}

static void *run(void *user)
{
    struct thread *thread = user;
    for (int i = 0; i < THREAD_QUERIES; i++)
        thread->failed +=
            fmb_client_query(thread->client, thread->scene, count_contacts, thread) != FMB_OK;
    return NULL;
}

static void clients_of_several_threads_are_independent(void **state)
{
    struct thread thread[2];
    pthread_t id[2];
    const size_t count = relay_size(600, 250);
    struct fmb_placement *frame = frames_of(count, 3, 6, 1);
    const struct fmb_scene scene = scene_of(frame, count, FMB_PAIRS_ALL, ALL_WANTS);
    struct relay_truth truth;
    relay_truth_make(&scene, &truth);
    for (int i = 0; i < 2; i++) {
        memset(&thread[i], 0, sizeof thread[i]);
        thread[i].scene = &scene;
        thread[i].relay = relay_new();
        relay_open(thread[i].relay, 1000);
        thread[i].client = relay_client(thread[i].relay, 20, 1);
    }
    for (int i = 0; i < 2; i++)
        assert_int_equal(pthread_create(&id[i], NULL, run, &thread[i]), 0);
    for (int i = 0; i < 2; i++) {
        pthread_join(id[i], NULL);
        assert_int_equal(thread[i].failed, 0);
        assert_int_equal(thread[i].contacts, THREAD_QUERIES * truth.count);
        fmb_client_close(thread[i].client);
        relay_close(thread[i].relay);
    }
    relay_truth_clear(&truth);
    free(frame);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        RELAY_TEST(small_scenes_of_every_kind_are_answered),
        RELAY_TEST(all_pairs_of_many_bodies_are_answered),
        RELAY_TEST(all_pairs_of_a_crowd_are_answered),
        RELAY_TEST(many_listed_pairs_are_answered),
        RELAY_TEST(pairs_of_few_bodies_fill_datagrams),
        RELAY_TEST(every_method_answers),
        RELAY_TEST(near_pairs_of_many_bodies_are_answered),
        RELAY_TEST(all_pairs_have_certificates),
        RELAY_TEST(groups_names_and_vertices),
        RELAY_TEST(hulls),
        RELAY_TEST(groups_where_pairs_are_listed),
        RELAY_TEST(one_pair_is_answered),
        RELAY_TEST(wrong_scenes_are_refused),
        RELAY_TEST(a_scene_of_zeros_queries_all_pairs),
        RELAY_TEST(bodies_that_move_need_a_window),
        RELAY_TEST(ends_are_answered),
        RELAY_TEST(refusals_of_the_service_are_given),
        cmocka_unit_test(bodies_go_by_handle_the_second_time),
        cmocka_unit_test(a_new_service_holds_no_bodies),
        cmocka_unit_test(a_cache_of_one_body_is_enough),
        cmocka_unit_test(bodies_that_are_never_held_end),
        cmocka_unit_test(ignored_pairs_are_left_out),
        RELAY_TEST(bodies_of_many_frames_are_answered),
        RELAY_TEST(pairs_that_just_fit_into_a_datagram),
        RELAY_TEST(scenes_may_begin_with_any_pair),
        cmocka_unit_test(clients_of_several_threads_are_independent),
    };
    (void) argc;
    relay_enter(argv);
    return cmocka_run_group_tests_name("client_query", tests, NULL, NULL);
}
