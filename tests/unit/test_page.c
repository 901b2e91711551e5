/* The page of a replay: which queries it keeps, and how it writes them, hostile ones too. */

#include "unit.h"

#include "geometry_write.h"
#include "logged_query.h"
#include "page.h"
#include "page_event.h"

#include <cjson/cJSON.h>
#include <float.h>
#include <math.h>

/* ---- Tools ----------------------------------------------------------------------------------- */

/* 2024-05-01, 10:00 */
#define BEGIN INT64_C(1714557600000000)

static char *write_page(const struct page *page)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    page_write(page, out);
    assert_int_equal(fclose(out), 0);
    assert_int_equal(strlen(text), size);
    return text;
}

static const char data_begin[] = "<script type=\"application/json\" id=\"data\">";

/* The data as text, up to where a browser ends the element; to be freed. */
static char *data_text(const struct page *page)
{
    char *text = write_page(page), *begin = strstr(text, data_begin);
    assert_non_null(begin);
    char *end = strstr(begin, "</script>");
    assert_non_null(end);
    assert_non_null(strstr(end, "<script>\n"));
    *end = '\0';
    memmove(text, begin + sizeof data_begin - 1, strlen(begin + sizeof data_begin - 1) + 1);
    return text;
}

/* To be deleted. */
static cJSON *data_of(const struct page *page)
{
    char *text = data_text(page);
    cJSON *data = cJSON_Parse(text);
    assert_non_null(data);
    free(text);
    return data;
}

static const cJSON *member(const cJSON *object, const char *name)
{
    const cJSON *found = cJSON_GetObjectItemCaseSensitive(object, name);
    if (!found)
        fail_msg("there is no %s", name);
    return found;
}

static double number(const cJSON *object, const char *name)
{
    const cJSON *found = member(object, name);
    assert_true(cJSON_IsNumber(found));
    return found->valuedouble;
}

static const cJSON *event_at(const cJSON *data, int index)
{
    const cJSON *event = cJSON_GetArrayItem(member(data, "events"), index);
    assert_non_null(event);
    return event;
}

static void expect_json(const cJSON *value, const char *expected)
{
    char *text = cJSON_PrintUnformatted(value);
    assert_string_equal(text, expected);
    cJSON_free(text);
}

static int count_of(const char *text, const char *part)
{
    int found = 0;
    for (const char *at = strstr(text, part); at; at = strstr(at + 1, part))
        found++;
    return found;
}

/* ---- Queries --------------------------------------------------------------------------------- */

/* Geometries last until as many others have been made. */
enum { BODIES_MAX = QUERY_PLACEMENTS_MAX + 10 };

static struct body_view encode(int dim, const struct plain_frame *frame)
{
    static unsigned char bytes[BODIES_MAX][GEOMETRY_FRAME_BYTES_MAX];
    static int next;
    unsigned char *to = bytes[next++ % BODIES_MAX];
    return geometry_write(dim, frame, to);
}

static struct plain_frame cuboid(int dim, double size)
{
    struct plain_frame frame = {.shape = FMB_CUBOID};
    for (int i = 0; i < dim; i++)
        frame.components[i * dim + i] = size;
    return frame;
}

static struct query_placement place(int64_t id, int dim, const struct plain_frame *frame, double at)
{
    struct query_placement out = {.placed.id = id, .body = encode(dim, frame)};
    for (int i = 0; i < dim; i++)
        out.placed.position[i] = at;
    return out;
}

static struct query_placement make_body(int64_t id, int dim, double size, double at)
{
    const struct plain_frame frame = cuboid(dim, size);
    return place(id, dim, &frame, at);
}

/* As a placement by handle that the log does not define. */
static struct query_placement make_undefined(int64_t id, int dim)
{
    struct handle handle;
    for (int i = 0; i < HANDLE_BYTES; i++)
        handle.bytes[i] = (unsigned char) (0xf7 + i);
    return (struct query_placement){.placed.id = id, .body = geometry_named(dim, &handle)};
}

static struct pair_query pair_query(int dim)
{
    return (struct pair_query){.duration = 1,
                               .want = FMB_WANT_BOX,
                               .placement = {make_body(1, dim, 1, 0), make_body(2, dim, 1, 0.5)}};
}

static struct pair_result overlapping(void)
{
    return (struct pair_result){
        .method = 4,
        .dim = 2,
        .answer = {.verdict = FMB_OVERLAPPING, .has_box = true, .box = {{0.5, 0.5, 0}, {1, 1, 0}}}};
}

static struct replayed of_pair(const struct pair_query *query, const struct pair_result *then,
                               const struct pair_result *now, enum replay_outcome outcome)
{
    return (struct replayed){.log = "a.log",
                             .event_number = 7,
                             .offset = 28,
                             .utime = BEGIN,
                             .outcome = outcome,
                             .pair = query,
                             .pair_then = then,
                             .pair_now = now};
}

