/* Reading scenes: what is understood, and what is refused, with the place. */

#include "unit.h"

#include "json.h"
#include "number.h"
#include "scene_json.h"
#include "text.h"
#include "turned_box.h"

#include <math.h>
#include <regex.h>
#include <unistd.h>

/* A reader of the text, in a file that is gone with it. */
struct input {
    FILE *file;
    struct json_reader *reader;
};

static struct input open_bytes(const char *bytes, size_t size)
{
    struct input input = {.file = tmpfile()};
    assert_non_null(input.file);
    assert_int_equal(fwrite(bytes, 1, size, input.file), size);
    rewind(input.file);
    input.reader = json_open(fileno(input.file));
    return input;
}

static void close_input(struct input *input)
{
    json_close(input->reader);
    fclose(input->file);
}

/* The error of the first bad scene, until the next call. */
static const char *error_of(const char *bytes, size_t size)
{
    static char error[1024];
    struct input input = open_bytes(bytes, size);
    struct owned_scene scene;
    enum json_outcome outcome;
    while ((outcome = json_next(input.reader, &scene)) == JSON_SCENE)
        scene_clear(&scene);
    assert_int_equal(outcome, JSON_BAD);
    assert_int_equal(scene.scene.placement_count, 0);
    snprintf(error, sizeof error, "%s", json_error(input.reader));
    close_input(&input);
    return error;
}

static void expect_error_in_bytes(const char *bytes, size_t size, const char *error)
{
    assert_string_equal(error_of(bytes, size), error);
}

/* place: with which the error begins, before a colon; or the whole error. */
static void expect_place(const char *text, const char *place)
{
    const char *error = error_of(text, strlen(text));
    const size_t length = strlen(place);
    if (strncmp(error, place, length) != 0 || !strchr(": ", error[length]))
        fail_msg("%s, not %s", error, place);
}

static void expect_error(const char *text, const char *error)
{
    expect_error_in_bytes(text, strlen(text), error);
}

/* The one scene of the text; to be cleared. */
static struct owned_scene read_one(const char *text)
{
    struct input input = open_bytes(text, strlen(text));
    struct owned_scene scene, none;
    enum json_outcome outcome = json_next(input.reader, &scene);
    if (outcome != JSON_SCENE)
        print_message("%s\n", json_error(input.reader));
    assert_int_equal(outcome, JSON_SCENE);
    assert_int_equal(json_next(input.reader, &none), JSON_END);
    close_input(&input);
    return scene;
}

/* splitmix64 */
static uint64_t next_random(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

static void assert_same_bits(const double *a, const double *b, size_t count)
{
    assert_memory_equal(a, b, count * sizeof *a);
}

static void assert_minus_zero(const double *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++)
        assert_true(numbers[i] == 0 && signbit(numbers[i]));
}

/* ---- What is understood ---------------------------------------------------------------------- */

#define CUBE "\"shape\":\"cuboid\",\"origin\":[0,0,0],\"components\":[[1,0,0],[0,1,0],[0,0,1]]"
#define BODY(id) "{\"id\":" #id "," CUBE "}"
#define SCENE(bodies) "{\"dim\":3,\"bodies\":[" bodies "]}"
#define SCENE_PAIRS(pairs) "{\"dim\":3,\"bodies\":[" BODY(1) "," BODY(2) "],\"pairs\":" pairs "}"

static void reads_every_field(void **state)
{
    struct owned_scene scene = read_one(
        "{\"pairs\": [[7,1],[1,7],[7,1]], \"bodies\": ["
        "{\"velocity\": [1,2,3], \"components\": [[1,2,3],[4,5,6],[7,8,-9.5e-1]],"
        " \"origin\": [0.1,-0,1e308], \"shape\": \"tetrahedron\", \"id\": 1},"
        "{\"id\": 7, \"shape\": \"face\", \"origin\": [0,0,0], \"components\": [[1,0,0],[0,1,0]]}],"
        " \"margin\": 1e-9, \"duration\": 2.5, \"dim\": 3}");
    assert_int_equal(scene.dim, 3);
    assert_true(scene.scene.duration == 2.5);
    assert_true(scene.scene.margin == 1e-9);
    assert_int_equal(scene.scene.placement_count, 2);
    assert_int_equal(scene.scene.placements[0].id, 1);
    const struct fmb_frame *frame = fmb_body_frame(scene.scene.placements[0].body, 0);
    assert_int_equal(frame->shape, FMB_TETRAHEDRON);
    assert_true(scene.scene.placements[0].velocity[2] == 3);
    assert_true(scene.scene.placements[0].position[0] == 0.1 &&
                signbit(scene.scene.placements[0].position[1]));
    assert_true(frame->component[2][2] == -0.95 && frame->origin[0] == 0);
    assert_int_equal(fmb_body_frame(scene.scene.placements[1].body, 0)->shape, FMB_FACE);
    assert_true(scene.scene.placements[1].velocity[0] == 0);
    assert_int_equal(scene.scene.placements[1].orientation_count, 0);
    assert_int_equal(scene.scene.which, FMB_PAIRS_LISTED);
    assert_int_equal(scene.scene.pair_count, 3);
    assert_int_equal(scene.scene.pairs[0][0], 1);
    assert_int_equal(scene.scene.pairs[1][0], 0);
    scene_clear(&scene);
}

static void reads_poses_frames_names_and_ignored_pairs(void **state)
{
    struct owned_scene scene = read_one(
        "{\"dim\": 3, \"bodies\": ["
        "{\"id\": 1, \"name\": \"\\u00e4<\", \"shape\": \"box\", \"size\": [2,0,0.5], "
        "\"position\": [1,2,3]},"
        "{\"id\": 2, \"orientation\": [1,0,0,-2], \"velocity\": [0,0,-1], \"frames\": ["
        "{\"shape\": \"box\", \"size\": [1,2,3], \"position\": [4,5,6]},"
        "{\"shape\": \"box\", \"size\": [1,2,3], \"position\": [4,5,6], \"orientation\": "
        "[1,0,0,1]},"
        "{\"shape\": \"face\", \"origin\": [7,8,9], \"components\": [[1,0,0],[0,1,0]]}]},"
        "{\"id\": 3, \"shape\": \"face\", \"origin\": [7,8,9], \"position\": [1,1,1], "
        "\"components\": [[1,0,0],[0,1,0]]}],"
        "\"ignore\": [[3,2],[1,2],[2,3]]}");
    const struct fmb_frame *box = fmb_body_frame(scene.scene.placements[0].body, 0);
    assert_string_equal(scene.scene.placements[0].name, "\xc3\xa4<");
    assert_int_equal(box->shape, FMB_BOX);
    assert_true(box->component[2][2] == 0.5 && box->centre[0] == 0);
    assert_true(scene.scene.placements[0].position[2] == 3);
    assert_int_equal(scene.scene.placements[1].body->frame_count, 3);
    assert_int_equal(scene.scene.placements[1].orientation_count, 4);
    assert_true(scene.scene.placements[1].orientation[3] == -2 &&
                scene.scene.placements[1].velocity[2] == -1);
    assert_true(fmb_body_frame(scene.scene.placements[1].body, 0)->centre[1] == 5);
    /* Turned by 90 degrees about z. */
    const struct fmb_frame *turned = fmb_body_frame(scene.scene.placements[1].body, 1);
    const double origin[3] = {5, 4.5, 4.5}, component[3][3] = {{0, 1, 0}, {-2, 0, 0}, {0, 0, 3}};
    assert_int_equal(turned->shape, FMB_CUBOID);
    for (int axis = 0; axis < 3; axis++) {
        assert_true(turned->origin[axis] == origin[axis]);
        for (int i = 0; i < 3; i++)
            assert_true(turned->component[i][axis] == component[i][axis]);
    }
    assert_true(fmb_body_frame(scene.scene.placements[1].body, 2)->origin[0] == 7);
    assert_true(fmb_body_frame(scene.scene.placements[2].body, 0)->origin[0] == 7);
    assert_true(scene.scene.placements[2].position[0] == 1);
    assert_int_equal(scene.scene.ignored_count, 3);
    assert_int_equal(scene_count_pairs(&scene), 1);
    struct pair_cursor cursor = {0};
    unsigned pair[2];
    assert_true(scene_next_pair(&scene, &cursor, pair));
    assert_true(pair[0] == 0 && pair[1] == 2);
    assert_false(scene_next_pair(&scene, &cursor, pair));
    scene_clear(&scene);
}

