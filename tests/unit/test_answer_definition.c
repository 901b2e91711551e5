/* What a definition query gets: by handle, or all bodies that are held, page by page. */
#include "unit.h"

#include "answer_now.h"
#include "geometry_write.h"
#include "scene_truth.h"
#include "wire.h"

enum { CAPACITY = 1500 };

static struct answerer *answerer;
static struct definition_query query;
static struct definition result, again;
static unsigned char bytes[QUERY_BYTES_MAX];

static int set_up(void **state)
{
    const struct answerer_options options = {CAPACITY, .server_id = 99,
                                             .secret = {0x243f6a8885a308d3, 0x13198a2e03707344}};
    answerer = answerer_create(&options);
    memset(&query, 0, sizeof query);
    return answerer ? 0 : -1;
}

static int tear_down(void **state)
{
    answerer_destroy(answerer);
    return 0;
}

/* Body n of a dimension, kept by a pair query with an anonymous one. */
static struct handle keep(int dim, int n)
{
    const struct solid solid = {
        .dim = dim, .shape = FMB_CUBOID, .component = {{1 + n, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    unsigned char geometry[2][GEOMETRY_FRAME_BYTES_MAX];
    struct pair_query pair = {.duration = 1};
    struct pair_result pair_result;
    for (int f = 0; f < 2; f++)
        scene_set_placement(&solid, f, geometry[f], &pair.placement[f]);
    answer_pair(answerer, &pair, &pair_result);
    assert_int_equal(pair_result.status, FMB_OK);
    return pair_result.handle[1];
}

/* What the body was kept with. */
static int number_of(const struct body_view *body)
{
    struct geometry_reader reader = geometry_begin(body);
    struct plain_frame frame;
    assert_true(geometry_read(&reader, &frame));
    return (int) frame.components[0] - 1;
}

/* The result as a client reads it, which compares bodies with their handles. */
static size_t answer_query(void)
{
    memset(&result, 0xa5, sizeof result);
    answer_definition(answerer, &query, &result);
    const size_t size = wire_write_definition(&result, bytes);
    const char *error = wire_read_definition(bytes, (uint32_t) size, &again);
    if (error)
        fail_msg("the result cannot be read: %s", error);
    assert_int_equal(again.body_count, result.body_count);
    return size;
}

static void definitions_are_found_by_handle(void **state)
{
    const int order[] = {5, 2, 2, 8};
    struct handle handle[10];
    for (int n = 0; n < 10; n++)
        handle[n] = keep(3, n);
    query = (struct definition_query){.utime = 3, .client_id = 4, .sequence_number = 5};
    for (int i = 0; i < 4; i++)
        query.handle[i] = handle[order[i]];
    query.handle[4] = (struct handle){{1}}; /* not held */
    query.handle[5] = handle[0];
    query.handle_count = 6;
    for (query.first = 0; query.first <= 6; query.first++) {
        answer_query();
        assert_int_equal(result.status, FMB_OK);
        assert_string_equal(result.detail, "");
        assert_int_equal(result.utime, 3);
        assert_int_equal(result.client_id, 4);
        assert_int_equal(result.sequence_number, 5);
        assert_int_equal(result.server_id, 99);
        assert_int_equal(result.next, 0);
        int count = 0;
        for (int i = (int) query.first; i < 6; i++)
            if (i != 4)
                assert_int_equal(number_of(&result.body[count++]), i == 5 ? 0 : order[i]);
        assert_int_equal(result.body_count, count);
    }
}

/* A body that is nearly as large as a message, among small ones: every page ends, and has it. */
static void the_largest_body_is_defined(void **state)
{
    enum { FRAMES = 657 }; /* of 97 bytes each */
    static struct plain_frame frame[FRAMES];
    static unsigned char geometry_bytes[QUERY_BYTES_MAX];
    struct cache *cache = answerer_cache(answerer);
    keep(3, 1);
    for (int i = 0; i < FRAMES; i++)
        frame[i] = (struct plain_frame){.shape = FMB_CUBOID, .components = {1 + i}};
    struct body_view body = geometry_write_frames(3, frame, FRAMES, geometry_bytes);
    cache_release(cache, cache_intern(cache, 0, &body));
    keep(3, 2);
    int bodies = 0, pages = 0, found = 0;
    do {
        assert_true(answer_query() <= QUERY_BYTES_MAX);
        for (int i = 0; i < again.body_count; i++)
            found += handle_equal(&again.body[i].handle, &body.handle);
        bodies += again.body_count;
        query.first = again.next;
    } while (again.next != 0 && ++pages < 10);
    assert_int_equal(bodies, 3);
    assert_int_equal(found, 1);
}

/* Requests page after page; counts the bodies, each of which comes once. */
static int read_all_pages(size_t body_bytes)
{
    static bool seen[CAPACITY];
    int pages = 0;
    memset(seen, 0, sizeof seen);
    query.first = 0;
    do {
        const size_t size = answer_query();
        assert_int_equal(result.status, FMB_OK);
        for (int i = 0; i < result.body_count; i++) {
            const int n = number_of(&result.body[i]);
            assert_true(n >= 0 && n < CAPACITY && !seen[n]);
            seen[n] = true;
        }
        if (result.next)
            assert_true(size + body_bytes + QUERY_TEXT_MAX > QUERY_BYTES_MAX);
        query.first = result.next;
        pages++;
    } while (result.next);
    for (int n = 0; n < CAPACITY; n++)
        assert_true(seen[n]);
    return pages;
}

/* Pages are full, and have exactly what is held: also after evictions, and where the last page is
 * full too. */
static void definitions_come_in_pages(void **state)
{
    static struct handle handle[CAPACITY];
    for (int dim = 2; dim <= 3; dim++) {
        const size_t body_bytes = HANDLE_BYTES + (dim == 2 ? 65 : 113);
        const int each = (int) ((QUERY_BYTES_MAX - WIRE_DEFINITION_BYTES) / body_bytes);
        for (int n = 0; n < CAPACITY; n++)
            handle[n] = keep(dim, n);
        query.handle_count = 0;
        assert_int_equal(read_all_pages(body_bytes), (CAPACITY + each - 1) / each);
        query.handle_count = CAPACITY;
        memcpy(query.handle, handle, sizeof handle);
        assert_int_equal(read_all_pages(body_bytes), (CAPACITY + each - 1) / each);
        query.handle_count = each;
        query.first = 0;
        answer_query();
        assert_int_equal(result.body_count, each);
        assert_int_equal(result.next, 0);
    }
    assert_int_equal(cache_counts(answerer_cache(answerer)).evictions, CAPACITY);
}

/* What a recorder requests does not count as use. */
static void definitions_are_no_uses(void **state)
{
    const struct handle first = keep(2, 0);
    for (int n = 1; n < CAPACITY; n++)
        keep(2, n);
    const struct cache_counts before = cache_counts(answerer_cache(answerer));
    query.handle_count = 1;
    query.handle[0] = first;
    answer_query();
    assert_int_equal(result.body_count, 1);
    query.handle_count = 0;
    answer_query();
    const struct cache_counts after = cache_counts(answerer_cache(answerer));
    assert_int_equal(after.hits, before.hits);
    keep(2, CAPACITY); /* evicts the first */
    query.handle_count = 1;
    answer_query();
    assert_int_equal(result.body_count, 0);
    assert_int_equal(result.next, 0);
}

static void expect(enum fmb_status status, const char *detail)
{
    answer_query();
    assert_int_equal(result.status, status);
    assert_string_equal(result.detail, detail);
    assert_int_equal(result.body_count, 0);
    assert_int_equal(result.next, 0);
}

static void bad_definition_queries_are_refused(void **state)
{
    keep(2, 0);
    query.first = -1;
    expect(FMB_OVER_LIMIT, "first: there are not so many");
    query.handle_count = 2;
    expect(FMB_OVER_LIMIT, "first: there are not so many");
    query.first = 3;
    expect(FMB_OVER_LIMIT, "first: there are not so many");
    query.handle_count = 0;
    query.first = INT64_MAX; /* bodies may have gone meanwhile: an empty page */
    expect(FMB_OK, "");
    query.first = 0;
    query.handle_count = QUERY_HANDLES_MAX + 1;
    expect(FMB_OVER_LIMIT, "num_handle_bytes: more than one datagram has");
    query.client_id = -1;
    expect(FMB_BAD_ID, "client_id: not from 0 to 2^53 - 1");
    query.client_id = 0;
    query.sequence_number = QUERY_ID_MAX + 1;
    expect(FMB_BAD_ID, "sequence_number: not from 0 to 2^53 - 1");
}

static void refused_without_being_read(void **state)
{
    const struct query_header header = {7, 8, 9};
    memset(&result, 0xa5, sizeof result);
    answer_definition_refused(answerer, &header, FMB_BUSY, &result);
    assert_int_equal(result.status, FMB_BUSY);
    assert_string_equal(result.detail, "busy");
    assert_int_equal(result.utime, 7);
    assert_int_equal(result.client_id, 8);
    assert_int_equal(result.sequence_number, 9);
    assert_int_equal(result.body_count, 0);
    assert_int_equal(result.next, 0);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(definitions_are_found_by_handle),    TEST(the_largest_body_is_defined),
        TEST(definitions_come_in_pages),          TEST(definitions_are_no_uses),
        TEST(bad_definition_queries_are_refused), TEST(refused_without_being_read),
    };
    return cmocka_run_group_tests_name("answer_definition", tests, NULL, NULL);
}
