/* The page of a replay: what it keeps of the queries, and how it writes it, whatever they hold. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "page.h"
#include "page_event.h"
#include "page_pairs.h"

#include <cjson/cJSON.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

/* The data as text, ended where a browser sees their end; to be freed. */
static char *data_text(const struct page *page)
{
    char *text = write_page(page), *begin = strstr(text, data_begin);
    assert_non_null(begin);
    char *end = strstr(begin, "</script>");
    assert_non_null(end);
    /* Behind them the page goes on. */
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

/* The value without white space, so that it can be compared. */
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

static struct query_frame make_frame(int64_t id, int dim, double size, double at)
{
    struct query_frame frame;
    memset(&frame, 0, sizeof frame);
    frame.body_id = id;
    frame.shape = FMB_CUBOID;
    frame.dim = frame.origin.count = dim;
    frame.components.count = dim * dim;
    for (int i = 0; i < dim; i++) {
        frame.origin.number[i] = at;
        frame.components.number[i * dim + i] = size;
    }
    return frame;
}

static struct pair_query pair_query(int dim)
{
    return (struct pair_query){.duration = 1,
                               .want = QUERY_WANT_BOX,
                               .frame = {make_frame(1, dim, 1, 0), make_frame(2, dim, 1, 0.5)}};
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

/* The data of a page that took this one in. */
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

/* A pair of one verdict, contact and box beside another. */
static void expect_answers(const struct pair_result *then, const struct pair_result *now,
                           const char *expected)
{
    const struct pair_query query = pair_query(2);
    const struct replayed replayed = of_pair(&query, then, now, REPLAY_DIFFERENT);
    expect_pairs(&replayed, expected);
}

/* ---- JSON ------------------------------------------------------------------------------------ */

static void expect_escaped(const char *text, const char *expected)
{
    struct page_json json = {0};
    page_json_string(&json, text);
    assert_int_equal(json.used, strlen(expected));
    assert_memory_equal(json.bytes, expected, json.used);
    page_json_clear(&json);
}

static void strings_are_escaped(void **state)
{
    (void) state;
    expect_escaped("", "\"\"");
    expect_escaped("a \"b\" \\ c/d", "\"a \\u0022b\\u0022 \\u005c c/d\"");
    expect_escaped("</script><!-- & ]]>", "\"\\u003c/script\\u003e\\u003c!-- \\u0026 ]]\\u003e\"");
    expect_escaped("\x01\t\n\x7f", "\"\\u0001\\u0009\\u000a\\u007f\"");
    expect_escaped("\xc3\xa4 \xe2\x82\xac \xf0\x9f\x98\x80",
                   "\"\xc3\xa4 \xe2\x82\xac \xf0\x9f\x98\x80\"");
    expect_escaped("\xf4\x8f\xbf\xbf\xed\x9f\xbf", "\"\xf4\x8f\xbf\xbf\xed\x9f\xbf\"");
}

/* Overlong forms, surrogates, what is cut off or begins nowhere. */
static void what_is_no_utf8_is_replaced(void **state)
{
    static const char *const bad[] = {"\x80",
                                      "\xff",
                                      "\xc0\xaf",
                                      "\xc1\xbf",
                                      "\xe0\x9f\xbf",
                                      "\xed\xa0\x80",
                                      "\xc3",
                                      "\xe2\x82",
                                      "\xf0\x8f\xbf\xbf",
                                      "\xf4\x90\x80\x80",
                                      "\xf5\x80\x80\x80",
                                      "\xf0\x9f\x98"};
    (void) state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char expected[64] = "\"", text[16];
        for (size_t k = 0; k < strlen(bad[i]); k++)
            strcat(expected, "\\ufffd");
        snprintf(text, sizeof text, "%s<", bad[i]);
        strcat(expected, "\\u003c\"");
        expect_escaped(text, expected);
    }
}

static void numbers_are_exact_or_null(void **state)
{
    static const struct {
        double value;
        const char *text;
    } cases[] = {{0.1, "0.1"},
                 {1.0 / 3, "0.3333333333333333"},
                 {5e-324, "4.94065645841247e-324"},
                 {DBL_MAX, "1.7976931348623157e+308"},
                 {-0.0, "-0"},
                 {INFINITY, "null"},
                 {-INFINITY, "null"},
                 {NAN, "null"}};
    (void) state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct page_json json = {0};
        page_json_number(&json, cases[i].value);
        assert_int_equal(json.used, strlen(cases[i].text));
        assert_memory_equal(json.bytes, cases[i].text, json.used);
        page_json_clear(&json);
    }
}