static struct replayed of_scene(const struct scene_query *query, const struct scene_result *then,
                                const struct scene_result *now, enum replay_outcome outcome)
{
    return (struct replayed){
        .log = "a.log", .outcome = outcome, .scene = query, .scene_then = then, .scene_now = now};
}

/* The data of a page of only this query; to be deleted. */
static cJSON *data_of_one(const struct replayed *replayed)
{
    struct page *page = page_open("one", BEGIN);
    page_take(page, replayed);
    cJSON *data = data_of(page);
    page_close(page);
    return data;
}

static void expect_pairs(const struct replayed *replayed, const char *expected)
{
    cJSON *data = data_of_one(replayed);
    expect_json(member(event_at(data, 0), "pairs"), expected);
    cJSON_Delete(data);
}

static void expect_answers(const struct pair_result *then, const struct pair_result *now,
                           const char *expected)
{
    const struct pair_query query = pair_query(2);
    const struct replayed replayed = of_pair(&query, then, now, REPLAY_DIFFERENT);
    expect_pairs(&replayed, expected);
}

/* ---- The whole ------------------------------------------------------------------------------- */

static void an_empty_page_is_whole(void **state)
{
    struct page *page = page_open("</script><script>alert(1)</script><!--", BEGIN);
    cJSON *data = data_of(page);
    assert_string_equal(member(data, "title")->valuestring,
                        "</script><script>alert(1)</script><!--");
    expect_json(member(data, "count"), "[0,0,0,0,0,0]");
    expect_json(member(data, "events"), "[]");
    expect_json(member(data, "shapes"), "[]");
    cJSON_Delete(data);
    char *text = write_page(page);
    assert_memory_equal(text, "<!DOCTYPE html>\n", 16);
    assert_string_equal(text + strlen(text) - 8, "</html>\n");
    assert_int_equal(count_of(text, "alert(1)"), 1);
    assert_int_equal(count_of(text, "<script"), 2);
    assert_int_equal(count_of(text, "<!--"), 0);
    free(text);
    page_close(page);
    page_close(NULL);
}

static void outcomes_are_counted_and_logs_named(void **state)
{
    const struct pair_query query = pair_query(2);
    const struct pair_result result = overlapping();
    struct page *page = page_open("many", BEGIN);
    for (int outcome = REPLAY_SAME; outcome < REPLAY_OUTCOMES; outcome++) {
        struct replayed replayed = of_pair(&query, &result, &result, (enum replay_outcome) outcome);
        char log[] = "\xff_.log";
        log[1] = (char) ('0' + outcome % 3);
        replayed.log = log;
        replayed.utime -= 1000 * (outcome == 2);
        for (int i = 0; i <= outcome; i++)
            page_take(page, &replayed);
        log[1] = 'x'; /* a path need not outlive the call */
    }
    cJSON *data = data_of(page);
    expect_json(member(data, "count"), "[1,2,3,4,5,6]");
    expect_json(member(data, "left_out"), "[0,0,0,0,0,0]");
    expect_json(member(data, "span"), "[1.714557599999e+15,1.7145576e+15]");
    expect_json(member(data, "logs"),
                "[\"\xef\xbf\xbd"
                "0.log\",\"\xef\xbf\xbd"
                "1.log\",\"\xef\xbf\xbd"
                "2.log\"]");
    assert_int_equal(cJSON_GetArraySize(member(data, "events")), 21);
    assert_int_equal(number(event_at(data, 20), "log"), 2);
    assert_int_equal(number(event_at(data, 20), "is"), REPLAY_UNRECORDED);
    cJSON_Delete(data);
    page_close(page);
}

/* ---- Limits ---------------------------------------------------------------------------------- */

static void beyond_the_event_limit_only_differences_are_kept(void **state)
{
    const struct pair_query query = pair_query(2);
    const struct pair_result result = overlapping();
    struct replayed replayed = of_pair(&query, &result, &result, REPLAY_SAME);
    struct page *page = page_open("many", BEGIN);
    for (int i = 0; i < PAGE_EVENTS_MAX + 10; i++, replayed.utime++)
        page_take(page, &replayed);
    replayed.outcome = REPLAY_DIFFERENT;
    for (int i = 0; i < PAGE_DIFFERENCES_MAX + 3; i++, replayed.utime++)
        page_take(page, &replayed);
    replayed.outcome = REPLAY_BUSY;
    page_take(page, &replayed);
    cJSON *data = data_of(page);
    assert_int_equal(cJSON_GetArraySize(member(data, "events")),
                     PAGE_EVENTS_MAX + PAGE_DIFFERENCES_MAX);
    expect_json(member(data, "count"), "[5010,1003,1,0,0,0]");
    expect_json(member(data, "left_out"), "[10,3,1,0,0,0]");
    expect_json(member(data, "left_span"), "[1.714557600005e+15,1714557600006013]");
    cJSON_Delete(data);
    page_close(page);
}