/* Vertices stand in place of origin and components, groups leave pairs out. */
static void reads_vertices_groups_and_labels(void **state)
{
    struct owned_scene scene = read_one(
        "{\"label\": \"shelf \\u20ac\", \"dim\": 3, \"bodies\": ["
        "{\"id\": 1, \"group\": -7, \"shape\": \"tetrahedron\", \"position\": [1,0,0],"
        " \"vertices\": [[0.1,-0,0],[1e16,0,0],[0,1,0],[0,0,1]]},"
        "{\"id\": 2, \"group\": -7, \"frames\": ["
        "{\"shape\": \"face\", \"vertices\": [[0,0,0],[1,0,0],[0,1,0]]},"
        "{\"shape\": \"box\", \"size\": [1,1,1]}]},"
        "{\"id\": 3, \"shape\": \"box\", \"size\": [1,1,1]},"
        "{\"id\": 4, \"group\": 9007199254740991, \"shape\": \"box\", \"size\": [1,1,1]},"
        "{\"id\": 5, \"group\": -7, \"shape\": \"box\", \"size\": [1,1,1]}],"
        "\"ignore\": [[5,1],[3,4]]}");
    struct pair_cursor cursor = {0};
    unsigned pair[2];
    int pairs = 0;
    assert_string_equal(scene.scene.label, "shelf \xe2\x82\xac");
    const struct fmb_frame *tetrahedron = fmb_body_frame(scene.scene.placements[0].body, 0);
    assert_int_equal(tetrahedron->shape, FMB_TETRAHEDRON);
    assert_true(tetrahedron->component[0][0] == 1e16 && tetrahedron->remainder[0][0] == -0.1);
    assert_true(signbit(tetrahedron->origin[1]));
    assert_true(scene.scene.placements[0].position[0] == 1);
    assert_int_equal(scene.scene.placements[1].body->frame_count, 2);
    assert_int_equal(scene.scene.placements[0].group, -7);
    assert_int_equal(scene.scene.placements[3].group, 9007199254740991);
    while (scene_next_pair(&scene, &cursor, pair)) {
        assert_false(scene_leaves_out(&scene, pair[0], pair[1]));
        pairs++;
    }
    assert_int_equal(pairs, 10 - 3 - 1);
    assert_int_equal(scene_count_pairs(&scene), pairs);
    scene_clear(&scene);
}

/* A body that is a hull, and one with a hull among its frames. Of repeated vertices the first is
 * kept. */
static void reads_hulls(void **state)
{
    struct owned_scene scene = read_one(
        "{\"dim\": 2, \"bodies\": ["
        "{\"id\": 1, \"shape\": \"hull\", \"position\": [1,0], \"orientation\": [1,0],"
        " \"vertices\": [[0,0],[0.1,-0],[0,0],[0,1e300],[0.1,0],[-3,2]]},"
        "{\"id\": 2, \"frames\": [{\"shape\": \"box\", \"size\": [1,1]},"
        "{\"shape\": \"hull\", \"vertices\": [[7,8]]}]}]}");
    const struct fmb_frame *hull = fmb_body_frame(scene.scene.placements[0].body, 0);
    const struct fmb_frame *point = fmb_body_frame(scene.scene.placements[1].body, 1);
    static const double distinct[] = {0, 0, 0.1, 0, 0, 1e300, -3, 2};
    double numbers[12];
    bool by_vertices;
    assert_int_equal(hull->shape, FMB_HULL);
    assert_int_equal(fmb_frame_numbers(hull, &by_vertices, numbers, COUNT(numbers)), 8);
    assert_memory_equal(numbers, distinct, sizeof distinct);
    assert_true(scene.scene.placements[0].position[0] == 1);
    assert_int_equal(fmb_frame_numbers(point, &by_vertices, numbers, COUNT(numbers)), 2);
    assert_true(by_vertices && numbers[0] == 7 && numbers[1] == 8);
    scene_clear(&scene);
}

/* As many vertices as a hull may have, and one more. */
static void hulls_have_a_limit(void **state)
{
    for (int count = FMB_HULL_VERTICES_MAX; count <= FMB_HULL_VERTICES_MAX + 1; count++) {
        char text[32768] = "{\"dim\":2,\"bodies\":[{\"id\":1,\"shape\":\"hull\",\"vertices\":[";
        size_t length = strlen(text);
        for (int i = 0; i < count; i++)
            length += (size_t) snprintf(text + length, sizeof text - length, "%s[%d,%d]",
                                        i ? "," : "", i, i * i % 97);
        snprintf(text + length, sizeof text - length, "]}]}");
        if (count > FMB_HULL_VERTICES_MAX) {
            expect_error_in_bytes(text, strlen(text),
                                  "bodies[0].vertices: expected 1 to 1024 vertices, found 1025");
            continue;
        }
        struct owned_scene scene = read_one(text);
        const struct fmb_frame *hull = fmb_body_frame(scene.scene.placements[0].body, 0);
        assert_int_equal(hull->vertex_count, count);
        scene_clear(&scene);
    }
}

/* Against the same sums in long double; quaternions of any length. */
static void turned_boxes_are_accurate(void **state)
{
    static const int exponents[] = {0, -1060, 1000};
    uint64_t seed = 5;
    for (int i = 0; i < 6000; i++) {
        double q[4], given[4], size[3], origin[3] = {1, 2, 3}, component[9];
        for (int k = 0; k < 4; k++) {
            q[k] = (double) (next_random(&seed) % 2000) - 999.5;
            given[k] = ldexp(q[k], exponents[i % 3]);
        }
        for (int k = 0; k < 3; k++)
            size[k] = (double) (next_random(&seed) % 1000);
        memcpy(component, size, sizeof size);
        turned_box(3, given, origin, component);
        const long double norm = (long double) q[0] * q[0] + (long double) q[1] * q[1] +
                                 (long double) q[2] * q[2] + (long double) q[3] * q[3];
        const long double xy = 2 * ((long double) q[1] * q[2] - (long double) q[0] * q[3]);
        const long double yy = (long double) q[0] * q[0] - (long double) q[1] * q[1] +
                               (long double) q[2] * q[2] - (long double) q[3] * q[3];
        assert_true(fabsl(component[3] - xy * size[1] / norm) <= size[1] * 0x1.8p-50);
        assert_true(fabsl(component[4] - yy * size[1] / norm) <= size[1] * 0x1.8p-50);
        for (int axis = 0; axis < 3; axis++) {
            const double centre = origin[axis] + component[axis] / 2 + component[3 + axis] / 2 +
                                  component[6 + axis] / 2;
            assert_true(fabs(centre - (axis + 1)) <= 0x1p-49 * (3 + size[0] + size[1] + size[2]));
        }
    }
}

static void missing_fields_have_defaults(void **state)
{
    struct owned_scene scene = read_one(SCENE(BODY(3) "," BODY(9007199254740991) "," BODY(5)));
    struct pair_cursor cursor = {0};
    unsigned pair[2];
    static const size_t order[][2] = {{0, 1}, {0, 2}, {1, 2}};
    assert_true(scene.scene.duration == 1);
    assert_true(scene.scene.margin == 0);
    assert_int_equal(scene.scene.which, FMB_PAIRS_ALL);
    assert_int_equal(scene.scene.placements[1].id, INT64_C(9007199254740991));
    assert_int_equal(scene_count_pairs(&scene), 3);
    for (int i = 0; i < 3; i++) {
        assert_true(scene_next_pair(&scene, &cursor, pair));
        assert_int_equal(pair[0], order[i][0]);
        assert_int_equal(pair[1], order[i][1]);
    }
    assert_false(scene_next_pair(&scene, &cursor, pair));
    scene_clear(&scene);
}