static void integers_that_doubles_lose_are_strings(void **state)
{
    struct page_json json = {0};
    (void) state;
    page_json_integer(&json, QUERY_ID_MAX);
    page_json_raw(&json, " ");
    page_json_integer(&json, -QUERY_ID_MAX - 1);
    page_json_raw(&json, " ");
    page_json_integer(&json, INT64_MAX);
    page_json_raw(&json, "");
    static const char expected[] = "9007199254740991 \"-9007199254740992\" \"9223372036854775807\"";
    assert_int_equal(json.used, sizeof expected - 1);
    assert_memory_equal(json.bytes, expected, json.used);
    page_json_clear(&json);
}

/* ---- The whole ------------------------------------------------------------------------------- */

static void an_empty_page_is_whole(void **state)
{
    struct page *page = page_open("</script><script>alert(1)</script><!--", BEGIN);
    (void) state;
    cJSON *data = data_of(page);
    assert_string_equal(member(data, "title")->valuestring,
                        "</script><script>alert(1)</script><!--");
    expect_json(member(data, "count"), "[0,0,0,0,0]");
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
    (void) state;
    for (int outcome = REPLAY_SAME; outcome <= REPLAY_ALONE; outcome++) {
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
    expect_json(member(data, "count"), "[1,2,3,4,5]");
    expect_json(member(data, "left_out"), "[0,0,0,0,0]");
    expect_json(member(data, "span"), "[1.714557599999e+15,1.7145576e+15]");
    expect_json(member(data, "logs"),
                "[\"\xef\xbf\xbd"
                "0.log\",\"\xef\xbf\xbd"
                "1.log\",\"\xef\xbf\xbd"
                "2.log\"]");
    assert_int_equal(cJSON_GetArraySize(member(data, "events")), 15);
    assert_int_equal(number(event_at(data, 14), "log"), 1);
    assert_int_equal(number(event_at(data, 14), "is"), REPLAY_ALONE);
    cJSON_Delete(data);
    page_close(page);
}

/* ---- Limits ---------------------------------------------------------------------------------- */

static void beyond_the_events_differences_alone_are_kept(void **state)
{
    const struct pair_query query = pair_query(2);
    const struct pair_result result = overlapping();
    struct replayed replayed = of_pair(&query, &result, &result, REPLAY_SAME);
    struct page *page = page_open("many", BEGIN);
    (void) state;
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
    expect_json(member(data, "count"), "[5010,1003,1,0,0]");
    expect_json(member(data, "left_out"), "[10,3,1,0,0]");
    expect_json(member(data, "left_span"), "[1.714557600005e+15,1714557600006013]");
    cJSON_Delete(data);
    page_close(page);
}

static void a_difference_that_is_kept_makes_no_room(void **state)
{
    const struct pair_query query = pair_query(2);
    const struct pair_result result = overlapping();
    struct replayed replayed = of_pair(&query, &result, &result, REPLAY_DIFFERENT);
    struct page *page = page_open("many", BEGIN);
    (void) state;
    for (int i = 0; i < PAGE_EVENTS_MAX + 1; i++)
        page_take(page, &replayed);
    replayed.outcome = REPLAY_SAME;
    page_take(page, &replayed);
    cJSON *data = data_of(page);
    expect_json(member(data, "left_out"), "[1,0,0,0,0]");
    cJSON_Delete(data);
    page_close(page);
}

static struct scene_query scene;
static struct scene_result result_then, result_now;

/* As many frames as there may be; numbers of fifteen digits, which no other scene has. */
static void make_large_scene(int step)
{
    memset(&scene, 0, sizeof scene);
    scene.duration = 1;
    scene.which = QUERY_PAIRS_ALL;
    scene.frame_count = QUERY_FRAMES_MAX;
    for (int i = 0; i < QUERY_FRAMES_MAX; i++) {
        scene.frame[i] = make_frame(i + 1, 3, 1, i);
        for (int k = 0; k < 9; k++)
            scene.frame[i].components.number[k] =
                (1e14 + 9 * (step * QUERY_FRAMES_MAX + i) + k) / 1e14;
    }
}

static void beyond_the_bytes_differences_alone_are_kept(void **state)
{
    const int enough = 300;
    struct page *page = page_open("large", BEGIN);
    int64_t taken[] = {0, 0};
    (void) state;
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

/* ---- Frames ---------------------------------------------------------------------------------- */

static void shapes_are_kept_once(void **state)
{
    struct page *page = page_open("rigid", BEGIN);
    (void) state;
    for (int i = 0; i < 200; i++) {
        struct pair_query query = pair_query(2);
        struct replayed replayed = of_pair(&query, NULL, NULL, REPLAY_ALONE);
        query.frame[0] = make_frame(1, 2, 1 + i % 100, i);
        query.frame[1] = make_frame(2, 3, 1 + i % 100, i);
        query.frame[1].velocity = query.frame[1].origin;
        page_take(page, &replayed);
    }
    cJSON *data = data_of(page);
    const cJSON *shapes = member(data, "shapes");
    assert_int_equal(cJSON_GetArraySize(shapes), 200);
    expect_json(cJSON_GetArrayItem(shapes, 6), "{\"shape\":1,\"dim\":2,\"c\":[4,0,0,4]}");
    expect_json(member(event_at(data, 103), "frames"),
                "[[1,6,103,103],[2,7,103,103,103,103,103,103]]");
    cJSON_Delete(data);
    page_close(page);
}

static void frames_that_cannot_be_drawn_are_named(void **state)
{
    struct pair_query query = pair_query(2);
    const struct replayed replayed = of_pair(&query, NULL, NULL, REPLAY_UNKNOWN);
    (void) state;
    query.frame[0].components.count = 0;
    query.frame[0].key = 4711;
    query.frame[1].components.count = 0;
    cJSON *data = data_of_one(&replayed);
    expect_json(member(event_at(data, 0), "frames"), "[[1,-1,4711],[2,-2]]");
    cJSON_Delete(data);
    struct query_frame bad[8];
    for (int i = 0; i < 8; i++)
        bad[i] = make_frame(9, 3, 1, 0);
    bad[0].components.number[8] = NAN;
    bad[1].origin.number[0] = -INFINITY;
    bad[2].shape = 17;
    bad[3].dim = 4;
    bad[4].components.count = INT32_MAX;
    bad[5].velocity.count = 2;
    bad[6].origin.count = -1;
    bad[7] = make_frame(9, 3, 1, 0);
    bad[7].velocity.count = 3;
    bad[7].velocity.number[2] = INFINITY;
    for (int i = 0; i < 8; i += 2) {
        query.frame[0] = bad[i];
        query.frame[1] = bad[i + 1];
        data = data_of_one(&replayed);
        expect_json(member(event_at(data, 0), "frames"), "[[9,-2],[9,-2]]");
        cJSON_Delete(data);
    }
}

static void a_scene_has_all_its_frames(void **state)
{
    (void) state;
    make_large_scene(0);
    scene.frame_count = QUERY_FRAMES_MAX + 5;
    const struct replayed replayed = of_scene(&scene, NULL, NULL, REPLAY_ALONE);
    cJSON *data = data_of_one(&replayed);
    const cJSON *event = event_at(data, 0);
    assert_int_equal(cJSON_GetArraySize(member(event, "frames")), QUERY_FRAMES_MAX);
    assert_int_equal(number(event, "more_frames"), 5);
    expect_json(member(event, "pairs"), "[]");
    cJSON_Delete(data);
}

/* ---- Pairs ----------------------------------------------------------------------------------- */

static void results_of_a_pair_stand_side_by_side(void **state)
{
    struct pair_result then = overlapping(), now = overlapping();
    (void) state;
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

static void ends_of_boxes_that_are_no_ends_are_words(void **state)
{
    struct pair_result now = overlapping();
    (void) state;
    now.answer.box[0][0] = INFINITY;
    now.answer.box[0][1] = NAN;
    now.answer.box[1][0] = -INFINITY;
    expect_answers(&now, &now, "[[0,1,[3,null,null,\"inf\",\"NaN\",\"-inf\",1]]]");
}

static void statuses_are_said(void **state)
{
    const struct pair_query query = pair_query(2);
    struct pair_result then = overlapping(), now = overlapping();
    const struct replayed replayed = of_pair(&query, &then, &now, REPLAY_BUSY);
    (void) state;
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

static void another_certificate_is_said(void **state)
{
    const struct pair_query query = pair_query(2);
    struct pair_result then = overlapping(), now = overlapping();
    const struct replayed replayed = of_pair(&query, &then, &now, REPLAY_DIFFERENT);
    static const char *const certificates[][2] = {
        {"a", "a"}, {NULL, NULL}, {"a", "b"}, {NULL, "a"}, {"a", NULL}};
    (void) state;
    for (int i = 0; i < 5; i++) {
        then.certificate = certificates[i][0];
        now.certificate = certificates[i][1];
        cJSON *data = data_of_one(&replayed);
        assert_int_equal(cJSON_HasObjectItem(event_at(data, 0), "certificate"), i >= 2);
        cJSON_Delete(data);
    }
}

/* ---- Pairs of scenes ------------------------------------------------------------------------- */

static void make_scene(int32_t which, int32_t frames)
{
    memset(&scene, 0, sizeof scene);
    memset(&result_then, 0, sizeof result_then);
    scene.which = which;
    scene.frame_count = frames;
    for (int i = 0; i < frames; i++)
        scene.frame[i] = make_frame(i + 1, 2, 1, i);
    for (unsigned i = 0; which == QUERY_PAIRS_LISTED && i + 1 < (unsigned) frames; i++) {
        scene.pair[i][0] = i;
        scene.pair[i][1] = i + 1;
    }
    scene.index_count = which == QUERY_PAIRS_LISTED ? 2 * (frames - 1) : 0;
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

/* NaN stands for the times of a pair at rest. */
static void listed_pairs_have_times_and_boxes(void **state)
{
    (void) state;
    make_scene(QUERY_PAIRS_LISTED, 5);
    add_verdict(&result_then, 0, 0, FMB_SEPARATED);
    add_verdict(&result_then, 0, 0, FMB_TOUCHING);
    add_verdict(&result_then, 0, 0, 0);
    add_verdict(&result_then, 0, 0, FMB_OVERLAPPING);
    result_then.has_times = result_then.has_boxes = true;
    result_then.dim = 2;
    static const double times[] = {NAN, NAN, 0.25, 0.5}, boxes[] = {1, 2, 3, 4, 5, 6, 7, INFINITY};
    memcpy(result_then.times, times, sizeof times);
    memcpy(result_then.boxes, boxes, sizeof boxes);
    result_now = result_then;
    expect_scene("[[1,2,[2,null,null,1,2,3,4]],[3,4,[3,0.25,0.5,5,6,7,null]],[0,1,1],[2,3,0]]");
    result_now.times[3] = 0.75;
    expect_scene(
        "[[3,4,[3,0.25,0.5,5,6,7,null],[3,0.25,0.75,5,6,7,null]],"
        "[1,2,[2,null,null,1,2,3,4]],[0,1,1],[2,3,0]]");
}

static void without_times_or_boxes_a_verdict_stands_alone(void **state)
{
    (void) state;
    make_scene(QUERY_PAIRS_LISTED, 3);
    add_verdict(&result_then, 0, 0, FMB_TOUCHING);
    add_verdict(&result_then, 0, 0, FMB_OVERLAPPING);
    result_then.has_times = true;
    static const double times[] = {NAN, NAN, 0, 1};
    memcpy(result_then.times, times, sizeof times);
    result_now = result_then;
    expect_scene("[[0,1,2],[1,2,[3,0,1]]]");
    result_now.has_times = false;
    expect_scene("[[1,2,[3,0,1],3],[0,1,2]]");
}

/* The second result came farther, and both begin with the second pair. */
static void results_of_a_part_answer_a_part(void **state)
{
    (void) state;
    make_scene(QUERY_PAIRS_LISTED, 5);
    scene.first_pair = 1;
    add_verdict(&result_then, 0, 0, FMB_SEPARATED);
    result_now = result_then;
    add_verdict(&result_now, 0, 0, FMB_OVERLAPPING);
    expect_scene("[[2,3,null,3],[1,2,1]]");
    add_verdict(&result_now, 0, 0, FMB_SEPARATED);
    add_verdict(&result_now, 0, 0, FMB_SEPARATED); /* of a pair that was not asked */
    expect_scene("[[2,3,null,3],[1,2,1],[3,4,null,1]]");
    scene.first_pair = INT32_MAX;
    expect_scene("[]");
    scene.first_pair = -1;
    expect_scene("[]");
}

static void of_all_pairs_those_not_named_are_separated(void **state)
{
    (void) state;
    make_scene(QUERY_PAIRS_ALL, 4); /* (0,1) (0,2) (0,3) (1,2) (1,3) (2,3) */
    result_then.names_pairs = true;
    result_then.end_pair = 6;
    result_now = result_then;
    add_verdict(&result_then, 0, 2, FMB_TOUCHING);
    add_verdict(&result_then, 1, 3, FMB_OVERLAPPING);
    add_verdict(&result_now, 0, 1, FMB_TOUCHING);
    add_verdict(&result_now, 1, 3, FMB_OVERLAPPING);
    add_verdict(&result_now, 2, 3, FMB_OVERLAPPING);
    expect_scene("[[0,1,1,2],[0,2,2,1],[2,3,1,3],[1,3,3]]");
    result_then.end_pair = 5; /* says nothing of the last one */
    expect_scene("[[0,1,1,2],[0,2,2,1],[1,3,3],[2,3,null,3]]");
    result_now.status = FMB_BUSY;
    expect_scene("[[0,2,2,null],[1,3,3,null]]");
}

static void pairs_across_are_counted_across(void **state)
{
    (void) state;
    make_scene(QUERY_PAIRS_ACROSS, 5); /* (0,2) (0,3) (0,4) (1,2) (1,3) (1,4) */
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
    assert_int_equal(page_pairs_total(&scene), 6);
}

static void verdicts_of_a_scene_are_counted(void **state)
{
    int64_t count[FMB_OVERLAPPING + 1];
    (void) state;
    make_scene(QUERY_PAIRS_ALL, 4);
    scene.first_pair = 1;
    result_then.names_pairs = true;
    result_then.end_pair = 6;
    add_verdict(&result_then, 0, 2, FMB_TOUCHING);
    add_verdict(&result_then, 1, 2, FMB_OVERLAPPING);
    page_pairs_count(&scene, &result_then, count);
    assert_int_equal(count[0], 0);
    assert_int_equal(count[FMB_SEPARATED], 3);
    assert_int_equal(count[FMB_TOUCHING], 1);
    assert_int_equal(count[FMB_OVERLAPPING], 1);
    assert_int_equal(page_pairs_total(&scene), 6);
    page_pairs_count(&scene, NULL, count);
    assert_int_equal(count[FMB_SEPARATED], 0);
    make_scene(QUERY_PAIRS_LISTED, 1);
    page_pairs_count(&scene, &result_then, count);
    assert_int_equal(count[FMB_SEPARATED], 0);
    assert_int_equal(page_pairs_total(&scene), 0);
    make_scene(QUERY_PAIRS_ALL, 0);
    assert_int_equal(page_pairs_total(&scene), 0);
}

/* The last pair differs, the last but one meets. */
static void of_too_many_pairs_the_worst_are_kept(void **state)
{
    enum { FRAMES = QUERY_FRAMES_MAX };
    (void) state;
    make_scene(QUERY_PAIRS_LISTED, FRAMES);
    for (int i = 0; i < FRAMES - 2; i++)
        add_verdict(&result_then, 0, 0, i == FRAMES - 3 ? FMB_TOUCHING : FMB_SEPARATED);
    result_now = result_then;
    add_verdict(&result_then, 0, 0, FMB_TOUCHING);
    add_verdict(&result_now, 0, 0, FMB_SEPARATED);
    const struct replayed replayed = of_scene(&scene, &result_then, &result_now, REPLAY_DIFFERENT);
    cJSON *data = data_of_one(&replayed);
    const cJSON *event = event_at(data, 0), *pairs = member(event, "pairs");
    assert_int_equal(cJSON_GetArraySize(pairs), PAGE_PAIRS_MAX);
    assert_int_equal(number(event, "more"), FRAMES - 1 - PAGE_PAIRS_MAX);
    expect_json(cJSON_GetArrayItem(pairs, 0), "[1398,1399,2,1]");
    expect_json(cJSON_GetArrayItem(pairs, 1), "[1397,1398,2]");
    expect_json(cJSON_GetArrayItem(pairs, 2), "[0,1,1]");
    cJSON_Delete(data);
}

/* Of a log that anybody may have written: indices of no frame, counts that do not agree. */
static void results_that_do_not_fit_the_query_do_no_harm(void **state)
{
    (void) state;
    make_scene(QUERY_PAIRS_ALL, 2);
    result_then.names_pairs = true;
    result_then.end_pair = INT32_MAX;
    add_verdict(&result_then, 3, 1399, FMB_OVERLAPPING);
    result_then.contact_count = 0; /* so that there are no numbers for it */
    result_then.has_times = result_then.has_boxes = true;
    result_then.dim = 3;
    result_now = result_then;
    result_now.verdict_count = 0;
    expect_scene("[[3,1399,3,1]]");
    scene.frame_count = INT32_MIN;
    scene.split = INT32_MIN;
    scene.which = QUERY_PAIRS_ACROSS;
    expect_scene("[[3,1399,3,null]]");
    result_now.names_pairs = false;
    result_now.verdict_count = 5;
    scene.which = INT32_MIN;
    expect_scene("[[3,1399,3,1]]");
    scene.which = QUERY_PAIRS_LISTED;
    scene.index_count = -7;
    expect_scene("[]");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strings_are_escaped),
        cmocka_unit_test(what_is_no_utf8_is_replaced),
        cmocka_unit_test(numbers_are_exact_or_null),
        cmocka_unit_test(integers_that_doubles_lose_are_strings),
        cmocka_unit_test(an_empty_page_is_whole),
        cmocka_unit_test(outcomes_are_counted_and_logs_named),
        cmocka_unit_test(beyond_the_events_differences_alone_are_kept),
        cmocka_unit_test(a_difference_that_is_kept_makes_no_room),
        cmocka_unit_test(beyond_the_bytes_differences_alone_are_kept),
        cmocka_unit_test(shapes_are_kept_once),
        cmocka_unit_test(frames_that_cannot_be_drawn_are_named),
        cmocka_unit_test(a_scene_has_all_its_frames),
        cmocka_unit_test(results_of_a_pair_stand_side_by_side),
        cmocka_unit_test(ends_of_boxes_that_are_no_ends_are_words),
        cmocka_unit_test(statuses_are_said),
        cmocka_unit_test(another_certificate_is_said),
        cmocka_unit_test(listed_pairs_have_times_and_boxes),
        cmocka_unit_test(without_times_or_boxes_a_verdict_stands_alone),
        cmocka_unit_test(results_of_a_part_answer_a_part),
        cmocka_unit_test(of_all_pairs_those_not_named_are_separated),
        cmocka_unit_test(pairs_across_are_counted_across),
        cmocka_unit_test(verdicts_of_a_scene_are_counted),
        cmocka_unit_test(of_too_many_pairs_the_worst_are_kept),
        cmocka_unit_test(results_that_do_not_fit_the_query_do_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
