/* A query of a log as a scene, read back from its JSON: the same bodies and pairs, to the bit. */
#include "unit.h"

#include "geometry_write.h"
#include "json.h"
#include "logged_query.h"
#include "scene_json.h"

#include <float.h>

static struct logged_query query;

/* The scene, through its text. To be cleared. */
static struct owned_scene scene_of_found(void)
{
    struct owned_scene scene, read;
    FILE *text = tmpfile();
    assert_non_null(text);
    scene_of_query(&query, &scene);
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

static bool same_bits(const double *a, const double *b, size_t count)
{
    return memcmp(a, b, count * sizeof *a) == 0;
}

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
    memset(&query, 0, sizeof query);
    query.kind = LOG_SCENE_QUERY;
    query.placement = query.scene.placement;
    query.placement_count = query.scene.placement_count = count;
    query.scene.duration = 0.25;
    for (int i = 0; i < count; i++)
        query.scene.placement[i] = place(ids[i], unit);
}

static void bodies_get_ids_that_are_free(void **state)
{
    const int64_t ids[] = {0, 1, 1, 0, 3, QUERY_ID_MAX, QUERY_ID_MAX, 5};
    const int64_t expected[] = {2, 1, 4, 6, 3, QUERY_ID_MAX, 7, 5};
    set_placements(ids, 8);
    query.scene.which = FMB_PAIRS_ALL;
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
    query.scene.which = FMB_PAIRS_ACROSS;
    query.scene.split = 2;
    assert_pairs((const size_t[][2]){{0, 2}, {0, 3}, {1, 2}, {1, 3}}, 4);
    query.scene.first_pair = 3;
    assert_pairs((const size_t[][2]){{1, 3}}, 1);
    query.scene.which = FMB_PAIRS_ALL;
    query.scene.split = 0;
    assert_pairs((const size_t[][2]){{1, 2}, {1, 3}, {2, 3}}, 3);
    query.scene.first_pair = 0;
    assert_pairs((const size_t[][2]){{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}, 6);
    query.scene.which = FMB_PAIRS_LISTED;
    assert_pairs(NULL, 0);
    query.scene.index_count = 4;
    memcpy(query.scene.pair, (unsigned[2][2]){{3, 0}, {0, 3}}, 4 * sizeof(unsigned));
    assert_pairs((const size_t[][2]){{3, 0}, {0, 3}}, 2);
}

static void numbers_read_back_as_the_same_bits(void **state)
{
    static const double numbers[9] = {-0.0, 5e-324, DBL_MAX,  -DBL_MIN,          1.0 / 3,
                                      1e23, 0.1,    -2.5e-17, 9007199254740993.0};
    const int64_t ids[] = {1, 2};
    set_placements(ids, 2);
    struct query_placement *placement = &query.scene.placement[1];
    *placement = place(2, numbers);
    memcpy(placement->placed.position, numbers, 3 * sizeof *numbers);
    memcpy(placement->placed.velocity, numbers + 3, 3 * sizeof *numbers);
    placement->velocity_count = 3;
    query.placement_count = query.scene.placement_count = 1;
    query.scene.placement[0] = *placement;
    query.scene.duration = 5e-324;
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
    struct scene_query *of = &query.scene;
    of->label = "shelf \xe2\x82\xac";
    for (int i = 0; i < 3; i++) {
        of->placement[i] =
            (struct query_placement){.placed.id = i + 1, .body.dim = 3, .body.frame_count = 1};
        of->placement[i].body = geometry_write(3, &face, bytes[i]);
    }
    of->placement[0].placed.name = "arm";
    of->placement[0].placed.group = of->placement[2].placed.group = INT64_C(-4);
    struct owned_scene scene = scene_of_found();
    assert_string_equal(scene.scene.label, of->label);
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
    of->label = "a\nb";
    scene = scene_of_found();
    assert_null(scene.scene.label);
    of->label = NULL;
    scene_clear(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_get_ids_that_are_free),
        cmocka_unit_test(pairs_are_those_of_the_query),
        cmocka_unit_test(numbers_read_back_as_the_same_bits),
        cmocka_unit_test(names_groups_and_vertices_are_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
