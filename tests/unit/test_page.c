/* The page of --html: its data, its limits, and hostile texts and numbers. */

#include "unit.h"

#include "page.h"

#include <cjson/cJSON.h>
#include <float.h>
#include <math.h>
#include <zlib.h>

/* ---- Tools ----------------------------------------------------------------------------------- */

static struct page *open_page(enum page_kind kind)
{
    return page_open(
        &(struct page_options){.kind = kind, .title = "title", .sides = {"then", "now"}});
}

/* Returns the bytes that an element holds, and a 0; to be freed. */
static char *unpack(const char *page, const char *id, size_t *size)
{
    static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    enum { BYTES_MAX = 1 << 26 };
    char tag[60];
    snprintf(tag, sizeof tag, "<script type=\"text/plain\" id=\"%s\">\n", id);
    const char *at = strstr(page, tag);
    assert_non_null(at);
    at += strlen(tag);
    const char *end = strstr(at, "\n</script>\n");
    assert_non_null(end);
    assert_int_equal((end - at) % 4, 0);
    unsigned char *packed = malloc((size_t) (end - at));
    char *bytes = malloc(BYTES_MAX);
    uLong packed_size = 0;
    uLongf unpacked_size = BYTES_MAX - 1;
    assert_true(packed && bytes);
    for (; at < end; at += 4) {
        unsigned bits = 0, count = 0;
        for (int k = 0; k < 4; k++) {
            bits = bits << 6 | (at[k] == '=' ? 0 : (unsigned) (strchr(digit, at[k]) - digit));
            count += at[k] != '=';
        }
        for (unsigned k = 0; k + 1 < count; k++)
            packed[packed_size++] = (unsigned char) (bits >> (16 - 8 * k));
    }
    assert_int_equal(uncompress((Bytef *) bytes, &unpacked_size, packed, packed_size), Z_OK);
    *size = unpacked_size;
    bytes[*size] = '\0';
    free(packed);
    return bytes;
}

/* Writes and closes the page. Returns its text, to be freed. */
static char *text_of(struct page *page, size_t *size)
{
    char *text = NULL;
    FILE *out = open_memstream(&text, size);
    assert_non_null(out);
    page_write(page, out);
    assert_int_equal(fclose(out), 0);
    assert_int_equal(strlen(text), *size);
    page_close(page);
    return text;
}

/* Writes and closes the page. Returns the text of its data, to be freed; *size: of the page. */
static char *data_text_of(struct page *page, size_t *size)
{
    size_t data_size;
    char *text = text_of(page, size), *data = unpack(text, "data", &data_size);
    free(text);
    return data;
}

/* Writes and closes the page. Returns its data, to be deleted. */
static cJSON *data_of(struct page *page)
{
    size_t size;
    char *text = data_text_of(page, &size);
    cJSON *data = cJSON_Parse(text);
    assert_non_null(data);
    free(text);
    return data;
}

/* Writes and closes the page. Returns its numbers, to be freed, those of its steps still as
 * differences. */
static uint32_t *numbers_of(struct page *page, size_t *count, cJSON **data)
{
    size_t size, data_size;
    char *text = text_of(page, &size), *json = unpack(text, "data", &data_size);
    unsigned char *bytes = (unsigned char *) unpack(text, "numbers", &size);
    *count = size / 4;
    uint32_t *number = calloc(*count + 1, sizeof *number);
    assert_non_null(number);
    for (size_t i = 0; i < size; i++)
        number[i % *count] |= (uint32_t) bytes[i] << 8 * (i / *count);
    *data = cJSON_Parse(json);
    free(text);
    free(json);
    free(bytes);
    return number;
}

/* Decodes zigzag code: numbers_add_step() in page.c. */
static int32_t difference(uint32_t word)
{
    return word & 1 ? -(int32_t) (word >> 1) - 1 : (int32_t) (word >> 1);
}

static const cJSON *member(const cJSON *object, const char *name)
{
    const cJSON *found = cJSON_GetObjectItemCaseSensitive(object, name);
    if (!found)
        fail_msg("there is no %s", name);
    return found;
}

static void expect_json(const cJSON *value, const char *expected)
{
    char *text = cJSON_PrintUnformatted(value);
    assert_string_equal(text, expected);
    cJSON_free(text);
}

/* Adds a box; orientation may be NULL. */
static void add_turned(struct page *page, int64_t id, const char *name, const double position[3],
                       const double orientation[4])
{
    static const double numbers[6] = {0, 0, 0, 1, 2, 3};
    struct fmb_body body;
    struct fmb_placement placement = {.body = &body, .id = id, .name = name};
    assert_int_equal(fmb_body_make(3, FMB_BOX, numbers, 6, &body), FMB_OK);
    memcpy(placement.position, position, sizeof placement.position);
    placement.orientation_count = orientation ? 4 : 0;
    if (orientation)
        memcpy(placement.orientation, orientation, sizeof placement.orientation);
    page_body(page, &placement, NULL);
}