/* The first scene is given while the second one has only begun. */
static void a_scene_is_given_when_it_is_complete(void **state)
{
    int end[2];
    struct owned_scene scene;
    static const char text[] = SCENE(BODY(1)) "{\"di";
    assert_int_equal(pipe(end), 0);
    assert_int_equal(write(end[1], text, sizeof text - 1), sizeof text - 1);
    struct json_reader *reader = json_open(end[0]);
    assert_int_equal(json_next(reader, &scene), JSON_SCENE);
    scene_clear(&scene);
    close(end[1]);
    assert_int_equal(json_next(reader, &scene), JSON_BAD);
    assert_string_equal(json_error(reader),
                        "scene 2: line 1, column 107: the input ends within an object");
    json_close(reader);
    close(end[0]);
}

/* ---- Numbers --------------------------------------------------------------------------------- */

static double read_number_back(const char *number)
{
    char text[1024];
    snprintf(text, sizeof text,
             "{\"dim\":2,\"bodies\":[{\"id\":1,\"shape\":\"cuboid\",\"origin\":[%s,0],"
             "\"components\":[[1,0],[0,1]]}]}",
             number);
    struct owned_scene scene = read_one(text);
    double value = scene.scene.placements[0].position[0];
    scene_clear(&scene);
    return value;
}

static void doubles_come_back_bit_for_bit(void **state)
{
    uint64_t seed = 1;
    char text[NUMBER_TEXT_MAX];
    for (int i = 0; i < 20000; i++) {
        uint64_t bits = next_random(&seed);
        double value, back;
        memcpy(&value, &bits, sizeof value);
        if (!isfinite(value))
            continue;
        back = strtod(number_exact(value, text), NULL);
        assert_memory_equal(&value, &back, sizeof value);
        if (i % 100 != 0)
            continue;
        back = read_number_back(text);
        assert_memory_equal(&value, &back, sizeof value);
    }
}

static void numbers_are_written_short(void **state)
{
    static const struct {
        double value;
        const char *text;
    } cases[] = {{0, "0"},
                 {1, "1"},
                 {-0.5, "-0.5"},
                 {0.1, "0.1"},
                 {1e300, "1e+300"},
                 {0.1 + 0.2, "0.30000000000000004"},
                 {5e-324, "4.94065645841247e-324"},
                 {INFINITY, "null"},
                 {NAN, "null"}};
    char text[NUMBER_TEXT_MAX];
    for (size_t i = 0; i < COUNT(cases); i++)
        assert_string_equal(number_exact(cases[i].value, text), cases[i].text);
    assert_string_equal(number_grouped(-1234567, text), "-1,234,567");
    assert_string_equal(number_grouped(-123, text), "-123");
    assert_string_equal(number_grouped(1000, text), "1,000");
    assert_string_equal(number_grouped(999, text), "999");
}

static void ends_that_differ_look_different(void **state)
{
    static const struct {
        double low, high;
        const char *low_text, *high_text;
    } cases[] = {
        {0.25, 1.0 / 3, "0.25", "0.333333"},
        {5400000.25, 5400000.25, "5400000.25", "5400000.25"},
        {5400000.25, 5400000.75, "5400000.25", "5400000.75"},
        {5400000.25, 5400000.375, "5400000.25", "5400000.375"},
        {1, 1 + 0x1p-52, "1", "1.0000000000000002"},
        {-INFINITY, INFINITY, "-inf", "inf"},
    };
    char low[NUMBER_TEXT_MAX], high[NUMBER_TEXT_MAX];
    for (size_t i = 0; i < COUNT(cases); i++) {
        number_ends(cases[i].low, cases[i].high, low, high);
        assert_string_equal(low, cases[i].low_text);
        assert_string_equal(high, cases[i].high_text);
    }
}

static void assert_same_scenes(const struct owned_scene *a, const struct owned_scene *b)
{
    assert_int_equal(a->dim, b->dim);
    assert_same_bits(&a->scene.duration, &b->scene.duration, 1);
    assert_same_bits(&a->scene.margin, &b->scene.margin, 1);
    assert_int_equal(a->scene.placement_count, b->scene.placement_count);
    for (size_t i = 0; i < a->scene.placement_count; i++) {
        const struct fmb_placement *one = &a->scene.placements[i], *other = &b->scene.placements[i];
        assert_same_bits(one->position, other->position, 3);
        assert_same_bits(one->velocity, other->velocity, 3);
        assert_same_bits(one->orientation, other->orientation, 4);
        assert_int_equal(one->end_count, other->end_count);
        assert_same_bits(one->end_position, other->end_position, 3);
        assert_same_bits(one->end_orientation, other->end_orientation, 4);
        assert_int_equal(one->body->frame_count, other->body->frame_count);
        for (unsigned k = 0; k < one->body->frame_count; k++) {
            const struct fmb_frame *frame = fmb_body_frame(one->body, k),
                                   *same = fmb_body_frame(other->body, k);
            assert_same_bits(frame->origin, same->origin, 3);
            assert_same_bits(frame->centre, same->centre, 3);
            for (int c = 0; c < frame->count; c++)
                assert_same_bits(frame->component[c], same->component[c], 3);
            double numbers[2][FMB_FRAME_NUMBERS_MAX];
            bool by_vertices;
            const size_t count = fmb_frame_numbers(frame, &by_vertices, NULL, 0);
            assert_int_equal(fmb_frame_numbers(same, &by_vertices, NULL, 0), count);
            assert_same_bits(&frame->radius, &same->radius, 1);
            if (count > FMB_FRAME_NUMBERS_MAX)
                continue;
            fmb_frame_numbers(frame, &by_vertices, numbers[0], count);
            fmb_frame_numbers(same, &by_vertices, numbers[1], count);
            assert_same_bits(numbers[0], numbers[1], count);
        }
    }
}

/* Reads a scene, and checks that the bodies are the same after they are written and read again. */
static struct owned_scene read_twice(const char *text)
{
    char *written;
    size_t size;
    struct owned_scene scene = read_one(text);
    FILE *out = open_memstream(&written, &size);
    assert_non_null(out);
    scene_json_write(out, &scene);
    fclose(out);
    struct owned_scene again = read_one(written);
    assert_same_scenes(&scene, &again);
    scene_clear(&again);
    free(written);
    return scene;
}

