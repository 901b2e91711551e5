/* A query of a log, taken out as a scene of JSON and decided by itself, has the answers that were
 * recorded, to the bit. */
#include "unit.h"

#include "geometry_write.h"
#include "log_query.h"

#include "answers.h"
#include "json.h"
#include "log_kind.h"
#include "log_world.h"
#include "sample_placement.h"
#include "scene_json.h"
#include "logged_query.h"
#include "wire.h"

#include <fcntl.h>
#include <float.h>
#include <math.h>
#include <unistd.h>

static char path[128];
static struct log_query found;

static int make_path(void **state)
{
    const char *temporary = getenv("TMPDIR");
    snprintf(path, sizeof path, "%.80s/fmb_query.XXXXXX", temporary ? temporary : "/tmp");
    const int fd = mkstemp(path);
    return fd < 0 ? -1 : close(fd);
}

static int remove_path(void **state)
{
    log_query_clear(&found);
    return unlink(path);
}

/* ---- Taking out ---- */

/* What it says is for people. */
static enum log_query_outcome look_for(struct log_query_options options)
{
    char *log = path;
    const int said = dup(STDERR_FILENO), nowhere = open("/dev/null", O_WRONLY);
    options.log = &log;
    options.log_count = 1;
    options.prefix = "";
    log_query_clear(&found);
    fflush(stderr);
    dup2(nowhere, STDERR_FILENO);
    const enum log_query_outcome outcome = log_query(&options, &found);
    fflush(stderr);
    dup2(said, STDERR_FILENO);
    close(said);
    close(nowhere);
    return outcome;
}

/* The scene, through its text. To be cleared. */
static struct owned_scene scene_of_found(void)
{
    struct owned_scene scene, read;
    FILE *text = tmpfile();
    assert_non_null(text);
    scene_of_query(&found.query, &scene);
    scene_json_write(text, &scene);
    assert_int_equal(fflush(text), 0);
    rewind(text);
    struct json_reader *reader = json_open(fileno(text));
    if (json_next(reader, &read) != JSON_SCENE)
        fail_msg("%s", json_error(reader));
    assert_int_equal(read.dim, scene.dim);
    assert_int_equal(read.scene.placement_count, scene.scene.placement_count);
    assert_int_equal(read.scene.which, scene.scene.which);
    assert_int_equal(read.scene.pair_count, scene.scene.pair_count);
    scene_clear(&scene);
    json_close(reader);
    fclose(text);
    return read;
}

/* ---- Answers, then and now ---- */

static union {
    struct pair_result pair;
    struct scene_result scene;
} recorded;

/* A walk over the pairs of a scene, in their order. */
struct walk {
    int32_t pair;    /* from first_pair on */
    int32_t verdict; /* the next one of the result */
    int32_t contact;
    int64_t compared;
    int dim;
};

static bool same_bits(const double *a, const double *b, size_t count)
{
    return memcmp(a, b, count * sizeof *a) == 0;
}

static void assert_contact(const struct walk *walk, const struct fmb_client_answer *answer, int dim)
{
    const struct scene_result *result = &recorded.scene;
    const double *times = result->has_times ? &result->times[2 * walk->contact] : NULL;
    const double *box = result->has_boxes ? &result->boxes[2 * dim * walk->contact] : NULL;
    if (result->has_times && isnan(times[0]))
        assert_false(answer->answer.has_contact);
    else if (result->has_times)
        assert_true(answer->answer.has_contact && same_bits(times, answer->answer.contact, 2));
    for (int side = 0; side < 2 && result->has_boxes; side++)
        assert_true(same_bits(box + dim * side, answer->answer.box[side], (size_t) dim));
}

/* Whether the result has an answer to this pair of its own. */
static bool is_named(const struct walk *walk, const struct fmb_client_answer *answer)
{
    const struct scene_result *result = &recorded.scene;
    return walk->verdict < result->verdict_count &&
           (!result->names_pairs || (result->pair[walk->verdict][0] == answer->a &&
                                     result->pair[walk->verdict][1] == answer->b));
}