static void add_box(struct page *page, int64_t id, const char *name, const double position[3])
{
    add_turned(page, id, name, position, NULL);
}

static const double zero[3];

static void begin_step(struct page *page, double time, bool differs)
{
    page_step_begin(
        page, &(struct page_step){
                  .time = time, .duration = 1, .log = "a.log", .outcome = {"compared", differs}});
}

static void add_pair(struct page *page, unsigned a, unsigned b, enum fmb_verdict verdict)
{
    const struct fmb_answer answer = {.verdict = verdict};
    page_pair(page, a, b, 3, NULL, &(struct page_answer){.answer = &answer});
}

/* ---- Data ------------------------------------------------------------------------------------ */

static void bodies_and_shapes_are_stored_once(void **state)
{
    struct page *page = open_page(PAGE_SCENES);
    for (int i = 0; i < 3; i++) {
        begin_step(page, i, false);
        add_box(page, 1, "table", zero);
        add_box(page, i == 2 ? 3 : 2, NULL, zero);
        page_step_end(page);
    }
    cJSON *data = data_of(page);
    expect_json(member(data, "shapes"), "[{\"dim\":3,\"frames\":[4,0,6,0,0,0,1,2,3]}]");
    expect_json(member(data, "casts"), "[[[1,0,\"table\"],[2,0]],[[1,0,\"table\"],[3,0]]]");
    expect_json(member(data, "logs"), "[\"a.log\"]");
    assert_int_equal(cJSON_GetArraySize(member(data, "steps")), 3);
    cJSON_Delete(data);
}

static void answers_that_differ_have_all_digits(void **state)
{
    struct page *page = open_page(PAGE_REPLAY);
    struct fmb_answer then = {
        .verdict = FMB_OVERLAPPING, .has_contact = true, .contact = {0, 1. / 3}};
    struct fmb_answer now = then;
    now.contact[1] = nextafter(now.contact[1], 1);
    begin_step(page, 0, true);
    page_pair(page, 0, 1, 3, NULL, &(struct page_answer){.answer = &now});
    page_pair(page, 0, 2, 3, &(struct page_answer){.answer = &then},
              &(struct page_answer){.answer = &now});
    page_pair(page, 0, 3, 3, NULL, &(struct page_answer){.error = "busy"});
    page_step_end(page);
    size_t size;
    char *text = data_text_of(page, &size);
    assert_non_null(strstr(text, "[0,1,[3,0,0.333333333]]"));
    assert_non_null(strstr(text, "[0,2,[3,0,0.3333333333333333],[3,0,0.33333333333333337]]"));
    assert_non_null(strstr(text, "[0,3,\"busy\"]"));
    free(text);
}

static void boxes_and_gaps_have_their_numbers(void **state)
{
    struct page *page = open_page(PAGE_SCENES);
    const struct fmb_answer answer = {
        .verdict = FMB_SEPARATED,
        .has_box = true,
        .box = {{-INFINITY, 0}, {1, INFINITY}},
        .has_gap = true,
        .gap = {
            .bounds = {0.5, 0.5}, .has_witness = true, .time = 0.25, .witness = {{1, 2}, {3, 4}}}};
    begin_step(page, 0, false);
    page_pair(page, 0, 1, 2, NULL, &(struct page_answer){.answer = &answer});
    page_step_end(page);
    cJSON *data = data_of(page);
    expect_json(member(data, "far"),
                "[[0,[0,1,[1,null,null,[null,0,1,null],[0.5,0.5,0.25,1,2,3,4]]]]]");
    cJSON_Delete(data);
}

static void coordinates_of_all_sizes_become_parts_of_the_largest(void **state)
{
    static const double places[][2] = {{0, 1},         {-1.7e308, 1.7e308}, {5e-324, 1e-323},
                                       {1e300, -1e-9}, {4e6, 4e6 + 1e-3},   {DBL_MAX, DBL_MAX}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        struct page *page = open_page(PAGE_SCENES);
        const double a[3] = {places[i][0]}, b[3] = {places[i][1]};
        size_t count;
        cJSON *data;
        begin_step(page, 0, false);
        add_box(page, 1, NULL, a);
        add_box(page, 2, NULL, b);
        page_step_end(page);
        uint32_t *number = numbers_of(page, &count, &data);
        assert_int_equal(count, 6);
        assert_int_equal(number[0], 0); /* relative to the first body */
        const int at =
            (int) member(cJSON_GetArrayItem(member(data, "steps"), 0), "at")->valuedouble;
        const double half = ldexp(difference(number[3]), at - 25);
        const double expected = b[0] / 2 - a[0] / 2;
        assert_true(fabs(half - expected) <= fabs(expected) * 0x1p-23);
        cJSON_Delete(data);
        free(number);
    }
}