/* In a scene that is read, written and read again. A size of -0 is 0 in the engine. */
static void the_sign_of_zero_is_kept(void **state)
{
    static const char text[] =
        "{\"dim\": 3, \"duration\": 0.25, \"margin\": 1e-9, \"bodies\": ["
        "{\"id\": 1, \"shape\": \"box\", \"size\": [0,0,0], \"position\": [-0,-0.0,-0e5],"
        " \"orientation\": [1,-0,-0,-0], \"velocity\": [-0,-0,-0]},"
        "{\"id\": 2, \"shape\": \"face\", \"origin\": [-0,-0,-0], \"components\": "
        "[[-0,-0,1],[-0,1,-0]]},"
        "{\"id\": 3, \"position\": [-0,-0,-0], \"velocity\": [-0,-0,-0], \"frames\": ["
        "{\"shape\": \"box\", \"size\": [1,1,1], \"position\": [-0,-0,-0]},"
        "{\"shape\": \"face\", \"origin\": [-0,-0,-0], \"components\": [[-0,-0,1],[-0,1,-0]]}]},"
        "{\"id\": 4, \"shape\": \"face\", \"position\": [-0,1,1], \"origin\": [-0,-0,-0],"
        " \"components\": [[-0,-0,1],[-0,1,-0]], \"end\": {\"position\": [-0,-0,-0],"
        " \"orientation\": [1,-0,-0,-0]}}]}";
    struct owned_scene scene = read_twice(text);
    const struct fmb_placement *body = scene.scene.placements;
    const struct fmb_frame *box = fmb_body_frame(body[2].body, 0),
                           *face = fmb_body_frame(body[2].body, 1);
    assert_minus_zero(body[0].position, 3);
    assert_minus_zero(body[0].orientation + 1, 3);
    assert_minus_zero(body[0].velocity, 3);
    assert_minus_zero(body[1].position, 3);
    assert_minus_zero(fmb_body_frame(body[1].body, 0)->component[0], 2);
    assert_minus_zero(body[2].position, 3);
    assert_minus_zero(box->centre, 3);
    assert_minus_zero(face->origin, 3);
    assert_minus_zero(face->component[1], 1);
    assert_minus_zero(fmb_body_frame(body[3].body, 0)->origin, 3);
    assert_minus_zero(body[3].end_position, 3);
    assert_minus_zero(body[3].end_orientation + 1, 3);
    scene_clear(&scene);
}

/* A position or orientation missing from an end is the same as at the beginning. A body whose end
 * has an orientation also has one at the beginning. */
static void ends_are_read_and_written(void **state)
{
    static const struct {
        const char *members;
        double position, turn[2], end_position, end_turn[2]; /* x; w and z */
        int count;                                           /* numbers of the end */
    } cases[] = {
        {"\"position\": [0.1,0], \"end\": {\"position\": [1e-300,0]}",
         0.1,
         {0, 0},
         1e-300,
         {0, 0},
         2},
        {"\"position\": [0.1,0], \"end\": {\"orientation\": [3,-2]}", 0.1, {1, 0}, 0.1, {3, -2}, 4},
        {"\"orientation\": [2,1], \"end\": {\"position\": [7,0]}", 0, {2, 1}, 7, {2, 1}, 4},
        {"\"orientation\": [2,1], \"end\": {}", 0, {2, 1}, 0, {2, 1}, 4},
        {"\"end\": {}", 0, {0, 0}, 0, {0, 0}, 2},
        {"\"end\": {\"orientation\": [-1,0.1], \"position\": [1,0]}, \"orientation\": [1,1]",
         0,
         {1, 1},
         1,
         {-1, 0.1},
         4},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        char text[300];
        snprintf(text, sizeof text,
                 "{\"dim\": 2, \"bodies\": [{\"id\": 1, \"shape\": \"box\", \"size\": [1,1], %s}]}",
                 cases[i].members);
        struct owned_scene scene = read_twice(text);
        const struct fmb_placement *body = scene.scene.placements;
        assert_int_equal(body->end_count, cases[i].count);
        assert_int_equal(body->orientation_count, cases[i].count - 2);
        assert_same_bits(body->position, &cases[i].position, 1);
        assert_same_bits(body->orientation, cases[i].turn, 2);
        assert_same_bits(body->end_position, &cases[i].end_position, 1);
        assert_same_bits(body->end_orientation, cases[i].end_turn, 2);
        scene_clear(&scene);
    }
    /* Without an orientation, origin is the position of the body, about which it turns. */
    struct owned_scene scene = read_twice(
        "{\"dim\": 3, \"bodies\": [{\"id\": 1, \"shape\": \"cuboid\", \"origin\": [5,0,0], "
        "\"components\": "
        "[[1,0,0],[0,1,0],[0,0,1]], \"end\": {\"orientation_xyzw\": [0,0,2,3]}}]}");
    const struct fmb_placement *body = scene.scene.placements;
    assert_true(body->position[0] == 5 && body->end_position[0] == 5);
    assert_true(fmb_body_frame(body->body, 0)->origin[0] == 0);
    assert_true(body->orientation[0] == 1 && body->end_orientation[0] == 3 &&
                body->end_orientation[3] == 2);
    scene_clear(&scene);
}

/* What is read of a body, after it was written: a radius and the vertices of one hull. */
static void round_shapes_are_read_back(void **state)
{
    static const struct {
        const char *body, *written;
        double radius;
        int count;
        double numbers[6];
    } cases[] = {
        {"\"shape\": \"sphere\", \"radius\": 0.1, \"position\": [1,2,3]",
         "\"shape\": \"sphere\"",
         0.1,
         3,
         {0}},
        {"\"shape\": \"sphere\", \"radius\": 0", "\"shape\": \"hull\"", 0, 3, {0}},
        {"\"frames\": [{\"shape\": \"sphere\", \"radius\": 2, \"position\": [-0,2,3]}]",
         "\"sphere\"",
         2,
         3,
         {0, 2, 3}},
        {"\"shape\": \"capsule\", \"radius\": 2, \"length\": 0",
         "\"shape\": \"sphere\"",
         2,
         3,
         {0}},
        {"\"shape\": \"capsule\", \"radius\": 0, \"length\": 2",
         "\"shape\": \"hull\"",
         0,
         6,
         {0, 0, -1, 0, 0, 1}},
        {"\"shape\": \"capsule\", \"radius\": 2, \"length\": 1.7e308",
         "\"length\": 1.7e+308",
         2,
         6,
         {0, 0, -8.5e307, 0, 0, 8.5e307}},
        {"\"frames\": [{\"shape\": \"capsule\", \"radius\": 1, \"length\": 4, \"position\": "
         "[1,2,3]}]",
         "\"vertices\"",
         1,
         6,
         {1, 2, 1, 1, 2, 5}},
        {"\"frames\": [{\"shape\": \"capsule\", \"radius\": 1, \"length\": 4, \"position\": "
         "[1,2,3], \"orientation\": [1,0,1,0]}]",
         "\"vertices\"",
         1,
         6,
         {-1, 2, 3, 3, 2, 3}},
        {"\"shape\": \"hull\", \"radius\": 7, \"vertices\": [[0,0,1],[0,0,-1]]",
         "\"vertices\"",
         7,
         6,
         {0, 0, 1, 0, 0, -1}},
        {"\"shape\": \"hull\", \"radius\": 7, \"vertices\": [[0,0,-1],[0,0,1]]",
         "\"capsule\"",
         7,
         6,
         {0, 0, -1, 0, 0, 1}},
        {"\"shape\": \"hull\", \"radius\": 7, \"vertices\": [[0,0,-1e308],[0,0,1e308]]",
         "\"vertices\"",
         7,
         6,
         {0, 0, -1e308, 0, 0, 1e308}},
        {"\"frames\": [{\"shape\": \"box\", \"radius\": 5e-324, \"size\": [1,2,3], \"position\": "
         "[1,1,1]}]",
         "\"radius\": 4.94065645841247e-324",
         5e-324,
         6,
         {1, 1, 1, 1, 2, 3}},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        char text[512], *written;
        size_t size;
        double numbers[FMB_FRAME_NUMBERS_MAX];
        bool by_vertices;
        snprintf(text, sizeof text, "{\"dim\": 3, \"bodies\": [{\"id\": 1, %s}]}", cases[i].body);
        struct owned_scene scene = read_one(text);
        const struct fmb_frame *frame = fmb_body_frame(scene.scene.placements[0].body, 0);
        assert_true(frame->radius == cases[i].radius);
        assert_int_equal(fmb_frame_numbers(frame, &by_vertices, numbers, COUNT(numbers)),
                         cases[i].count);
        assert_same_bits(numbers, cases[i].numbers, (size_t) cases[i].count);
        FILE *out = open_memstream(&written, &size);
        assert_non_null(out);
        scene_json_write(out, &scene);
        fclose(out);
        if (!strstr(written, cases[i].written))
            fail_msg("%s: expected %s", written, cases[i].written);
        struct owned_scene again = read_one(written);
        assert_same_scenes(&scene, &again);
        scene_clear(&again);
        scene_clear(&scene);
        free(written);
    }
}