static void on_scene_pair(void *user, const struct fmb_client_answer *answer)
{
    const struct scene_query *query = &found.query.scene;
    struct walk *walk = user;
    const int32_t number = query->first_pair + walk->pair++;
    if (query->which == FMB_PAIRS_LISTED) {
        assert_int_equal(answer->a, query->pair[number][0]);
        assert_int_equal(answer->b, query->pair[number][1]);
    }
    if (number >= recorded.scene.end_pair)
        return;
    walk->compared++;
    if (!is_named(walk, answer)) {
        assert_int_equal(answer->answer.verdict, FMB_SEPARATED);
        return;
    }
    assert_int_equal(answer->answer.verdict, recorded.scene.verdict[walk->verdict++]);
    if (answer->answer.verdict == FMB_SEPARATED)
        return;
    assert_contact(walk, answer, walk->dim);
    walk->contact++;
}

static void on_pair(void *user, const struct fmb_client_answer *answer)
{
    const struct fmb_answer *then = &recorded.pair.answer, *now = &answer->answer;
    struct walk *walk = user;
    walk->compared++;
    assert_int_equal(now->verdict, then->verdict);
    assert_int_equal(now->has_contact, then->has_contact);
    assert_true(!then->has_contact || same_bits(now->contact, then->contact, 2));
    for (int side = 0; side < 2 && then->has_box; side++)
        assert_true(same_bits(now->box[side], then->box[side], (size_t) walk->dim));
}

static int64_t decide_found(void)
{
    const bool is_pair = found.query.kind == LOG_PAIR_QUERY;
    struct owned_scene scene = scene_of_found();
    struct walk walk = {.dim = scene.dim};
    scene.scene.method =
        fmb_method_by_number(is_pair ? found.query.pair.method : found.query.scene.method);
    scene.scene.want = FMB_WANT_BOX;
    answers_local(&scene, is_pair ? on_pair : on_scene_pair, &walk);
    if (!is_pair)
        assert_int_equal(walk.verdict, recorded.scene.verdict_count);
    scene_clear(&scene);
    return walk.compared;
}

/* ---- Worlds ---- */

static struct match_key key_of(const struct world_event *event, enum log_kind *kind)
{
    const struct log_channels channels = log_channels("");
    const struct log_event logged = {.channel = event->channel,
                                     .channel_length = strlen(event->channel),
                                     .data = event->bytes,
                                     .size = event->size,
                                     .kept = event->size};
    struct match_key key;
    *kind = log_kind_of(&channels, &logged);
    if (match_key_of(*kind, &logged, &key)) {
        *kind = LOG_OTHER;
        key.client_id = -1;
    }
    return key;
}

/* The result of an event's ids, which says that they were decided. */
static bool read_recorded(const struct world_event *event, enum log_kind kind)
{
    if (kind == LOG_PAIR_RESULT)
        return !wire_read_pair_result(event->bytes, (uint32_t) event->size, &recorded.pair) &&
               recorded.pair.status == FMB_OK;
    return !wire_read_scene_result(event->bytes, (uint32_t) event->size, &recorded.scene) &&
           recorded.scene.status == FMB_OK;
}

/* The query that a result has, by the number of its event. */
static int64_t query_by_result(size_t event, const struct match_key *ids)
{
    const struct log_query_options by_number = {.event = (int64_t) event};
    if (look_for(by_number) != LOG_QUERY_FOUND)
        return 0;
    assert_int_equal(found.key.client_id, ids->client_id);
    assert_int_equal(found.key.sequence_number, ids->sequence_number);
    const int64_t compared = decide_found();

    /* The same query, by the number of its own event. */
    const int64_t offset = found.offset, number = found.number;
    const struct log_query_options by_own_number = {.event = number};
    assert_int_equal(look_for(by_own_number), LOG_QUERY_FOUND);
    assert_int_equal(found.offset, offset);
    assert_int_equal(decide_found(), compared);
    return compared;
}

