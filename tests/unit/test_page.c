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
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    enum { BYTES_MAX = 1 << 27 };
    unsigned char value[128];
    memset(value, 64, sizeof value);
    value['='] = 0;
    for (unsigned char k = 0; k < 64; k++)
        value[(int) digits[k]] = k;
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
            assert_true((unsigned char) at[k] < 128 && value[(int) at[k]] < 64);
            bits = bits << 6 | value[(int) at[k]];
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
    struct json_writer *json =
        page_step_begin(page, &(struct page_step){.time = time, .duration = 1, .differs = differs});
    if (json)
        json_string(json, "outcome", "compared");
}

static void add_pair(struct page *page, unsigned a, unsigned b, enum fmb_verdict verdict)
{
    page_pair(page, 3, NULL,
              &(struct fmb_client_answer){.a = a, .b = b, .answer.verdict = verdict});
}

/* ---- Data ------------------------------------------------------------------------------------ */

static void shapes_are_stored_once(void **state)
{
    struct page *page = open_page(PAGE_SCENES);
    for (int i = 0; i < 3; i++) {
        begin_step(page, i, false);
        add_box(page, 1, "table", zero);
        add_box(page, i == 2 ? 3 : 2, NULL, zero);
        page_step_end(page);
    }
    cJSON *data = data_of(page);
    expect_json(member(data, "shapes"),
                "[{\"dim\":3,\"frames\":[{\"shape\":\"box\",\"size\":[1,2,3]}]}]");
    expect_json(member(cJSON_GetArrayItem(member(data, "steps"), 2), "bodies"),
                "[{\"id\":1,\"name\":\"table\",\"shape\":0,\"position\":[0,0,0]},"
                "{\"id\":3,\"shape\":0,\"position\":[0,0,0]}]");
    assert_int_equal(cJSON_GetArraySize(member(data, "steps")), 3);
    cJSON_Delete(data);
}

static void answers_that_differ_have_all_digits(void **state)
{
    struct page *page = open_page(PAGE_REPLAY);
    struct fmb_client_answer then = {
        .b = 1,
        .answer = {.verdict = FMB_OVERLAPPING, .has_contact = true, .contact = {0, 1. / 3}}};
    struct fmb_client_answer now = then;
    now.answer.contact[1] = nextafter(now.answer.contact[1], 1);
    begin_step(page, 0, true);
    page_pair(page, 3, NULL, &now);
    now.b = 2;
    page_pair(page, 3, &then, &now);
    page_pair(page, 3, NULL,
              &(struct fmb_client_answer){.b = 3, .status = FMB_BUSY, .text = "busy"});
    page_step_end(page);
    size_t size;
    char *text = data_text_of(page, &size);
    const char verdict[] = "\"verdict\":\"overlapping\",\"contact\":";
    char expected[200];
    snprintf(expected, sizeof expected, "{\"bodies\":[0,1],%s[0,0.333333333]}", verdict);
    assert_non_null(strstr(text, expected));
    snprintf(expected, sizeof expected,
             "{\"bodies\":[0,2],\"then\":{%s[0,0.3333333333333333]},\"now\":{%s[0,"
             "0.33333333333333337]}}",
             verdict, verdict);
    assert_non_null(strstr(text, expected));
    assert_non_null(strstr(text, "{\"bodies\":[0,3],\"error\":\"busy\"}"));
    free(text);
}

/* The position of a body of the only step, as it is written. */
static double read_position(const cJSON *data, int body)
{
    const cJSON *bodies = member(cJSON_GetArrayItem(member(data, "steps"), 0), "bodies");
    return cJSON_GetArrayItem(member(cJSON_GetArrayItem(bodies, body), "position"), 0)->valuedouble;
}