/* In frames too, moved and turned, and of numbers beyond the usual: by the hull's extents. */
static void cylinders_are_enclosed(void **state)
{
    struct owned_scene scene = read_one(
        "{\"dim\": 3, \"bodies\": [{\"id\": 1, \"shape\": \"cylinder\", \"radius\": 2, \"length\": "
        "3},"
        "{\"id\": 2, \"frames\": [{\"shape\": \"cylinder\", \"radius\": 2, \"length\": 3, "
        "\"sides\": 8,"
        " \"position\": [1,2,3], \"orientation\": [1e200,0,1e200,0]}]}]}");
    static const double expected[2][2][3] = {{{-2, -2, -1.5}, {2, 2, 1.5}},
                                             {{-0.5, 0, 1}, {2.5, 4, 5}}};
    for (int body = 0; body < 2; body++) {
        const struct fmb_frame *hull = fmb_body_frame(scene.scene.placements[body].body, 0);
        double numbers[3 * 32];
        bool by_vertices;
        const size_t count = fmb_frame_numbers(hull, &by_vertices, numbers, COUNT(numbers));
        assert_int_equal(count, body ? 3 * 16 : 3 * 32);
        assert_true(hull->radius == 0);
        for (int axis = 0; axis < 3; axis++) {
            double low = INFINITY, high = -INFINITY;
            for (size_t i = 0; i < count; i += 3) {
                low = fmin(low, numbers[i + axis]);
                high = fmax(high, numbers[i + axis]);
            }
            assert_true(low <= expected[body][0][axis] && low >= expected[body][0][axis] - 1e-12);
            assert_true(high >= expected[body][1][axis] && high <= expected[body][1][axis] + 1e-12);
        }
    }
    assert_true(fabs(scene.outside - 2 * (1 / cos(acos(-1) / 8) - 1)) < 1e-12);
    scene_clear(&scene);
}

/* A name stands for the id of the only body that has it. */
static void pairs_may_have_names(void **state)
{
    struct owned_scene scene = read_one(
        "{\"dim\":3,\"bodies\":[{\"id\":7,\"name\":\"a\"," CUBE "},{\"id\":8,\"name\":\"b\"," CUBE
        "},{\"id\":9,\"name\":\"b\"," CUBE "},{\"id\":1,\"name\":\"8\"," CUBE
        "}],"
        "\"ignore\":[[\"a\",9],[8,\"8\"]]}");
    assert_true(scene_leaves_out(&scene, 0, 2) && scene_leaves_out(&scene, 1, 3));
    assert_int_equal(scene_count_pairs(&scene), 4);
    scene_clear(&scene);
}

/* cJSON up to 1.7.15-1+deb12u2 refuses numbers of more than 63 characters. */
static void long_numbers_are_read_in_full(void **state)
{
    char text[512];
    snprintf(text, sizeof text, "0.1%0200d", 1);
    assert_true(read_number_back(text) == 0.1);
    snprintf(text, sizeof text, "-0.%0100de100", 25);
    assert_true(read_number_back(text) == -25);
    /* Halfway between two doubles, but for the last digit. */
    assert_true(read_number_back("1.00000000000000011102230246251565404236316680908203125000000000"
                                 "000000000000000000000000000000001") == 1 + 0x1p-52);
    snprintf(text, sizeof text, "{\"dim\":2,\"duration\":1%0150d%0170d,\"bodies\":[]}", 0, 0);
    expect_error(text,
                 "duration: expected a finite number, found infinity (doubles end at 1.8e308)");
}

/* ---- What is refused ------------------------------------------------------------------------- */

#define ROUND(shape, more) "{\"id\":1,\"radius\":1,\"shape\":\"" shape "\"," more "}"

#define VERTICES(x) "{\"shape\":\"face\",\"vertices\":[[-" x ",0,0],[" x ",1,0],[0,1,1]]}"