static int64_t query_world(const struct log_world *world)
{
    int64_t compared = 0;
    for (size_t i = 0; i < world->count; i++) {
        enum log_kind kind;
        const struct match_key ids = key_of(&world->event[i], &kind);
        if (log_kind_is_result(kind) && read_recorded(&world->event[i], kind))
            compared += query_by_result(i, &ids);
    }
    return compared;
}

static void single_queries_have_the_same_answers(void **state)
{
    struct log_world world;
    const struct world_options options = {.seed = 11, .steps = getenv("FMB_FAST") ? 15 : 60};
    world_make(&options, &world);
    world_write(&world, path);
    assert_true(query_world(&world) > 50);
    log_world_clear(&world);
}

static void large_scenes_have_the_same_answers(void **state)
{
    struct log_world world;
    world_make_large(700, 1, &world);
    world_write(&world, path);
    assert_true(query_world(&world) >= 700 * 699 / 2);
    log_world_clear(&world);
}

/* Where the scenes that have the bodies whole are not in the log. */
static void undefined_handles_are_reported(void **state)
{
    struct log_world world;
    world_make_large(300, 1, &world);
    const struct log_world late = {.event = world.event + 2, .count = 2};
    world_write(&late, path);
    const struct log_query_options first = {.event = 0};
    assert_int_equal(look_for(first), LOG_QUERY_NONE);
    world_write(&world, path);
    const struct log_query_options third = {.event = 2};
    assert_int_equal(look_for(third), LOG_QUERY_FOUND);
    log_world_clear(&world);
}

/* ---- What is not there ---- */

static void what_is_not_there_is_not_found(void **state)
{
    struct log_world world = {.state = 1};
    unsigned char geometry[2][GEOMETRY_FRAME_BYTES_MAX];
    const struct pair_query query = {
        .client_id = 3,
        .sequence_number = 4,
        .placement = {sample_placement(0, geometry[0]), sample_placement(6, geometry[1])}};
    static unsigned char bytes[QUERY_BYTES_MAX];
    world_add(&world, WIRE_PAIR_QUERY, bytes, wire_write_pair_query(&query, bytes));
    world_add(&world, "CAMERA", "image", 5);
    world_add(&world, WIRE_PAIR_QUERY, "no query", 8);
    world_write(&world, path);
    const struct log_query_options ways[] = {
        {.event = 1},
        {.event = 2},
        {.event = 3},
    };
    for (size_t i = 0; i < COUNT(ways); i++)
        assert_int_equal(look_for(ways[i]), LOG_QUERY_NONE);
    log_world_clear(&world);
    assert_int_equal(truncate(path, 0), 0);
    assert_int_equal(look_for(ways[0]), LOG_QUERY_NONE);
}

/* ---- Queries of equal ids ---- */

static void add_query(struct log_world *world, int64_t utime, double duration)
{
    unsigned char geometry[2][GEOMETRY_FRAME_BYTES_MAX];
    static unsigned char bytes[QUERY_BYTES_MAX];
    const struct pair_query query = {
        .utime = utime,
        .client_id = 3,
        .sequence_number = 4,
        .duration = duration,
        .placement = {sample_placement(0, geometry[0]), sample_placement(0, geometry[1])}};
    world_add(world, WIRE_PAIR_QUERY, bytes, wire_write_pair_query(&query, bytes));
}

static void add_result(struct log_world *world, int64_t utime)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    const struct pair_result result = {
        .utime = utime, .client_id = 3, .sequence_number = 4, .answer.verdict = FMB_SEPARATED};
    world_add(world, WIRE_PAIR_RESULT, bytes, wire_write_pair_result(&result, bytes));
}