static void orientations_of_any_length_become_unit_quaternions(void **state)
{
    static const double turns[][4] = {{3e-320, 4e-320, 0, 0}, {3, 4, 0, 0}, {3e307, 4e307, 0, 0}};
    for (size_t i = 0; i < sizeof turns / sizeof *turns; i++) {
        struct page *page = open_page(PAGE_SCENES);
        size_t count;
        cJSON *data;
        begin_step(page, 0, false);
        add_turned(page, 0, NULL, zero, turns[i]);
        page_step_end(page);
        uint32_t *number = numbers_of(page, &count, &data);
        assert_int_equal(count, 7);
        assert_true(fabs(difference(number[3]) * 0x1p-24 - 0.6) < 1e-4 &&
                    fabs(difference(number[4]) * 0x1p-24 - 0.8) < 1e-4);
        cJSON_Delete(data);
        free(number);
    }
}

/* Of steady motion only the begin and the first change are not 0, until a body is added. */
static void numbers_of_steps_are_differences_of_changes(void **state)
{
    static const double x[] = {0, 0.5, 0.75, 1, 0.125, 0.25}; /* of the body 2, in units of 1 */
    static const double expected[] = {0, 0.5, -0.25, 0, -1.125};
    struct page *page = open_page(PAGE_SCENES);
    size_t count, at = 0;
    cJSON *data;
    for (size_t step = 0; step < 6; step++) {
        begin_step(page, (double) step, false);
        add_box(page, 1, NULL, zero);
        add_box(page, 2, NULL, (const double[]){x[step], 1, 0}); /* the largest is always 1 */
        for (size_t more = 5; more < step + 1; more++)
            add_box(page, 3, NULL, zero);
        page_step_end(page);
    }
    uint32_t *number = numbers_of(page, &count, &data);
    assert_int_equal(count, 5 * 6 + 9);
    for (size_t step = 0; step < 5; step++, at += 6) {
        const double scale = ldexp(
            1, 25 - (int) member(cJSON_GetArrayItem(member(data, "steps"), 0), "at")->valuedouble);
        assert_true(difference(number[at + 3]) == expected[step] * scale / 2);
        assert_true(difference(number[at + 4]) == (step == 0   ? scale / 2
                                                   : step == 1 ? -scale / 2
                                                               : 0));
    }
    assert_true(difference(number[at + 3]) == difference(number[at + 4]) / 4);
    cJSON_Delete(data);
    free(number);
}

static void meshes_have_corners_faces_and_verdicts(void **state)
{
    static double vertex[3][3] = {{1, 0, 0}, {3, 0, 0}, {1, 1, 0}};
    static unsigned face[1][3] = {{0, 1, 2}};
    static const unsigned char verdict[1] = {FMB_TOUCHING};
    struct page *page = open_page(PAGE_MESH);
    size_t count;
    cJSON *data;
    begin_step(page, 0, false);
    page_mesh(page, &(struct page_mesh){.name = "m",
                                        .vertex_count = 3,
                                        .face_count = 1,
                                        .vertex = vertex,
                                        .face = face,
                                        .verdict = verdict});
    page_step_end(page);
    uint32_t *number = numbers_of(page, &count, &data);
    const cJSON *shape = cJSON_GetArrayItem(member(data, "shapes"), 0);
    expect_json(shape,
                "{\"dim\":3,\"centre\":[2,0.5,0],\"at\":1,\"first\":0,\"corners\":3,\"faces\":1}");
    assert_int_equal(count, 9 + 3 + 1 + 3);
    assert_true((int32_t) number[0] == -0x800000 && number[3] == 0x800000 && number[7] == 0x400000);
    assert_true(number[9] == 0 && number[10] == 1 && number[11] == 2 && number[12] == FMB_TOUCHING);
    cJSON_Delete(data);
    free(number);
}

/* ---- Hostile texts --------------------------------------------------------------------------- */