static void differences_count_towards_the_limit(void **state)
{
    const struct pair_query query = pair_query(2);
    const struct pair_result result = overlapping();
    struct replayed replayed = of_pair(&query, &result, &result, REPLAY_DIFFERENT);
    struct page *page = page_open("many", BEGIN);
    for (int i = 0; i < PAGE_EVENTS_MAX + 1; i++)
        page_take(page, &replayed);
    replayed.outcome = REPLAY_SAME;
    page_take(page, &replayed);
    cJSON *data = data_of(page);
    expect_json(member(data, "left_out"), "[1,0,0,0,0,0]");
    cJSON_Delete(data);
    page_close(page);
}

static struct scene_query scene;
static struct scene_result result_then, result_now;

/* As many placements as there may be; numbers of fifteen digits, which no other scene has. */
static void make_large_scene(int step)
{
    memset(&scene, 0, sizeof scene);
    scene.duration = 1;
    scene.which = FMB_PAIRS_ALL;
    scene.placement_count = QUERY_PLACEMENTS_MAX;
    for (int i = 0; i < QUERY_PLACEMENTS_MAX; i++) {
        struct plain_frame frame = {.shape = FMB_CUBOID};
        for (int k = 0; k < 9; k++)
            frame.components[k] = (1e14 + 9 * (step * QUERY_PLACEMENTS_MAX + i) + k) / 1e14;
        scene.placement[i] = place(i + 1, 3, &frame, i);
    }
}

static void beyond_the_byte_limit_only_differences_are_kept(void **state)
{
    const int enough = 400;
    struct page *page = page_open("large", BEGIN);
    int64_t taken[] = {0, 0};
    for (int outcome = REPLAY_SAME; outcome <= REPLAY_DIFFERENT; outcome++) {
        for (int i = 0; i < enough; i++) {
            const struct replayed replayed =
                of_scene(&scene, NULL, NULL, (enum replay_outcome) outcome);
            make_large_scene(outcome * enough + i);
            page_take(page, &replayed);
        }
    }
    char *text = data_text(page);
    const size_t bytes = strlen(text), most = (size_t) PAGE_BYTES_MAX + PAGE_DIFFERENCES_BYTES_MAX;
    for (int outcome = REPLAY_SAME; outcome <= REPLAY_DIFFERENT; outcome++)
        taken[outcome] = count_of(text, outcome ? "\"is\":1" : "\"is\":0");
    assert_in_range(bytes, most, most + (2 << 20));
    assert_in_range(taken[0], 10, enough - 1);
    assert_in_range(taken[1], 5, enough - 1);
    assert_int_equal(count_of(text, "{\"n\":"), taken[0] + taken[1]);
    free(text);
    page_close(page);
}

/* ---- Placements ------------------------------------------------------------------------------ */

static void expect_placements(const struct pair_query *query, const char *expected)
{
    const struct replayed replayed = of_pair(query, NULL, NULL, REPLAY_UNDEFINED);
    cJSON *data = data_of_one(&replayed);
    expect_json(member(event_at(data, 0), "frames"), expected);
    cJSON_Delete(data);
}

static void shapes_are_kept_once(void **state)
{
    struct page *page = page_open("rigid", BEGIN);
    for (int i = 0; i < 200; i++) {
        struct pair_query query = pair_query(2);
        struct replayed replayed = of_pair(&query, NULL, NULL, REPLAY_UNRECORDED);
        query.placement[0] = make_body(1, 2, 1 + i % 100, i);
        query.placement[1] = make_body(2, 3, 1 + i % 100, i);
        query.placement[1].velocity_count = 3;
        memcpy(query.placement[1].placed.velocity, query.placement[1].placed.position,
               sizeof query.placement[1].placed.velocity);
        page_take(page, &replayed);
    }
    cJSON *data = data_of(page);
    const cJSON *shapes = member(data, "shapes");
    assert_int_equal(cJSON_GetArraySize(shapes), 200);
    expect_json(cJSON_GetArrayItem(shapes, 6), "{\"dim\":2,\"frames\":[[1,0,0,4,0,0,4]]}");
    expect_json(member(event_at(data, 103), "frames"),
                "[[1,6,[103,103],[],[]],[2,7,[103,103,103],[],[103,103,103]]]");
    cJSON_Delete(data);
    page_close(page);
}

/* Replay adds the geometry to placements by handle where the log defines it. */
static void bodies_by_handle_that_are_not_defined_are_named(void **state)
{
    struct pair_query query = pair_query(2);
    query.placement[1] = make_undefined(2, 2);
    expect_placements(&query, "[[1,0,[0,0],[],[]],[2,-1,\"f7f8f9fafbfcfdfeff00010203040506\"]]");
}