static void positions_are_rounded_to_parts_of_the_extent(void **state)
{
    static const double places[][2] = {{0, 1},         {-1.7e308, 1.7e308}, {5e-324, 1e-323},
                                       {1e300, -1e-9}, {4e6, 4e6 + 1e-3},   {DBL_MAX, DBL_MAX},
                                       {1, 1 + 1e-15}, {1. / 3, 2. / 3}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        struct page *page = open_page(PAGE_SCENES);
        const double *place = places[i], a[3] = {place[0]}, b[3] = {place[1]};
        begin_step(page, 0, false);
        add_box(page, 1, NULL, a);
        add_box(page, 2, NULL, b);
        page_step_end(page);
        cJSON *data = data_of(page);
        const double limit = 1e-6 * fabs(place[1] / 2 - place[0] / 2);
        for (int k = 0; k < 2; k++)
            assert_true(fabs(read_position(data, k) / 2 - place[k] / 2) <= limit);
        cJSON_Delete(data);
    }
}

/* ---- Hostile texts --------------------------------------------------------------------------- */

static void hostile_texts_end_neither_script_nor_page(void **state)
{
    static const char hostile[] = "</script><script>alert(1)</script><!-- \"\\\n\xff\x01";
    struct page *page = page_open(
        &(struct page_options){.kind = PAGE_REPLAY, .title = hostile, .sides = {hostile, hostile}});
    json_string(page_step_begin(page, &(struct page_step){.label = hostile}), "note", hostile);
    add_box(page, 1, hostile, zero);
    page_body(page, &(struct fmb_placement){.id = 2, .name = hostile}, hostile);
    page_step_end(page);
    size_t size;
    char *text = text_of(page, &size);
    int ends = 0;
    for (const char *at = strstr(text, "</script"); at; at = strstr(at + 1, "</script"))
        ends++;
    assert_int_equal(ends, 2); /* of the data and the scripts */
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
    expect_json(member(data, "notes"),
                "[\"Pairs that are separated and not within the margin are left out: 1007 "
                "answers.\"]");
    cJSON_Delete(data);
}

static void far_pairs_are_bounded(void **state)
{
    enum { STEPS = 1000, PAIRS = 500 };
    struct page *page = open_page(PAGE_SCENES);
    for (int i = 0; i < STEPS; i++) {
        begin_step(page, i, false);
        for (unsigned k = 0; k < PAIRS; k++)
            add_pair(page, k, k + 1, FMB_SEPARATED);
        page_step_end(page);
    }
    cJSON *data = data_of(page);
    int kept = 0;
    const cJSON *step;
    cJSON_ArrayForEach(step, member(data, "steps")) kept +=
        cJSON_GetArraySize(member(step, "pairs"));
    char note[200];
    assert_true(kept > 0 && kept < STEPS * PAIRS);
    snprintf(note, sizeof note,
             "[\"Pairs that are separated and not within the margin are left out: %d answers.\"]",
             STEPS * PAIRS - kept);
    expect_json(member(data, "notes"), note);
    cJSON_Delete(data);
}

/* Steps of some 100 kB each: more than fit. In the end even steps that differ are left out. */
static void pages_are_bounded_and_keep_differences_longest(void **state)
{
    enum { STEPS = 1000, EVERY = 4 };
    struct page *page = open_page(PAGE_REPLAY);
    for (int i = 0; i < STEPS; i++) {
        begin_step(page, i, i % EVERY == 0);
        for (unsigned k = 0; k < PAGE_PAIRS_MAX; k++) {
            const struct fmb_client_answer answer = {
                .a = k,
                .b = k + 1,
                .answer = {
                    .verdict = FMB_TOUCHING, .has_contact = true, .contact = {k / 7., k / 3.}}};
            page_pair(page, 3, i % EVERY == 0 ? &answer : NULL, &answer);
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
        cmocka_unit_test(shapes_are_stored_once),
        cmocka_unit_test(answers_that_differ_have_all_digits),
        cmocka_unit_test(positions_are_rounded_to_parts_of_the_extent),
        cmocka_unit_test(hostile_texts_end_neither_script_nor_page),
        cmocka_unit_test(large_steps_keep_pairs_in_contact),
        cmocka_unit_test(far_pairs_are_bounded),
        cmocka_unit_test(pages_are_bounded_and_keep_differences_longest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
