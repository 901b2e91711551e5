/* The picture: whole, well-formed, and of ordinary numbers, whatever the scene. */

#include "unit.h"

#include "svg.h"
#include "view.h"

#include <float.h>
#include <math.h>

/* ---- Scenes ---------------------------------------------------------------------------------- */

static const double unit[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

/* A body, and its placement. */
struct placed {
    struct fmb_body body;
    struct fmb_placement at;
};

static void make_body(struct placed *out, int64_t id, int dim, enum fmb_shape shape, double size,
                      double at)
{
    double components[9];
    size_t count = (size_t) (fmb_component_count(dim, (int) shape) * dim);
    for (size_t i = 0; i < count; i++)
        components[i] = size * (dim == 3 ? unit[i] : unit[i % 2 + i / 2 * 3]);
    memset(out, 0, sizeof *out);
    assert_int_equal(fmb_body_make(dim, (int) shape, components, count, &out->body), FMB_OK);
    out->at = (struct fmb_placement){.id = id, .body = &out->body};
    for (int axis = 0; axis < dim; axis++)
        out->at.position[axis] = at;
}

/* Two bodies, one of which moves. */
static struct {
    struct placed body[2];
    struct fmb_placement placements[2];
    struct owned_scene scene;
} pair;

static void make_scene(int dim, double size, double at, double velocity)
{
    make_body(&pair.body[0], 31, dim, FMB_CUBOID, size, at);
    make_body(&pair.body[1], 47, dim, FMB_TETRAHEDRON, size, at / 2);
    for (int axis = 0; axis < dim; axis++)
        pair.body[1].at.velocity[axis] = velocity;
    for (int i = 0; i < 2; i++)
        pair.placements[i] = pair.body[i].at;
    pair.scene = (struct owned_scene){
        .dim = dim, .scene = {.placements = pair.placements, .placement_count = 2, .duration = 1}};
}

/* The memory of the scene is not its own. */
static void begin(struct report *report, struct owned_scene *scene)
{
    report->scene = scene;
    report->begin(report);
}

static void take(struct svg *svg, const struct owned_scene *owner)
{
    struct report *report = svg_report(svg);
    struct owned_scene taken = *owner;
    const struct fmb_scene *scene = &owner->scene;
    struct scene_cursor cursor = {0};
    unsigned of[2];
    begin(report, &taken);
    while (scene_next_pair(&taken, &cursor, of)) {
        struct fmb_client_answer answer = {.a = of[0], .b = of[1], .text = ""};
        assert_int_equal(
            fmb_decide(fmb_method_default(), &scene->placements[of[0]], &scene->placements[of[1]],
                       scene->duration, FMB_WANT_BOX, &answer.answer),
            FMB_OK);
        report->pair(report, &answer);
    }
    report->end(report);
}

/* The file as a text; to be freed. */
static char *draw(const struct svg *svg)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    svg_write(svg, out);
    assert_int_equal(fclose(out), 0);
    return text;
}

static char *draw_one(const struct owned_scene *scene)
{
    struct svg *svg = svg_open();
    take(svg, scene);
    char *text = draw(svg);
    svg_close(svg);
    return text;
}

/* ---- Checks ---------------------------------------------------------------------------------- */

static int count(const char *text, const char *part)
{
    int found = 0;
    for (const char *at = strstr(text, part); at; at = strstr(at + 1, part))
        found++;
    return found;
}

/* Each element that is opened is closed, in order. */
static void expect_balanced(const char *text)
{
    enum { DEPTH_MAX = 16 };
    const char *open[DEPTH_MAX];
    int depth = 0;
    for (const char *at = strchr(text, '<'); at; at = strchr(at + 1, '<')) {
        const char *end = strchr(at, '>');
        assert_non_null(end);
        if (at[1] == '/') {
            assert_true(depth > 0);
            size_t length = (size_t) (end - at - 2);
            assert_memory_equal(open[--depth], at + 2, length);
            assert_true(strchr(" >", open[depth][length]) != NULL);
        } else if (end[-1] != '/') {
            assert_true(depth < DEPTH_MAX);
            open[depth++] = at + 1;
        }
    }
    assert_int_equal(depth, 0);
}

/* All coordinates of paths are numbers, and lie on the sheet. */
static void expect_paths_on_sheet(const char *text)
{
    double width = strtod(strstr(text, " width=\"") + 8, NULL);
    double height = strtod(strstr(text, " height=\"") + 9, NULL);
    for (const char *at = strstr(text, " d=\"M"); at; at = strstr(at + 1, " d=\"M")) {
        const char *number = at + 4;
        while (*number == 'M' || *number == 'L') {
            char *end;
            double x = strtod(number + 1, &end), y = strtod(end, &end);
            assert_true(x >= 0 && x <= width && y >= 0 && y <= height);
            number = end;
        }
        assert_non_null(strchr("Zh\"", *number));
    }
}