static void hostile_texts_end_neither_script_nor_page(void **state)
{
    static const char hostile[] = "</script><script>alert(1)</script><!-- \"\\\n\xff\x01";
    struct page *page = page_open(
        &(struct page_options){.kind = PAGE_REPLAY, .title = hostile, .sides = {hostile, hostile}});
    page_note(page, hostile);
    page_step_begin(page, &(struct page_step){.label = hostile,
                                              .note = hostile,
                                              .log = hostile,
                                              .outcome = {hostile, false},
                                              .result = {{.given = true, .error = hostile}}});
    add_box(page, 1, hostile, zero);
    page_body(page, &(struct fmb_placement){.id = 2, .name = hostile}, hostile);
    page_step_end(page);
    size_t size;
    char *text = text_of(page, &size);
    int ends = 0;
    for (const char *at = strstr(text, "</script"); at; at = strstr(at + 1, "</script"))
        ends++;
    assert_int_equal(ends, 3); /* of the data, the numbers and the scripts */
    assert_null(strstr(text, "<!--"));
    free(text);
}

/* ---- Limits ---------------------------------------------------------------------------------- */

static void large_steps_keep_pairs_in_contact(void **state)
{
    struct page *page = open_page(PAGE_SCENES);
    begin_step(page, 0, false);
    for (unsigned i = 0; i < PAGE_PAIRS_MAX + 7; i++) {
        add_pair(page, 0, i, FMB_SEPARATED);
        add_pair(page, 1, i, FMB_TOUCHING);
    }
    page_step_end(page);
    cJSON *data = data_of(page);
    const cJSON *step = cJSON_GetArrayItem(member(data, "steps"), 0);
    assert_int_equal(cJSON_GetArraySize(member(step, "pairs")), PAGE_PAIRS_MAX);
    assert_true(member(step, "more")->valuedouble == 7);
    expect_json(member(data, "far"), "[]");
    expect_json(member(data, "notes"),
                "[\"Pairs that are separated and not within the margin are left out: 1007 "
                "answers.\"]");
    cJSON_Delete(data);
}

static void far_pairs_are_in_all_steps_or_in_none(void **state)
{
    struct page *page = open_page(PAGE_SCENES);
    for (int i = 0; i < 1000; i++) {
        begin_step(page, i, false);
        for (unsigned k = 0; k < 500; k++)
            add_pair(page, k, k + 1, FMB_SEPARATED);
        page_step_end(page);
    }
    cJSON *data = data_of(page);
    expect_json(member(data, "far"), "[]");
    assert_int_equal(cJSON_GetArraySize(member(data, "notes")), 1);
    cJSON_Delete(data);
}

/* Steps of some 40 kB: more than fit, in the end those that differ too. */
static void pages_are_bounded_and_keep_differences_longest(void **state)
{
    enum { STEPS = 1600, EVERY = 4 };
    struct page *page = open_page(PAGE_REPLAY);
    for (int i = 0; i < STEPS; i++) {
        begin_step(page, i, i % EVERY == 0);
        for (unsigned k = 0; k < PAGE_PAIRS_MAX; k++) {
            const struct fmb_answer answer = {
                .verdict = FMB_TOUCHING, .has_contact = true, .contact = {k / 7., k / 3.}};
            page_pair(page, k, k + 1, 3,
                      i % EVERY == 0 ? &(struct page_answer){.answer = &answer} : NULL,
                      &(struct page_answer){.answer = &answer});
        }
        page_step_end(page);
    }
    size_t size;
    char *text = data_text_of(page, &size);
    assert_true(strlen(text) > PAGE_STEPS_BYTES && size < PAGE_BYTES_MAX);
    int different = 0, kept = 0;
    for (const char *at = strstr(text, "\"outcome\""); at; at = strstr(at + 1, "\"outcome\""))
        kept++;
    for (const char *at = strstr(text, "\"differs\":true"); at;
         at = strstr(at + 1, "\"differs\":true"))
        different++;
    char note[100];
    snprintf(note, sizeof note, "%d of %d steps are left out, from", STEPS - kept, STEPS);
    assert_non_null(strstr(text, note));
    snprintf(note, sizeof note, "%d of them differ.", STEPS / EVERY - different);
    assert_non_null(strstr(text, note));
    assert_true(different * EVERY > kept + EVERY); /* more than their part */
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_and_shapes_are_stored_once),
        cmocka_unit_test(answers_that_differ_have_all_digits),
        cmocka_unit_test(boxes_and_gaps_have_their_numbers),
        cmocka_unit_test(coordinates_of_all_sizes_become_parts_of_the_largest),
        cmocka_unit_test(orientations_of_any_length_become_unit_quaternions),
        cmocka_unit_test(numbers_of_steps_are_differences_of_changes),
        cmocka_unit_test(meshes_have_corners_faces_and_verdicts),
        cmocka_unit_test(hostile_texts_end_neither_script_nor_page),
        cmocka_unit_test(large_steps_keep_pairs_in_contact),
        cmocka_unit_test(far_pairs_are_in_all_steps_or_in_none),
        cmocka_unit_test(pages_are_bounded_and_keep_differences_longest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