static const struct {
    const char *text, *place; /* or the whole error */
} bad_scenes[] = {
    {"{}", "missing key \"dim\""},
    {"{\"dim\":3}", "missing key \"bodies\""},
    {"{\"bodies\":[]}", "missing key \"dim\""},
    {"{\"dim\":3,\"bodies\":[],\"Pairs\":[]}", "unknown key \"Pairs\""},
    {"{\"dim\":3,\"bodies\":[],\"dim\":3}", "repeated key \"dim\""},
    {"{\"dim\":3,\"bodies\":[],\"a\\u001bb\\nc\":[]}", "unknown key \"a?b?c\""},
    {"{\"dim\":3,\"a\xc2\x9b"
     "1m\xff\":1}",
     "unknown key \"a??1m?\""},
    {"{\"dim\":3,\"aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa\":1}",
     "unknown key \"aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa...\""},
    {"{\"dim\":4,\"bodies\":[]}", "dim"},
    {"{\"dim\":2.5,\"bodies\":[]}", "dim"},
    {"{\"dim\":\"3\",\"bodies\":[]}", "dim"},
    {"{\"dim\":null,\"bodies\":[]}", "dim"},
    {"{\"dim\":3,\"duration\":-1,\"bodies\":[]}", "duration"},
    {"{\"dim\":3,\"duration\":1e999,\"bodies\":[]}", "duration"},
    {"{\"dim\":3,\"duration\":true,\"bodies\":[]}", "duration"},
    {"{\"dim\":3,\"margin\":-1e-300,\"bodies\":[]}", "margin"},
    {"{\"dim\":3,\"bodies\":{}}", "bodies"},
    {SCENE("1"), "bodies[0]"},
    {SCENE("{}"), "bodies[0]"},
    {SCENE(BODY(1) ",{\"id\":2,\"shape\":\"cuboid\",\"origin\":[0,0,0]}"), "bodies[1]"},
    {SCENE("{\"id\":2,\"mass\":1," CUBE "}"), "bodies[0]"},
    {SCENE("{\"id\":2,\"id\":2," CUBE "}"), "bodies[0]"},
    {SCENE(BODY(0)), "bodies[0].id"},
    {SCENE(BODY(-1)), "bodies[0].id"},
    {SCENE(BODY(1.5)), "bodies[0].id"},
    {SCENE(BODY(9007199254740992)), "bodies[0].id"},
    {SCENE(BODY("1")), "bodies[0].id"},
    {SCENE(BODY(1) "," BODY(2) "," BODY(1)), "bodies[2].id"},
    {SCENE(ROUND("sphere", "\"origin\":[0,0,0]")), "bodies[0]: a sphere has no \"origin\""},
    {SCENE(ROUND("sphere", "\"vertices\":[[0,0,0]]")), "bodies[0]: a sphere has no \"vertices\""},
    {SCENE(ROUND("sphere", "\"length\":1")), "bodies[0]: a sphere has no \"length\""},
    {SCENE(ROUND("capsule", "\"size\":[1,1,1]")), "bodies[0]: a capsule has no \"size\""},
    {SCENE(ROUND("capsule", "\"id\":2")), "bodies[0]: repeated key \"id\""},
    {SCENE(ROUND("capsule", "\"group\":2")), "bodies[0]: missing key \"length\""},
    {SCENE(ROUND("capsule", "\"length\":-1")),
     "bodies[0].length: expected a number of at least 0, found -1"},
    {SCENE(ROUND("capsule", "\"length\":1,\"sides\":4")), "bodies[0]: a capsule has no \"sides\""},
    {SCENE(ROUND("cylinder", "\"length\":1,\"sides\":6")),
     "bodies[0].sides: expected a multiple of 4 up to 512, found 6"},
    {SCENE(ROUND("cylinder", "\"length\":1,\"sides\":0")), "bodies[0].sides"},
    {SCENE(ROUND("cylinder", "\"length\":1,\"sides\":516")), "bodies[0].sides"},
    {"{\"dim\":2,\"bodies\":[" ROUND("cylinder", "\"length\":1") "]}",
     "bodies[0].shape: there is no cylinder in 2D"},
    {SCENE("{\"id\":1,\"shape\":\"sphere\"}"), "bodies[0]: missing key \"radius\""},
    {SCENE("{\"id\":1,\"radius\":-5e-324," CUBE "}"), "bodies[0].radius"},
    {SCENE("{\"id\":1,\"radius\":NaN," CUBE "}"), "line 1, column"},
    {SCENE("{\"id\":1,\"radius\":1,\"frames\":[]}"),
     "bodies[0]: a body of \"frames\" has no \"radius\""},
    {SCENE("{\"id\":1,\"length\":1," CUBE "}"),
     "bodies[0]: a frame of components has no \"length\""},
    {SCENE("{\"id\":1,\"frames\":[{\"shape\":\"sphere\",\"radius\":1,"
           "\"orientation\":[1,0,0,0]}]}"),
     "bodies[0].frames[0]: a sphere has no \"orientation\""},
    {SCENE("{\"id\":1,\"frames\":[{\"shape\":\"capsule\",\"radius\":1,\"length\":1.7e308,"
           "\"position\":[0,0,1.7e308]}]}"),
     "bodies[0].frames: not a finite number"},
    {SCENE(ROUND("cylinder",
                 "\"length\":1,\"orientation\":[1,0,0,0],"
                 "\"orientation_xyzw\":[0,0,0,1]")),
     "bodies[0]: both \"orientation\" and \"orientation_xyzw\""},
    {SCENE(ROUND("sphere", "\"orientation_xyzw\":[0,0,0,0]")), "bodies[0].orientation_xyzw"},
    {"{\"dim\":2,\"bodies\":[" ROUND("sphere", "\"orientation_xyzw\":[0,1]") "]}",
     "bodies[0].orientation_xyzw: in 2D use \"orientation\""},
    {SCENE("{\"id\":1,\"shape\":\"cuboids\",\"origin\":[0,0,0],\"components\":[]}"),
     "bodies[0].shape"},
    {SCENE("{\"id\":1,\"shape\":1,\"origin\":[0,0,0],\"components\":[]}"), "bodies[0].shape"},
    {"{\"dim\":2,\"bodies\":[{\"id\":1,\"shape\":\"face\",\"origin\":[0,0],"
     "\"components\":[[1,0],[0,1]]}]}",
     "bodies[0].shape"},
    {SCENE("{\"id\":1,\"shape\":\"cuboid\",\"origin\":[0,0],\"components\":[]}"),
     "bodies[0].origin"},
    {SCENE("{\"id\":1,\"shape\":\"cuboid\",\"origin\":[0,\"0\",0],\"components\":[]}"),
     "bodies[0].origin[1]"},
    {SCENE("{\"id\":1,\"shape\":\"cuboid\",\"origin\":[0,0,-1e999],\"components\":[]}"),
     "bodies[0].origin[2]"},
    {SCENE("{\"id\":1,\"shape\":\"cuboid\",\"origin\":[0,0,0],\"components\":[[1,0,0],[0,1]]}"),
     "bodies[0].components"},
    {SCENE(BODY(1) "," BODY(2) "," BODY(3) ",{\"id\":4,\"shape\":\"cuboid\",\"origin\":[0,0,0],"
                                           "\"components\":[[1,0,0],[0,1],[0,0,1]]}"),
     "bodies[3].components[1]"},
    {SCENE("{\"id\":1,\"shape\":\"face\",\"origin\":[0,0,0],\"components\":[[1,0,0],[0,1,0],"
           "[0,0,1]]}"),
     "bodies[0].components"},
    {SCENE("{\"id\":1,\"shape\":\"cuboid\",\"origin\":[0,0,0],\"components\":[[1,0,0],[0,1,0],"
           "[0,0,{}]]}"),
     "bodies[0].components[2][2]"},
    {SCENE("{\"id\":1,\"velocity\":[0,0]," CUBE "}"), "bodies[0].velocity"},
    {SCENE(BODY(1) "," BODY(2) "," BODY(3) ",{\"id\":4,\"end\":{\"orientation\":[0,0,0,1]}," CUBE
                                           "}"),
     "bodies[3].end.orientation"},
    {SCENE("{\"id\":1,\"end\":{\"orientation\":[5,0,0,0]}," CUBE "}"),
     "bodies[0].end.orientation: half a turn away, which takes two windows, or not from 1/4"},
    {SCENE("{\"id\":1,\"end\":{\"orientation_xyzw\":[0,0,0,0.2]}," CUBE "}"),
     "bodies[0].end.orientation_xyzw: half a turn"},
    {SCENE("{\"id\":1,\"end\":{\"orientation\":[0,0,0,0]}," CUBE "}"),
     "bodies[0].end.orientation: a quaternion of zeros"},
    {SCENE("{\"id\":1,\"end\":{\"orientation\":[1,0,0,1e-70]}," CUBE "}"),
     "bodies[0].end.orientation: the numbers differ in size"},
    {SCENE("{\"id\":1,\"end\":{\"orientation\":[1,0,0,1e999]}," CUBE "}"),
     "bodies[0].end.orientation[3]"},
    {SCENE("{\"id\":1,\"end\":{\"position\":[1,0,1e999]}," CUBE "}"), "bodies[0].end.position[2]"},
    {SCENE("{\"id\":1,\"end\":{\"velocity\":[1,0,0]}," CUBE "}"),
     "bodies[0].end: unknown key \"velocity\" (there are position, orientation, orientation_xyzw)"},
    {SCENE("{\"id\":1,\"end\":{\"orientation\":[1,0,0,0],\"orientation_xyzw\":[0,0,0,1]}," CUBE
           "}"),
     "bodies[0].end: both \"orientation\" and \"orientation_xyzw\""},
    {SCENE("{\"id\":1,\"end\":[0,0,1]," CUBE "}"), "bodies[0].end"},
    {SCENE("{\"id\":1,\"end\":{},\"velocity\":[0,0,0]," CUBE "}"),
     "bodies[0]: both \"velocity\" and \"end\""},
    {SCENE("{\"id\":1,\"frames\":[{\"end\":{},\"shape\":\"sphere\",\"radius\":1}]}"),
     "bodies[0].frames[0]: unknown key \"end\""},
    {"{\"dim\":3,\"bodies\":[{\"id\":1,\"end\":{}," CUBE "}],\"duration\":0}",
     "bodies[0].end: \"duration\" is 0"},
    {SCENE_PAIRS("{}"), "pairs"},
    {"{\"label\":\"a\\n\",\"dim\":3,\"bodies\":[]}", "label"},
    {"{\"label\":7,\"dim\":3,\"bodies\":[]}", "label"},
    {SCENE("{\"id\":1,\"group\":0," CUBE "}"), "bodies[0].group"},
    {SCENE("{\"id\":1,\"group\":0.5," CUBE "}"), "bodies[0].group"},
    {SCENE("{\"id\":1,\"group\":9007199254740992," CUBE "}"), "bodies[0].group"},
    {SCENE("{\"id\":1,\"group\":\"a\"," CUBE "}"), "bodies[0].group"},
    {"{\"dim\":3,\"bodies\":[{\"id\":1,\"group\":5," CUBE "},{\"id\":2,\"group\":5," CUBE
     "}],\"pairs\":[[2,1]]}",
     "pairs[0]"},
    {SCENE("{\"id\":1,\"shape\":\"hull\",\"vertices\":[]}"), "bodies[0].vertices"},
    {SCENE("{\"id\":1,\"shape\":\"hull\",\"vertices\":7}"), "bodies[0].vertices"},
    {SCENE("{\"id\":1,\"shape\":\"hull\",\"vertices\":[[0,0,0],[0,1e999,0]]}"),
     "bodies[0].vertices[1][1]"},
    {SCENE("{\"id\":1,\"shape\":\"hull\",\"vertices\":[[0,0,0],[0,0]]}"), "bodies[0].vertices[1]"},
    {SCENE("{\"id\":1,\"shape\":\"hull\"}"), "bodies[0]"},
    {SCENE("{\"id\":1,\"shape\":\"hull\",\"vertices\":[[0,0,0]],\"origin\":[0,0,0]}"), "bodies[0]"},
    {SCENE("{\"id\":1,\"shape\":\"hull\",\"vertices\":[[0,0,0]],\"size\":[1,1,1]}"), "bodies[0]"},
    {SCENE("{\"id\":1,\"frames\":[{\"shape\":\"hull\",\"vertices\":[[0,0,0]],"
           "\"position\":[0,0,0]}]}"),
     "bodies[0].frames[0]"},
    {SCENE("{\"id\":1,\"shape\":\"face\",\"vertices\":[[0,0,0],[1,0,0]]}"), "bodies[0].vertices"},
    {SCENE("{\"id\":1,\"shape\":\"tetrahedron\",\"vertices\":[[0,0,0],[1,0,0],[0,1,0],[0,1]]}"),
     "bodies[0].vertices[3]"},
    {SCENE("{\"id\":1,\"shape\":\"tetrahedron\",\"vertices\":[],\"origin\":[0,0,0]}"), "bodies[0]"},
    {SCENE("{\"id\":1,\"shape\":\"cuboid\",\"vertices\":[]}"), "bodies[0]"},
    {SCENE("{\"id\":1,\"shape\":\"box\",\"size\":[1,1,1],\"vertices\":[]}"), "bodies[0]"},
    {SCENE("{\"id\":1,\"frames\":[{\"shape\":\"face\",\"position\":[0,0,0],"
           "\"vertices\":[[0,0,0],[1,0,0],[0,1,0]]}]}"),
     "bodies[0].frames[0]"},
    {SCENE("{\"id\":1,\"frames\":[" VERTICES("0") "," VERTICES("1e308") "]}"),
     "bodies[0].frames[1]"},
    {SCENE_PAIRS("[1,2]"), "pairs[0]"},
    {SCENE_PAIRS("[[1,2,1]]"), "pairs[0]"},
    {SCENE_PAIRS("[[1,2],[2,3]]"), "pairs[1][1]"},
    {SCENE_PAIRS("[[1,2],[1,1]]"), "pairs[1]"},
    {SCENE_PAIRS("[[1,2.5]]"), "pairs[0][1]"},
    {SCENE_PAIRS("[[1,\"2\"]]"), "pairs[0][1]: no body has the name \"2\""},
    {"{\"dim\":3,\"bodies\":[{\"id\":1,\"name\":\"a\"," CUBE "},{\"id\":2,\"name\":\"b\"," CUBE
     "},{\"id\":3,\"name\":\"a\"," CUBE "}],\"ignore\":[[\"b\",1],[3,\"a\"]]}",
     "ignore[1][1]: bodies[0] and bodies[2] both have the name \"a\": use ids"},
    {"{\"dim\":3,\"bodies\":[{\"id\":1,\"name\":\"a\"," CUBE "}],\"pairs\":[[1,\"a\"]]}",
     "pairs[0]: a body is no pair with itself"},
};