static void bodies_have_frames_and_poses(void **state)
{
    static unsigned char bytes[2 * GEOMETRY_FRAME_BYTES_MAX];
    struct plain_frame frames[2] = {cuboid(2, 1), {.shape = FMB_BOX, .components = {2, 3}}};
    struct pair_query query = pair_query(2);
    frames[0].origin[0] = 0.25;
    query.placement[0].body = geometry_write_frames(2, frames, 2, bytes);
    query.placement[0].placed.orientation_count = 2;
    query.placement[0].placed.orientation[0] = 1;
    query.placement[0].placed.orientation[1] = -2;
    const struct replayed replayed = of_pair(&query, NULL, NULL, REPLAY_UNDEFINED);
    cJSON *data = data_of_one(&replayed);
    expect_json(member(event_at(data, 0), "frames"),
                "[[1,0,[0,0],[1,-2],[]],[2,1,[0.5,0.5],[],[]]]");
    expect_json(member(data, "shapes"),
                "[{\"dim\":2,\"frames\":[[1,0.25,0,1,0,0,1],[4,0,0,2,3]]},"
                "{\"dim\":2,\"frames\":[[1,0,0,1,0,0,1]]}]");
    cJSON_Delete(data);
}

static void bodies_that_cannot_be_drawn_are_named(void **state)
{
    struct plain_frame frame = cuboid(3, 1);
    static unsigned char other_shape[GEOMETRY_FRAME_BYTES_MAX];
    struct query_placement bad[14];
    for (int i = 0; i < 14; i++)
        bad[i] = make_body(9, 3, 1, 0);
    frame.components[8] = NAN;
    bad[0].body = encode(3, &frame);
    bad[1].placed.position[0] = -INFINITY;
    bad[2].body.dim = 2;
    bad[3].body.dim = 4;
    bad[4].body.frame_count = 0;
    bad[5].velocity_count = 2;
    bad[6].placed.orientation_count = 4;
    bad[7].velocity_count = 3;
    bad[7].placed.velocity[2] = INFINITY;
    bad[8] = make_undefined(9, 3);
    memset(&bad[8].body.handle, 0, sizeof bad[8].body.handle);
    bad[9].placed.orientation_count = 2;
    memcpy(other_shape, bad[10].body.bytes, bad[10].body.size);
    other_shape[8] = 17;
    bad[10].body.bytes = other_shape;
    bad[11].placed.position[2] = NAN;
    static unsigned char
        longer[GEOMETRY_FRAME_BYTES_MAX + 8]; /* a number more than the frame has */
    const size_t size = bad[12].body.size;
    memcpy(longer, bad[12].body.bytes, size);
    longer[12]++;
    bad[12].body.number_count++;
    bad[12].body.bytes = longer;
    bad[12].body.size = size + 8;
    bad[13].velocity_count = 1;
    for (int i = 0; i < 14; i += 2) {
        const struct pair_query query = {.placement = {bad[i], bad[i + 1]}};
        expect_placements(&query, "[[9,-2],[9,-2]]");
    }
}

static void a_scene_has_all_its_placements(void **state)
{
    make_large_scene(0);
    scene.placement_count = QUERY_PLACEMENTS_MAX + 5;
    const struct replayed replayed = of_scene(&scene, NULL, NULL, REPLAY_UNRECORDED);
    cJSON *data = data_of_one(&replayed);
    const cJSON *event = event_at(data, 0);
    assert_int_equal(cJSON_GetArraySize(member(event, "frames")), QUERY_PLACEMENTS_MAX);
    assert_int_equal(number(event, "more_frames"), 5);
    expect_json(member(event, "pairs"), "[]");
    cJSON_Delete(data);
}

/* ---- Pairs ----------------------------------------------------------------------------------- */

static void results_of_a_pair_stand_side_by_side(void **state)
{
    struct pair_result then = overlapping(), now = overlapping();
    expect_answers(&then, &now, "[[0,1,[3,null,null,0.5,0.5,1,1]]]");
    expect_answers(&then, NULL, "[[0,1,[3,null,null,0.5,0.5,1,1],null]]");
    expect_answers(NULL, NULL, "[[0,1,null]]");
    then.answer.box[0][0] = -INFINITY;
    then.answer.box[1][1] = INFINITY;
    now.answer.has_contact = true;
    now.answer.contact[0] = 0.25;
    now.answer.contact[1] = 0.375;
    now.answer.has_box = false;
    expect_answers(&then, &now, "[[0,1,[3,null,null,null,0.5,1,null],[3,0.25,0.375]]]");
    now = then;
    now.answer.verdict = FMB_TOUCHING;
    now.answer.has_box = false;
    now.dim = 0;
    expect_answers(&then, &now, "[[0,1,[3,null,null,null,0.5,1,null],2]]");
    now.status = FMB_BUSY;
    expect_answers(&now, &then, "[[0,1,null,[3,null,null,null,0.5,1,null]]]");
}