static void expect_good_picture(const char *text)
{
    assert_memory_equal(text, "<svg ", 5);
    assert_null(strstr(text, "nan"));
    assert_null(strstr(text, "inf"));
    expect_balanced(text);
    expect_paths_on_sheet(text);
}

/* ---- Tests ----------------------------------------------------------------------------------- */

static void shows_frames_ids_motion_and_boxes(void **state)
{
    for (int dim = 2; dim <= 3; dim++) {
        make_scene(dim, 2, 1, 0.25);
        char *text = draw_one(&pair.scene);
        expect_good_picture(text);
        assert_int_equal(count(text, ">31</text>"), 1);
        assert_int_equal(count(text, ">47</text>"), 1);
        assert_int_equal(count(text, "<title>31 and 47: overlapping, 0 to 1 s</title>"), 1);
        assert_int_equal(count(text, "<path class=\"arrow\"") + count(text, "class=\"arrow\" m"),
                         2);
        assert_true(count(text, "class=\"ghost\"") > 1);
        assert_int_equal(count(text, "1 overlapping, 0 touching, 0 separated"), 1);
        free(text);
    }
}

static void any_numbers_can_be_drawn(void **state)
{
    static const double numbers[] = {0,     5e-324, 1e-310, 1e-300, 1,       1e6,   1e15,
                                     1e150, 1e300,  1e308,  -1e308, DBL_MAX, -1e15, -DBL_MAX};
    enum { COUNT = COUNT(numbers) };
    for (int i = 0; i < 2 * COUNT * COUNT * COUNT; i++) {
        make_scene(2 + i % 2, numbers[i / 2 % COUNT], numbers[i / 2 / COUNT % COUNT],
                   numbers[i / 2 / COUNT / COUNT]);
        char *text = draw_one(&pair.scene);
        expect_good_picture(text);
        free(text);
    }
}

static void infinite_boxes_and_sums_can_be_drawn(void **state)
{
    const struct fmb_client_answer answer = {
        .b = 1,
        .answer = {.verdict = FMB_OVERLAPPING,
                   .has_box = true,
                   .box = {{-INFINITY, 0, -INFINITY}, {INFINITY, INFINITY, 0}}}};
    make_scene(3, DBL_MAX, DBL_MAX, -DBL_MAX);
    pair.body[0].body.one.component[0][0] = pair.body[0].body.one.component[1][0] = -DBL_MAX;
    pair.scene.scene.duration = 1e308;
    struct svg *svg = svg_open();
    struct report *report = svg_report(svg);
    begin(report, &pair.scene);
    report->pair(report, &answer);
    report->end(report);
    char *text = draw(svg);
    expect_good_picture(text);
    free(text);
    svg_close(svg);
}

static void empty_scenes_and_no_scene_can_be_drawn(void **state)
{
    for (int dim = 2; dim <= 3; dim++) {
        const struct owned_scene scene = {.dim = dim, .scene.duration = 1};
        char *text = draw_one(&scene);
        expect_good_picture(text);
        free(text);
    }
    struct svg *svg = svg_open();
    char *text = draw(svg);
    expect_good_picture(text);
    free(text);
    svg_close(svg);
}

static void many_scenes_and_bodies_are_cut(void **state)
{
    enum { SCENES = SVG_PANELS_MAX + 3, BODIES = SVG_BODIES_MAX + 5 };
    static struct placed body[BODIES];
    static struct fmb_placement placements[BODIES];
    struct owned_scene scene = {
        .dim = 2, .scene = {.placements = placements, .placement_count = 1, .duration = 1}};
    struct svg *svg = svg_open();
    for (int i = 0; i < BODIES; i++) {
        make_body(&body[i], i + 1, 2, FMB_CUBOID, 1, i);
        placements[i] = body[i].at;
    }
    for (int i = 0; i < SCENES; i++)
        take(svg, &scene);
    char *text = draw(svg);
    expect_good_picture(text);
    assert_int_equal(count(text, ">scene "), SVG_PANELS_MAX);
    assert_non_null(strstr(text, "3 more scenes not drawn"));
    free(text);
    svg_close(svg);

    static const unsigned last[1][2] = {{BODIES - 2, BODIES - 1}}; /* touching, and not drawn */
    scene.scene.placement_count = BODIES;
    scene.scene.which = FMB_PAIRS_LISTED;
    scene.scene.pairs = last;
    scene.scene.pair_count = 1;
    text = draw_one(&scene);
    expect_good_picture(text);
    assert_non_null(strstr(text, "5 more bodies"));
    assert_non_null(strstr(text, "1 more boxes"));
    free(text);
}