static void bad_scenes_are_refused(void **state)
{
    for (size_t i = 0; i < COUNT(bad_scenes); i++)
        expect_place(bad_scenes[i].text, bad_scenes[i].place);
}

/* Places are cJSON's: of a key that does not begin with a quote, the next byte. */
static const struct {
    const char *text, *error;
} bad_texts[] = {
    {"", "the input is empty: expected a scene"},
    {" \n\t\n", "the input is empty: expected a scene"},
    {"[]", "line 1, column 1: expected an object, '{', found '['"},
    {"null", "line 1, column 1: expected an object, '{', found 'n'"},
    {"\xef\xbb\xbf\xef\xbb\xbf{}", "line 1, column 1: expected an object, '{', found byte 0xef"},
    {"// no\n{}", "line 1, column 1: expected an object, '{', found '/'"},
    {"{", "line 1, column 2: the input ends within an object"},
    {"{\"dim\": 3,\n \"bodies\": []", "line 2, column 14: the input ends within an object"},
    {"{\"}", "line 1, column 4: the input ends within an object"},
    {"{\"\\\"}", "line 1, column 6: the input ends within an object"},
    {"{\"dim\": 3,\n \"bodies\": [}", "line 2, column 13: invalid JSON"},
    {"{\"dim\": 3]", "line 1, column 10: invalid JSON"},
    {"{\"dim\" 3}", "line 1, column 8: invalid JSON"},
    {"{\"dim\": 3,}", "line 1, column 11: invalid JSON"},
    {"{\"\xc3\xa4\": [1,]}", "line 1, column 10: invalid JSON"},
    {"{\"dim\": [1 2]}", "line 1, column 12: invalid JSON"},
    {"{\"dim\": NaN}",
     "line 1, column 9: NaN and Infinity are not JSON, though json.dumps of Python "
     "writes them"},
    {"{\"dim\": [1,\n -Infinity, 2]}",
     "line 2, column 2: NaN and Infinity are not JSON, though "
     "json.dumps of Python writes them"},
    {"{\"dim\": Infinity}",
     "line 1, column 9: NaN and Infinity are not JSON, though json.dumps of "
     "Python writes them"},
    {"{\"dim\": -Inf}", "line 1, column 9: invalid JSON"},
    {"{\"dim\": nul}", "line 1, column 9: invalid JSON"},
    {"{\"dim\": 'a'}", "line 1, column 9: invalid JSON"},
    {"{dim: 3}", "line 1, column 3: invalid JSON"},
    {"{\"dim\\x\": 3}", "line 1, column 6: invalid JSON"},
    {"{\"\\ud800\": 3}", "line 1, column 3: invalid JSON"},
    {"{\"dim\\u0000x\": 3}", "line 1, column 6: a string contains \\u0000"},
    {"{\"dim\": 3, \"bodies\":\n [{\"shape\": \"box\\u0000b\"}]}",
     "line 2, column 17: a string contains \\u0000"},
    {"{\"dim\": 3, \"name\": \"\\\\\\u0000\"}", "line 1, column 23: a string contains \\u0000"},
    {"{\"dim\": 3, \"name\": \"\\u00g0\"}", "line 1, column 21: invalid JSON"},
    {"{\"dim\": 3, \"name\": \"\\u00\"}", "line 1, column 21: invalid JSON"},
    {"{\"dim\": 3,\n \"bodies\": [], \"pairs\": [[1, 02]]}", "line 2, column 31: invalid JSON"},
    {"{\"\\ud83d\\uDE00\": 3}",
     "unknown key \"????\" (there are label, dim, duration, margin, bodies, pairs, ignore)"},
    {SCENE(BODY(1)) "\n]", "scene 2: line 2, column 1: expected an object, '{', found ']'"},
    {SCENE(BODY(1)) "," SCENE(BODY(1)),
     "scene 2: line 1, column 103: expected an object, '{', found ','"},
    {SCENE(BODY(1)) "\n\n {\"dim\":\n]}", "scene 2: line 4, column 1: invalid JSON"},
    {SCENE(BODY(1)) SCENE("{}"), "scene 2: bodies[0]: missing key \"id\""},
};

static void bad_texts_are_refused(void **state)
{
    for (size_t i = 0; i < COUNT(bad_texts); i++)
        expect_error(bad_texts[i].text, bad_texts[i].error);
}