static void invalid_ends_of_boxes_are_strings(void **state)
{
    struct pair_result now = overlapping();
    now.answer.box[0][0] = INFINITY;
    now.answer.box[0][1] = NAN;
    now.answer.box[1][0] = -INFINITY;
    expect_answers(&now, &now, "[[0,1,[3,null,null,\"inf\",\"NaN\",\"-inf\",1]]]");
}

static void gaps_come_last(void **state)
{
    struct pair_result then = overlapping(), now;
    struct fmb_gap *gap = &then.answer.gap;
    then.answer.has_gap = true;
    gap->bounds[0] = -INFINITY;
    gap->bounds[1] = -0.5;
    expect_answers(&then, &then, "[[0,1,[3,null,null,0.5,0.5,1,1,[null,-0.5]]]]");
    then.answer.has_box = false;
    then.answer.verdict = FMB_SEPARATED;
    gap->bounds[0] = 1;
    gap->bounds[1] = INFINITY;
    gap->has_witness = true;
    gap->time = 0.25;
    gap->witness[0][1] = 2;
    gap->witness[1][0] = -3;
    now = then;
    expect_answers(&then, &now, "[[0,1,[1,null,null,[1,null,0.25,0,2,-3,0]]]]");
    now.answer.gap.witness[1][1] = 4;
    expect_answers(&then, &now,
                   "[[0,1,[1,null,null,[1,null,0.25,0,2,-3,0]],"
                   "[1,null,null,[1,null,0.25,0,2,-3,4]]]]");
    now.answer.has_gap = false;
    expect_answers(&now, &then, "[[0,1,1,[1,null,null,[1,null,0.25,0,2,-3,0]]]]");
}

static void statuses_are_written(void **state)
{
    const struct pair_query query = pair_query(2);
    struct pair_result then = overlapping(), now = overlapping();
    const struct replayed replayed = of_pair(&query, &then, &now, REPLAY_BUSY);
    then.status = FMB_BUSY;
    strcpy(then.detail, "</script>\xff");
    then.method = 0;
    now.compute_ns = 1234;
    cJSON *data = data_of_one(&replayed);
    expect_json(member(event_at(data, 0), "then"),
                "{\"status\":2,\"says\":\"busy\",\"detail\":\"</script>\xef\xbf\xbd\","
                "\"method\":\"\",\"ns\":0}");
    expect_json(member(event_at(data, 0), "now"),
                "{\"status\":0,\"method\":\"certified\",\"ns\":1234}");
    cJSON_Delete(data);
}

static void a_different_certificate_is_reported(void **state)
{
    const struct pair_query query = pair_query(2);
    struct pair_result then = overlapping(), now = overlapping();
    const struct replayed replayed = of_pair(&query, &then, &now, REPLAY_DIFFERENT);
    static const char *const certificates[][2] = {
        {"a", "a"},  {NULL, NULL}, {"a", "b"},
        {NULL, "a"}, {"a", NULL},  {"separated + a0 a1 a2 b0", "separated + a0 a1 a2 b1"}};
    for (int i = 0; i < 6; i++) {
        then.certificate = certificates[i][0];
        now.certificate = certificates[i][1];
        cJSON *data = data_of_one(&replayed);
        assert_int_equal(cJSON_HasObjectItem(event_at(data, 0), "certificate"), i >= 2);
        cJSON_Delete(data);
    }
    for (int refused = 0; refused < 2; refused++) { /* has no certificate to differ from */
        struct pair_result *one = refused ? &now : &then, *other = refused ? &then : &now;
        *one = (struct pair_result){.status = FMB_BUSY};
        *other = overlapping();
        other->certificate = "a";
        cJSON *data = data_of_one(&replayed);
        assert_false(cJSON_HasObjectItem(event_at(data, 0), "certificate"));
        cJSON_Delete(data);
    }
}

/* ---- Pairs of scenes ------------------------------------------------------------------------- */

static void make_scene(int32_t which, int32_t bodies)
{
    memset(&scene, 0, sizeof scene);
    memset(&result_then, 0, sizeof result_then);
    scene.which = which;
    scene.placement_count = bodies;
    for (int i = 0; i < bodies; i++)
        scene.placement[i] = make_body(i + 1, 2, 1, i);
    for (unsigned i = 0; which == FMB_PAIRS_LISTED && i + 1 < (unsigned) bodies; i++) {
        scene.pair[i][0] = i;
        scene.pair[i][1] = i + 1;
    }
    scene.index_count = which == FMB_PAIRS_LISTED ? 2 * (bodies - 1) : 0;
}

static void add_verdict(struct scene_result *result, unsigned a, unsigned b, int verdict)
{
    result->pair[result->verdict_count][0] = a;
    result->pair[result->verdict_count][1] = b;
    result->verdict[result->verdict_count++] = (unsigned char) verdict;
    result->contact_count += verdict >= FMB_TOUCHING;
}