static void a_result_has_the_query_of_its_time(void **state)
{
    const struct log_query_options by_result = {.event = 3};
    struct log_world world = {.state = 1};
    add_query(&world, 1000, 1);
    add_query(&world, 1000, 2);
    add_query(&world, 2000, 3);
    add_result(&world, 2000);
    world_write(&world, path);
    assert_int_equal(look_for(by_result), LOG_QUERY_FOUND);
    assert_int_equal(found.number, 2);
    log_world_clear(&world);
}

/* ---- Scenes ---- */

static unsigned char geometry_bytes[GEOMETRY_FRAME_BYTES_MAX];

/* One body with these components, at rest at the origin. */
static struct query_placement place(int64_t id, const double *components)
{
    struct plain_frame frame = {.shape = FMB_CUBOID};
    memcpy(frame.components, components, 9 * sizeof *components);
    return (struct query_placement){.placed.id = id,
                                    .body = geometry_write(3, &frame, geometry_bytes)};
}

/* Placements of unit cubes with these ids. */
static void set_placements(const int64_t *ids, int count)
{
    static const double unit[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    log_query_clear(&found);
    memset(&found, 0, sizeof found);
    found.query.kind = LOG_SCENE_QUERY;
    found.query.placement = found.query.scene.placement;
    found.query.placement_count = found.query.scene.placement_count = count;
    found.query.scene.duration = 0.25;
    for (int i = 0; i < count; i++)
        found.query.scene.placement[i] = place(ids[i], unit);
}

static void bodies_get_ids_that_are_free(void **state)
{
    const int64_t ids[] = {0, 1, 1, 0, 3, QUERY_ID_MAX, QUERY_ID_MAX, 5};
    const int64_t expected[] = {2, 1, 4, 6, 3, QUERY_ID_MAX, 7, 5};
    set_placements(ids, 8);
    found.query.scene.which = FMB_PAIRS_ALL;
    struct owned_scene scene = scene_of_found();
    assert_int_equal(scene.scene.which, FMB_PAIRS_ALL);
    for (int i = 0; i < 8; i++)
        assert_int_equal(scene.scene.placements[i].id, expected[i]);
    scene_clear(&scene);
}

static void assert_pairs(const size_t (*expected)[2], size_t count)
{
    struct owned_scene scene = scene_of_found();
    struct pair_cursor cursor = {0};
    unsigned pair[2];
    for (size_t k = 0; k < count; k++) {
        assert_true(scene_next_pair(&scene, &cursor, pair));
        assert_int_equal(pair[0], expected[k][0]);
        assert_int_equal(pair[1], expected[k][1]);
    }
    assert_false(scene_next_pair(&scene, &cursor, pair));
    scene_clear(&scene);
}

static void pairs_are_those_of_the_query(void **state)
{
    const int64_t ids[] = {4, 3, 2, 1};
    set_placements(ids, 4);
    found.query.scene.which = FMB_PAIRS_ACROSS;
    found.query.scene.split = 2;
    assert_pairs((const size_t[][2]){{0, 2}, {0, 3}, {1, 2}, {1, 3}}, 4);
    found.query.scene.first_pair = 3;
    assert_pairs((const size_t[][2]){{1, 3}}, 1);
    found.query.scene.which = FMB_PAIRS_ALL;
    found.query.scene.split = 0;
    assert_pairs((const size_t[][2]){{1, 2}, {1, 3}, {2, 3}}, 3);
    found.query.scene.first_pair = 0;
    assert_pairs((const size_t[][2]){{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}, 6);
    found.query.scene.which = FMB_PAIRS_LISTED;
    assert_pairs(NULL, 0);
    found.query.scene.index_count = 4;
    memcpy(found.query.scene.pair, (unsigned[2][2]){{3, 0}, {0, 3}}, 4 * sizeof(unsigned));
    assert_pairs((const size_t[][2]){{3, 0}, {0, 3}}, 2);
}

static void numbers_read_back_as_the_same_bits(void **state)
{
    static const double numbers[9] = {-0.0, 5e-324, DBL_MAX,  -DBL_MIN,          1.0 / 3,
                                      1e23, 0.1,    -2.5e-17, 9007199254740993.0};
    const int64_t ids[] = {1, 2};
    set_placements(ids, 2);
    struct query_placement *placement = &found.query.scene.placement[1];
    *placement = place(2, numbers);
    memcpy(placement->placed.position, numbers, 3 * sizeof *numbers);
    memcpy(placement->placed.velocity, numbers + 3, 3 * sizeof *numbers);
    placement->velocity_count = 3;
    found.query.placement_count = found.query.scene.placement_count = 1;
    found.query.scene.placement[0] = *placement;
    found.query.scene.duration = 5e-324;
    struct owned_scene scene = scene_of_found();
    const struct fmb_placement *placed = &scene.scene.placements[0];
    assert_true(same_bits(&fmb_body_frame(placed->body, 0)->component[0][0], numbers, 9));
    assert_true(same_bits(placed->position, numbers, 3));
    assert_true(same_bits(placed->velocity, numbers + 3, 3));
    assert_true(scene.scene.duration == 5e-324);
    scene_clear(&scene);
}

/* Names, groups, the label, and frames by vertices are printed, and read as the same. */
static void names_groups_and_vertices_are_kept(void **state)
{
    static unsigned char bytes[3][GEOMETRY_FRAME_BYTES_MAX];
    const int64_t ids[] = {1, 2, 3};
    const struct plain_frame face = {.shape = FMB_FACE,
                                     .by_vertices = true,
                                     .origin = {0.1, -0.0, 0},
                                     .components = {1e16, 0, 0, 0, 1, 3}};
    set_placements(ids, 3);
    struct scene_query *query = &found.query.scene;
    query->label = "shelf \xe2\x82\xac";
    for (int i = 0; i < 3; i++) {
        query->placement[i] =
            (struct query_placement){.placed.id = i + 1, .body.dim = 3, .body.frame_count = 1};
        query->placement[i].body = geometry_write(3, &face, bytes[i]);
    }
    query->placement[0].placed.name = "arm";
    query->placement[0].placed.group = query->placement[2].placed.group = INT64_C(-4);
    struct owned_scene scene = scene_of_found();
    assert_string_equal(scene.scene.label, query->label);
    assert_string_equal(scene.scene.placements[0].name, "arm");
    assert_int_equal(scene.scene.placements[2].group, -4);
    assert_int_equal(scene_count_pairs(&scene), 2);
    double numbers[FMB_FRAME_NUMBERS_MAX];
    bool by_vertices;
    assert_int_equal(fmb_frame_numbers(fmb_body_frame(scene.scene.placements[1].body, 0),
                                       &by_vertices, numbers, COUNT(numbers)),
                     9);
    assert_memory_equal(numbers, face.origin, sizeof face.origin);
    assert_memory_equal(numbers + (by_vertices ? 3 : 0), face.components, sizeof *numbers);
    scene_clear(&scene);
    query->label = "a\nb";
    scene = scene_of_found();
    assert_null(scene.scene.label);
    query->label = NULL;
    scene_clear(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(single_queries_have_the_same_answers),
        cmocka_unit_test(large_scenes_have_the_same_answers),
        cmocka_unit_test(undefined_handles_are_reported),
        cmocka_unit_test(what_is_not_there_is_not_found),
        cmocka_unit_test(a_result_has_the_query_of_its_time),
        cmocka_unit_test(bodies_get_ids_that_are_free),
        cmocka_unit_test(pairs_are_those_of_the_query),
        cmocka_unit_test(numbers_read_back_as_the_same_bits),
        cmocka_unit_test(names_groups_and_vertices_are_kept),
    };
    return cmocka_run_group_tests(tests, make_path, remove_path);
}