/* Wherever the face is, and in whatever order its corners are. */
static void the_light_on_a_face_is_that_of_its_normal(void **state)
{
    struct view_bounds bounds = view_nothing();
    const double low[3] = {-2, -2, -2}, high[3] = {2, 2, 2};
    const struct outline all = outline_box(3, low, high);
    view_add(&bounds, &all, 3);
    const struct view view = view_make(3, &bounds, (struct paper){0, 0, 400, 300});
    for (int axis = 0; axis < 3; axis++) {
        double first = -1;
        for (double at = -1; at <= 1; at += 0.5) {
            double corner[3][3] = {{at, at, at}, {at, at, at}, {at, at, at}};
            corner[1][(axis + 1) % 3] += 0.5;
            corner[2][(axis + 2) % 3] += 1;
            for (int turn = 0; turn < 3; turn++) {
                const double light =
                    view_light(&view, corner[turn], corner[(turn + 1) % 3], corner[(turn + 2) % 3]);
                first = first < 0 ? light : first;
                assert_true(light > 0 && light < 1 && fabs(light - first) < 1e-12);
            }
        }
    }
}

/* Steps of time are seen from one place: what rests is drawn at the same place on its panel. */
static void steps_share_a_view(void **state)
{
    char card[64], still[200];
    struct svg *svg = svg_open();
    make_scene(2, 1, 0, 0);
    take(svg, &pair.scene);
    struct fmb_placement later[] = {pair.placements[0], pair.placements[1]};
    later[1].position[0] = 8;
    pair.scene.scene.placements = later;
    take(svg, &pair.scene);
    char *text = draw(svg);
    double x[2], y[2];
    const char *at = text;
    for (int i = 0; i < 2; i++) {
        at = strstr(at, "<rect class=\"card\"");
        assert_non_null(at);
        assert_int_equal(sscanf(at, "<rect class=\"card\" x=\"%63[0-9.]", card), 1);
        const char *path = strstr(at, "class=\"flat\"");
        assert_non_null(path);
        while (strncmp(path, "<path d=\"", 9) != 0)
            path--;
        assert_int_equal(sscanf(path, "<path d=\"M%lf %lf%199[^Z]", &x[i], &y[i], still), 3);
        x[i] -= strtod(card, NULL);
        at++;
    }
    assert_true(fabs(x[0] - x[1]) < 0.11 && fabs(y[0] - y[1]) < 0.11);
    free(text);
    svg_close(svg);
}

/* By 90 degrees: x becomes y, in 3D about the z axis. */
static void turned_bodies_are_drawn_turned(void **state)
{
    for (int dim = 2; dim <= 3; dim++) {
        struct placed body;
        make_body(&body, 1, dim, FMB_CUBOID, 2, 10);
        body.at.orientation_count = dim == 2 ? 2 : 4;
        body.at.orientation[0] = body.at.orientation[body.at.orientation_count - 1] = 3;
        body.at.velocity[1] = 4;
        const struct outline outline = outline_make(&body.at, 0, 0.5);
        const double end[2][2] = {{10, 14}, {8, 12}}; /* of x and y, 2 farther in y */
        for (int component = 0; component < 2; component++)
            for (int axis = 0; axis < 2; axis++)
                assert_true(fabs(outline.corner[1 << component][axis] - end[component][axis]) <
                            1e-12);
    }
}

/* All faces of a flat frame are filled, in any orientation. */
static void flat_boxes_are_filled(void **state)
{
    static const double size[] = {1, 2, 0};
    for (int i = 0; i < 100; i++) {
        struct fmb_body body;
        const struct fmb_placement placement = {.body = &body,
                                                .position = {0.1, i, 0.3},
                                                .orientation = {1, 0.1 * i, 0.7, -0.3 * i},
                                                .orientation_count = 4,
                                                .id = 1};
        const struct owned_scene scene = {
            .dim = 3, .scene = {.placements = &placement, .placement_count = 1, .duration = 1}};
        assert_int_equal(fmb_body_make(3, FMB_BOX, size, 3, &body), FMB_OK);
        char *text = draw_one(&scene);
        assert_int_equal(count(text, "class=\"back\""), 0);
        assert_int_equal(count(text, "<title>1: not tested</title>"), 6);
        free(text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shows_frames_ids_motion_and_boxes),
        cmocka_unit_test(turned_bodies_are_drawn_turned),
        cmocka_unit_test(flat_boxes_are_filled),
        cmocka_unit_test(any_numbers_can_be_drawn),
        cmocka_unit_test(infinite_boxes_and_sums_can_be_drawn),
        cmocka_unit_test(empty_scenes_and_no_scene_can_be_drawn),
        cmocka_unit_test(many_scenes_and_bodies_are_cut),
        cmocka_unit_test(the_light_on_a_face_is_that_of_its_normal),
        cmocka_unit_test(steps_share_a_view),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