static void expect_scene(const char *expected)
{
    const struct replayed replayed = of_scene(&scene, &result_then, &result_now, REPLAY_DIFFERENT);
    expect_pairs(&replayed, expected);
}

static void listed_pairs_have_times_and_boxes(void **state)
{
    make_scene(FMB_PAIRS_LISTED, 5);
    add_verdict(&result_then, 0, 0, FMB_SEPARATED);
    add_verdict(&result_then, 0, 0, FMB_TOUCHING);
    add_verdict(&result_then, 0, 0, 0);
    add_verdict(&result_then, 0, 0, FMB_OVERLAPPING);
    result_then.has_times = result_then.has_boxes = true;
    result_then.dim = 2;
    static const double times[] = {0, 1, 0.25, 0.5}, boxes[] = {1, 2, 3, 4, 5, 6, 7, INFINITY};
    memcpy(result_then.times, times, sizeof times);
    memcpy(result_then.boxes, boxes, sizeof boxes);
    result_now = result_then;
    expect_scene("[[1,2,[2,0,1,1,2,3,4]],[3,4,[3,0.25,0.5,5,6,7,null]],[0,1,1],[2,3,0]]");
    result_now.times[3] = 0.75;
    expect_scene(
        "[[3,4,[3,0.25,0.5,5,6,7,null],[3,0.25,0.75,5,6,7,null]],"
        "[1,2,[2,0,1,1,2,3,4]],[0,1,1],[2,3,0]]");
}

/* As in the replay's comparison, whose count the page shows. */
static void times_that_differ_in_the_sign_of_zero_differ(void **state)
{
    make_scene(FMB_PAIRS_LISTED, 2);
    add_verdict(&result_then, 0, 0, FMB_TOUCHING);
    result_then.has_times = true;
    result_now = result_then;
    result_now.times[0] = -0.0;
    expect_scene("[[0,1,[2,0,0],[2,-0,0]]]");
}

/* The second of the pairs that are named is near; of the third there is none. */
static void named_pairs_have_gaps(void **state)
{
    make_scene(FMB_PAIRS_ALL, 3);
    scene.margin = 0.5;
    add_verdict(&result_then, 0, 1, FMB_TOUCHING);
    add_verdict(&result_then, 0, 2, FMB_SEPARATED);
    result_then.names_pairs = result_then.has_gaps = true;
    result_then.dim = 2;
    result_then.end_pair = 3;
    result_then.gap[1] =
        (struct fmb_gap){.bounds = {0.25, 0.5}, .has_witness = true, .witness = {{1, 2}, {3, 4}}};
    result_now = result_then;
    expect_scene("[[0,1,[2,null,null,[0,0]]],[0,2,[1,null,null,[0.25,0.5,0,1,2,3,4]]]]");
    result_now.verdict_count = 1;
    expect_scene("[[0,2,[1,null,null,[0.25,0.5,0,1,2,3,4]],1],[0,1,[2,null,null,[0,0]]]]");
}

static void without_times_and_boxes_a_pair_is_its_verdict(void **state)
{
    make_scene(FMB_PAIRS_LISTED, 3);
    add_verdict(&result_then, 0, 0, FMB_TOUCHING);
    add_verdict(&result_then, 0, 0, FMB_OVERLAPPING);
    result_then.has_times = true;
    static const double times[] = {0.5, 0.5, 0, 1};
    memcpy(result_then.times, times, sizeof times);
    result_now = result_then;
    expect_scene("[[0,1,[2,0.5,0.5]],[1,2,[3,0,1]]]");
    result_now.has_times = false;
    expect_scene("[[0,1,[2,0.5,0.5],2],[1,2,[3,0,1],3]]");
}

/* The second result has more pairs, and both begin with the second pair. */
static void partial_results_answer_some_pairs(void **state)
{
    make_scene(FMB_PAIRS_LISTED, 5);
    scene.first_pair = 1;
    add_verdict(&result_then, 0, 0, FMB_SEPARATED);
    result_now = result_then;
    add_verdict(&result_now, 0, 0, FMB_OVERLAPPING);
    expect_scene("[[2,3,null,3],[1,2,1]]");
    add_verdict(&result_now, 0, 0, FMB_SEPARATED);
    add_verdict(&result_now, 0, 0, FMB_SEPARATED); /* of a pair that is not in the query */
    expect_scene("[[2,3,null,3],[1,2,1],[3,4,null,1]]");
    scene.first_pair = INT32_MAX;
    expect_scene("[]");
    scene.first_pair = -1;
    expect_scene("[]");
}

