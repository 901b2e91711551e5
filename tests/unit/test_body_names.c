/* The names of bodies: the last one counts, what is no name is ignored, and what is written is read
 * again. */
#include "unit.h"

#include "body_names.h"

#include "allocate.h"
#include "result_rows.h"
#include "service.h"
#include "wire.h"

static struct body_names *names;

static int set_up(void **state)
{
    names = body_names_open();
    return 0;
}

static int tear_down(void **state)
{
    body_names_close(names);
    return 0;
}

static void give(int64_t client_id, int64_t body_id, const char *name)
{
    static struct logged_query query = {
        .kind = LOG_PAIR_QUERY, .placement = query.pair.placement, .placement_count = 2};
    query.pair.client_id = client_id;
    query.pair.placement[0].placed = (struct fmb_placement){.id = body_id, .name = name};
    body_names_take(names, &query);
}

static void the_last_name_counts(void **state)
{
    give(7, 1, "table");
    give(7, 2, "gripper");
    give(8, 1, "shelf");
    give(7, 1, "desk");
    give(7, 1, "");
    give(7, 1, NULL);
    assert_int_equal(body_names_count(names), 3);
    assert_string_equal(body_names_find(names, 7, 1), "desk");
    assert_string_equal(body_names_find(names, 8, 1), "shelf");
    assert_null(body_names_find(names, 8, 2));
    assert_null(body_names_find(NULL, 8, 1));
}

static void what_is_no_name_is_ignored(void **state)
{
    char longest[QUERY_NAME_MAX + 2];
    memset(longest, 'x', sizeof longest);
    longest[QUERY_NAME_MAX + 1] = '\0';
    give(7, 1, longest);
    give(7, 0, "anonymous");
    assert_int_equal(body_names_count(names), 0);
    longest[QUERY_NAME_MAX] = '\0';
    give(7, 1, longest);
    assert_string_equal(body_names_find(names, 7, 1), longest);
}

/* ---- Messages ---- */

static struct body_names *again;
static int messages;

static bool take_again(void *user, enum log_kind kind, const void *bytes, size_t size)
{
    (void) user;
    messages++;
    assert_null(body_names_read(again, bytes, (uint32_t) size));
    return messages < 3;
}

static void written_names_are_read_again(void **state)
{
    enum { COUNT = 2000 };
    char name[32];
    again = body_names_open();
    messages = 0;
    for (int i = 0; i < COUNT; i++) {
        const int at = i * 7 % COUNT; /* in another order */
        snprintf(name, sizeof name, "body %d", at);
        give(at / 100, 1 + at % 100, name);
    }
    assert_false(body_names_write(names, 5, take_again, NULL));
    assert_int_equal(messages, 3);
    assert_int_equal(body_names_count(again), COUNT);
    for (int i = 0; i < COUNT; i++) {
        snprintf(name, sizeof name, "body %d", i);
        assert_string_equal(body_names_find(again, i / 100, 1 + i % 100), name);
    }
    body_names_close(again);
}

static void messages_that_cannot_be_read(void **state)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    struct names *message = allocate(1, sizeof *message);
    message->count = 2;
    for (int i = 0; i < 2; i++) {
        message->body_id[i] = 1 + i;
        message->name[i] = "name";
    }
    const uint32_t size = (uint32_t) wire_write_names(message, bytes);
    for (uint32_t shorter = 0; shorter < size; shorter++)
        assert_non_null(body_names_read(names, bytes, shorter));
    assert_int_equal(body_names_count(names), 0);
    assert_null(body_names_read(names, bytes, size));
    assert_int_equal(body_names_count(names), 2);
    free(message);
}

static void names_are_limited(void **state)
{
    for (int i = 0; i < BODY_NAMES_MAX + 10; i++)
        give(i, 1, "name");
    assert_int_equal(body_names_count(names), BODY_NAMES_MAX);
    give(0, 1, "other");
    assert_string_equal(body_names_find(names, 0, 1), "other");
    assert_null(body_names_find(names, BODY_NAMES_MAX, 1));
}

/* ---- Results ---- */

static void take_query(struct result_rows *rows, int64_t number, const char *name)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    struct pair_query query = service_pair(7, number);
    query.placement[0].placed.id = 1;
    query.placement[0].placed.name = name;
    query.placement[1].placed.id = 2;
    assert_null(result_rows_take(rows, LOG_PAIR_QUERY, number, bytes,
                                 (uint32_t) wire_write_pair_query(&query, bytes)));
}

/* Of all queries so far, also of those without a name and those after the one that is answered. */
static void rows_have_the_last_name(void **state)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    static const char *const expected[] = {"[\"table\"", "[\"table\"", "[\"desk\"", "[\"desk\""};
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    struct result_rows *rows = result_rows_open(out, REPORT_JSON, RESULT_ROWS_ALL);
    take_query(rows, 1, "table");
    take_query(rows, 2, NULL);
    take_query(rows, 3, "table");
    for (int64_t i = 0; i < 4; i++) {
        const struct pair_result result = {
            .client_id = 7, .sequence_number = i + 1, .body_id = {1, 2}, .answer.verdict = 1};
        if (i == 2)
            take_query(rows, 4, "desk");
        assert_null(result_rows_take(rows, LOG_PAIR_RESULT, i, bytes,
                                     (uint32_t) wire_write_pair_result(&result, bytes)));
    }
    result_rows_close(rows);
    fclose(out);
    const char *at = text;
    for (int i = 0; i < 4; i++) {
        at = strstr(at + 1, "\"names\": ");
        assert_non_null(at);
        assert_memory_equal(at + strlen("\"names\": "), expected[i], strlen(expected[i]));
    }
    free(text);
}

static void an_undecided_pair_has_an_error(void **state)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    static const struct scene_result result = {.client_id = 7, .end_pair = 1, .verdict_count = 1};
    static struct scene_query query = {.client_id = 7,
                                       .which = FMB_PAIRS_LISTED,
                                       .placement_count = 2,
                                       .index_count = 2,
                                       .pair = {{0, 1}}};
    const struct pair_query pair = service_pair(7, 0);
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    struct result_rows *rows = result_rows_open(out, REPORT_JSON, RESULT_ROWS_ALL);
    for (int i = 0; i < 2; i++)
        query.placement[i] = pair.placement[i];
    assert_null(result_rows_take(rows, LOG_SCENE_QUERY, 0, bytes,
                                 (uint32_t) wire_write_scene_query(&query, bytes)));
    assert_null(result_rows_take(rows, LOG_SCENE_RESULT, 1, bytes,
                                 (uint32_t) wire_write_scene_result(&result, bytes)));
    result_rows_close(rows);
    fclose(out);
    assert_non_null(strstr(text, fmb_status_text(FMB_CANNOT_DECIDE)));
    free(text);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(the_last_name_counts),
        TEST(what_is_no_name_is_ignored),
        TEST(written_names_are_read_again),
        TEST(messages_that_cannot_be_read),
        TEST(rows_have_the_last_name),
        TEST(an_undecided_pair_has_an_error),
        TEST(names_are_limited),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