static enum json_outcome outcome_of(const char *bytes, size_t size)
{
    struct input input = open_bytes(bytes, size);
    struct owned_scene scene;
    const enum json_outcome outcome = json_next(input.reader, &scene);
    if (outcome == JSON_SCENE)
        scene_clear(&scene);
    close_input(&input);
    return outcome;
}

/* All texts of up to four of these characters are compared with the grammar of RFC 8259. */
static void numbers_follow_the_grammar_of_json(void **state)
{
    static const char characters[] = "-+.0179eE";
    enum { COUNT = sizeof characters - 1, LONGEST = 4 };
    regex_t number;
    int accepted = 0;
    assert_int_equal(regcomp(&number, "^-?(0|[1-9][0-9]*)(\\.[0-9]+)?([eE][+-]?[0-9]+)?$",
                             REG_EXTENDED | REG_NOSUB),
                     0);
    for (int length = 1, texts = COUNT; length <= LONGEST; length++, texts *= COUNT)
        for (int i = 0; i < texts; i++) {
            char text[LONGEST + 1] = "", scene[256];
            for (int k = 0, rest = i; k < length; k++, rest /= COUNT)
                text[k] = characters[rest % COUNT];
            snprintf(scene, sizeof scene,
                     "{\"dim\":2,\"bodies\":[{\"id\":1,\"shape\":\"box\",\"size\":[1,1],"
                     "\"velocity\":[0,%s]}]}",
                     text);
            const bool good = regexec(&number, text, 0, NULL, 0) == 0;
            const bool read = outcome_of(scene, strlen(scene)) == JSON_SCENE;
            if (good != read)
                print_message("%s\n", text);
            assert_int_equal(good, read);
            accepted += good;
        }
    regfree(&number);
    assert_in_range(accepted, 700, 1100);
}

static void names_are_utf8_without_control_characters(void **state)
{
    static const struct {
        const char *name;
        bool good;
    } names[] = {{"a b", true},
                 {"\x7f", false},
                 {"\xc2\x80", false},
                 {"\xc2\x9f", false},
                 {"\xc2\xa0", true},
                 {"\xe0\xa0\x80", true},
                 {"\xe0\x9f\xbf", false},
                 {"\xed\xa0\x80", false},
                 {"\xef\xbf\xbd", true},
                 {"\xf4\x8f\xbf\xbf", true},
                 {"\xf4\x90\x80\x80", false},
                 {"a\xc3", false},
                 {"\xc0\x80", false},
                 {"\x80", false}};
    for (size_t i = 0; i < COUNT(names); i++) {
        char text[256];
        snprintf(
            text, sizeof text,
            "{\"dim\":2,\"bodies\":[{\"id\":1,\"name\":\"%s\",\"shape\":\"box\",\"size\":[1,1]}]}",
            names[i].name);
        if (names[i].good)
            assert_int_equal(outcome_of(text, strlen(text)), JSON_SCENE);
        else
            expect_error(text, "bodies[0].name: expected UTF-8 without control characters");
    }
}

/* At each position of a scene: white space is accepted between tokens, other control characters are
 * not accepted anywhere. */
static void control_characters_are_refused(void **state)
{
    static const char scene[] = SCENE(BODY(1));
    const size_t size = sizeof scene - 1;
    for (unsigned char byte = 0; byte < ' '; byte++)
        for (size_t at = 1; at < size; at++) {
            char text[sizeof scene];
            int quotes = 0;
            memcpy(text, scene, at);
            text[at] = (char) byte;
            memcpy(text + at + 1, scene + at, size - at);
            for (size_t i = 0; i < at; i++)
                quotes += scene[i] == '"';
            const bool space = byte == '\t' || byte == '\n' || byte == '\r';
            assert_int_equal(outcome_of(text, size + 1),
                             space && quotes % 2 == 0 ? JSON_SCENE : JSON_BAD);
        }
    expect_error_in_bytes("{\"dim\":\n \0 3}", 14, "line 2, column 2: invalid JSON");
}

static void brackets_in_strings_are_not_counted(void **state)
{
    expect_error(
        "{\"]}\\\"}[{\\\\\": 1}",
        "unknown key \"]}\"}[{\\\" (there are label, dim, duration, margin, bodies, pairs, "
        "ignore)");
    expect_error(
        "{\"dim\":\"" /* 40 of them */
        "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["
        "\"}",
        "missing key \"bodies\"");
}

static void an_object_without_end_is_refused(void **state)
{
    enum { LIMIT = 1000 };
    FILE *file = tmpfile();
    const char *object;
    size_t length;
    struct text text;
    assert_non_null(file);
    fprintf(file, "\n{%0100000d", 0);
    rewind(file);
    text_open(fileno(file), &text);
    assert_int_equal(text.object_max, TEXT_OBJECT_MAX);
    text.object_max = LIMIT;
    assert_int_equal(text_next(&text, &object, &length), TEXT_BAD);
    assert_string_equal(text.error, "line 2, column 1: an object of more than 1000 bytes");
    assert_int_equal(text.used, LIMIT + 1);
    text_close(&text);
    fclose(file);
}

static void deep_nesting_is_refused_early(void **state)
{
    enum { SIZE = 1 << 20 };
    static char text[SIZE];
    memset(text, '[', sizeof text);
    memcpy(text, "{\"dim\":", 7);
    expect_error_in_bytes(text, sizeof text, "line 1, column 39: nested more than 32 deep");
}

static void a_directory_is_no_input(void **state)
{
    struct owned_scene scene;
    FILE *file = fopen(".", "r");
    assert_non_null(file);
    struct json_reader *reader = json_open(fileno(file));
    assert_int_equal(json_next(reader, &scene), JSON_FAILED);
    assert_string_equal(json_error(reader), "Is a directory");
    json_close(reader);
    fclose(file);
}

/* Whatever is cut off, nothing is read beyond the end, and something is said. */
static void every_beginning_of_a_scene_is_refused(void **state)
{
    static const char text[] = SCENE_PAIRS("[[1,2],[2,1]]");
    for (size_t size = 0; size < sizeof text - 1; size++) {
        struct input input = open_bytes(text, size);
        struct owned_scene scene;
        assert_int_equal(json_next(input.reader, &scene), JSON_BAD);
        assert_true(json_error(input.reader)[0] != '\0');
        close_input(&input);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_every_field),
        cmocka_unit_test(reads_poses_frames_names_and_ignored_pairs),
        cmocka_unit_test(reads_vertices_groups_and_labels),
        cmocka_unit_test(reads_hulls),
        cmocka_unit_test(hulls_have_a_limit),
        cmocka_unit_test(turned_boxes_are_accurate),
        cmocka_unit_test(missing_fields_have_defaults),
        cmocka_unit_test(a_scene_is_given_when_it_is_complete),
        cmocka_unit_test(doubles_come_back_bit_for_bit),
        cmocka_unit_test(numbers_are_written_short),
        cmocka_unit_test(ends_that_differ_look_different),
        cmocka_unit_test(the_sign_of_zero_is_kept),
        cmocka_unit_test(ends_are_read_and_written),
        cmocka_unit_test(round_shapes_are_read_back),
        cmocka_unit_test(cylinders_are_enclosed),
        cmocka_unit_test(pairs_may_have_names),
        cmocka_unit_test(long_numbers_are_read_in_full),
        cmocka_unit_test(bad_scenes_are_refused),
        cmocka_unit_test(bad_texts_are_refused),
        cmocka_unit_test(numbers_follow_the_grammar_of_json),
        cmocka_unit_test(names_are_utf8_without_control_characters),
        cmocka_unit_test(control_characters_are_refused),
        cmocka_unit_test(brackets_in_strings_are_not_counted),
        cmocka_unit_test(an_object_without_end_is_refused),
        cmocka_unit_test(deep_nesting_is_refused_early),
        cmocka_unit_test(a_directory_is_no_input),
        cmocka_unit_test(every_beginning_of_a_scene_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