static void pairs_not_named_are_separated(void **state)
{
    make_scene(FMB_PAIRS_ALL, 4); /* (0,1) (0,2) (0,3) (1,2) (1,3) (2,3) */
    result_then.names_pairs = true;
    result_then.end_pair = 6;
    result_now = result_then;
    add_verdict(&result_then, 0, 2, FMB_TOUCHING);
    add_verdict(&result_then, 1, 3, FMB_OVERLAPPING);
    add_verdict(&result_now, 0, 1, FMB_TOUCHING);
    add_verdict(&result_now, 1, 3, FMB_OVERLAPPING);
    add_verdict(&result_now, 2, 3, FMB_OVERLAPPING);
    expect_scene("[[0,1,1,2],[0,2,2,1],[2,3,1,3],[1,3,3]]");
    result_then.end_pair = 5; /* does not include the last pair */
    expect_scene("[[0,1,1,2],[0,2,2,1],[1,3,3],[2,3,null,3]]");
    result_now.status = FMB_BUSY;
    expect_scene("[[0,2,2,null],[1,3,3,null]]");
}

static void pairs_across_are_counted_across(void **state)
{
    make_scene(FMB_PAIRS_ACROSS, 5); /* (0,2) (0,3) (0,4) (1,2) (1,3) (1,4) */
    scene.split = 2;
    scene.first_pair = 1;
    result_then.names_pairs = true;
    result_then.end_pair = 4;
    result_now = result_then;
    result_now.end_pair = 6;
    add_verdict(&result_now, 0, 2, FMB_TOUCHING); /* before the first one */
    add_verdict(&result_now, 1, 2, FMB_TOUCHING);
    add_verdict(&result_now, 1, 3, FMB_TOUCHING);
    expect_scene("[[1,2,1,2],[0,2,null,2],[1,3,null,2]]");
    assert_int_equal(query_pair_count(&scene), 6);
}

static void verdicts_of_a_scene_are_counted(void **state)
{
    int64_t count[FMB_OVERLAPPING + 1];
    make_scene(FMB_PAIRS_ALL, 4);
    scene.first_pair = 1;
    result_then.names_pairs = true;
    result_then.end_pair = 6;
    add_verdict(&result_then, 0, 2, FMB_TOUCHING);
    add_verdict(&result_then, 1, 2, FMB_OVERLAPPING);
    replayed_count(&scene, &result_then, count);
    assert_int_equal(count[0], 0);
    assert_int_equal(count[FMB_SEPARATED], 3);
    assert_int_equal(count[FMB_TOUCHING], 1);
    assert_int_equal(count[FMB_OVERLAPPING], 1);
    assert_int_equal(query_pair_count(&scene), 6);
    replayed_count(&scene, NULL, count);
    assert_int_equal(count[FMB_SEPARATED], 0);
    make_scene(FMB_PAIRS_LISTED, 1);
    replayed_count(&scene, &result_then, count);
    assert_int_equal(count[FMB_SEPARATED], 0);
    assert_int_equal(query_pair_count(&scene), 0);
    make_scene(FMB_PAIRS_ALL, 0);
    assert_int_equal(query_pair_count(&scene), 0);
}

static void ignore(unsigned a, unsigned b)
{
    scene.ignored[scene.ignored_count / 2][0] = a;
    scene.ignored[scene.ignored_count / 2][1] = b;
    scene.ignored_count += 2;
}

static void ignored_pairs_are_not_counted(void **state)
{
    int64_t count[FMB_OVERLAPPING + 1];
    make_scene(FMB_PAIRS_ALL, 5); /* (0,1) to (0,4), (1,2) (1,3) (1,4), (2,3) ... */
    scene.first_pair = 1;
    result_then.names_pairs = true;
    result_then.end_pair = 8;
    add_verdict(&result_then, 0, 2, FMB_TOUCHING);
    add_verdict(&result_then, 0, 3, 0); /* not decided */
    assert_int_equal(replayed_decided(&scene, &result_then), 6);
    ignore(0, 1); /* before the first pair */
    ignore(4, 3); /* after the last one */
    ignore(2, 4);
    assert_int_equal(replayed_decided(&scene, &result_then), 6);
    ignore(1, 4);
    ignore(2, 1);
    ignore(1, 2);
    ignore(2, 3); /* the last one of the result */
    assert_int_equal(replayed_decided(&scene, &result_then), 3);
    replayed_count(&scene, &result_then, count);
    assert_int_equal(count[FMB_SEPARATED], 2);
    assert_int_equal(count[FMB_TOUCHING], 1);
    scene.placement[0].placed.group = scene.placement[2].placed.group = 7;
    scene.placement[3].placed.group = scene.placement[4].placed.group =
        -7; /* after the last pair */
    assert_int_equal(replayed_decided(&scene, &result_then), 2);
    result_then.status = FMB_BUSY;
    assert_int_equal(replayed_decided(&scene, &result_then), 0);

    make_scene(FMB_PAIRS_ACROSS, 5); /* (0,2) (0,3) (0,4) (1,2) (1,3) (1,4) */
    scene.split = 2;
    result_then.names_pairs = true;
    result_then.end_pair = 6;
    ignore(0, 1); /* not across */
    ignore(3, 4);
    assert_int_equal(replayed_decided(&scene, &result_then), 6);
    ignore(4, 1);
    ignore(0, 2);
    assert_int_equal(replayed_decided(&scene, &result_then), 4);
}

/* The last pair differs, the one before it touches. */
static void differing_pairs_are_kept_first(void **state)
{
    enum { PAIRS = 1064 };
    make_scene(FMB_PAIRS_LISTED, 2);
    scene.index_count = 2 * PAIRS;
    for (unsigned i = 0; i < PAIRS; i++) {
        scene.pair[i][0] = i;
        scene.pair[i][1] = i + 1;
    }
    for (int i = 0; i < PAIRS - 1; i++)
        add_verdict(&result_then, 0, 0, i == PAIRS - 2 ? FMB_TOUCHING : FMB_SEPARATED);
    result_now = result_then;
    add_verdict(&result_then, 0, 0, FMB_TOUCHING);
    add_verdict(&result_now, 0, 0, FMB_SEPARATED);
    const struct replayed replayed = of_scene(&scene, &result_then, &result_now, REPLAY_DIFFERENT);
    cJSON *data = data_of_one(&replayed);
    const cJSON *event = event_at(data, 0), *pairs = member(event, "pairs");
    assert_int_equal(cJSON_GetArraySize(pairs), PAGE_PAIRS_MAX);
    assert_int_equal(number(event, "more"), PAIRS - PAGE_PAIRS_MAX);
    expect_json(cJSON_GetArrayItem(pairs, 0), "[1063,1064,2,1]");
    expect_json(cJSON_GetArrayItem(pairs, 1), "[1062,1063,2]");
    expect_json(cJSON_GetArrayItem(pairs, 2), "[0,1,1]");
    cJSON_Delete(data);
}

/* Hostile logs: indices beyond the placements, counts that do not agree. */
static void results_that_do_not_match_the_query_are_harmless(void **state)
{
    make_scene(FMB_PAIRS_ALL, 2);
    result_then.names_pairs = true;
    result_then.end_pair = INT32_MAX;
    add_verdict(&result_then, 3, 1064, FMB_OVERLAPPING);
    result_then.contact_count = 0; /* so that there are no numbers for it */
    result_then.has_times = result_then.has_boxes = true;
    result_then.dim = 3;
    result_now = result_then;
    result_now.verdict_count = 0;
    expect_scene("[[3,1064,3,1]]");
    scene.placement_count = 0;
    scene.split = INT32_MIN;
    scene.which = FMB_PAIRS_ACROSS;
    expect_scene("[[3,1064,3,null]]");
    result_now.names_pairs = false;
    result_now.verdict_count = 5;
    scene.which = INT32_MIN;
    expect_scene("[[3,1064,3,1]]");
    scene.which = FMB_PAIRS_LISTED;
    scene.index_count = 1;
    expect_scene("[]");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_empty_page_is_whole),
        cmocka_unit_test(outcomes_are_counted_and_logs_named),
        cmocka_unit_test(beyond_the_event_limit_only_differences_are_kept),
        cmocka_unit_test(differences_count_towards_the_limit),
        cmocka_unit_test(beyond_the_byte_limit_only_differences_are_kept),
        cmocka_unit_test(shapes_are_kept_once),
        cmocka_unit_test(bodies_by_handle_that_are_not_defined_are_named),
        cmocka_unit_test(bodies_have_frames_and_poses),
        cmocka_unit_test(bodies_that_cannot_be_drawn_are_named),
        cmocka_unit_test(a_scene_has_all_its_placements),
        cmocka_unit_test(results_of_a_pair_stand_side_by_side),
        cmocka_unit_test(invalid_ends_of_boxes_are_strings),
        cmocka_unit_test(gaps_come_last),
        cmocka_unit_test(statuses_are_written),
        cmocka_unit_test(a_different_certificate_is_reported),
        cmocka_unit_test(listed_pairs_have_times_and_boxes),
        cmocka_unit_test(times_that_differ_in_the_sign_of_zero_differ),
        cmocka_unit_test(named_pairs_have_gaps),
        cmocka_unit_test(without_times_and_boxes_a_pair_is_its_verdict),
        cmocka_unit_test(partial_results_answer_some_pairs),
        cmocka_unit_test(pairs_not_named_are_separated),
        cmocka_unit_test(pairs_across_are_counted_across),
        cmocka_unit_test(verdicts_of_a_scene_are_counted),
        cmocka_unit_test(ignored_pairs_are_not_counted),
        cmocka_unit_test(differing_pairs_are_kept_first),
        cmocka_unit_test(results_that_do_not_match_the_query_are_harmless),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
