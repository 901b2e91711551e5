/* Hit, miss, replacement, eviction, dead keys. */
#include "cache.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { FIRST_KEY = 1000 };

/* A cube with edges of a length. */
static void cube(double edge, double out[9])
{
    memset(out, 0, 9 * sizeof *out);
    out[0] = out[4] = out[8] = edge;
}

static int64_t key_of(struct cache *cache, int64_t id, int dim, int shape, const double *components)
{
    int64_t key;
    cache_keep(cache, id, dim, shape, components, &key);
    return key;
}

static int64_t keep(struct cache *cache, int64_t id, double edge)
{
    double components[9];
    int64_t key;
    cube(edge, components);
    const struct fmb_body *body = cache_keep(cache, id, 3, FMB_CUBOID, components, &key);
    assert_true(body->component[2][2] == edge);
    assert_true(body->inverse[2][2] == 1 / edge);
    return key;
}

/* The edge of the body that the key stands for, or 0. */
static double find(struct cache *cache, int64_t id, int64_t key)
{
    const struct fmb_body *body = cache_find(cache, id, key, 3, FMB_CUBOID);
    return body ? body->component[0][0] : 0;
}

static void test_hit_and_miss(void **state)
{
    (void) state;
    struct cache *cache = cache_create(4, FIRST_KEY);
    int64_t key = keep(cache, 7, 2);
    assert_int_equal(key, FIRST_KEY);
    assert_int_equal(keep(cache, 7, 2), key);
    assert_true(find(cache, 7, key) == 2);
    struct cache_counts counts = cache_counts(cache);
    assert_int_equal(counts.bodies, 1);
    assert_int_equal(counts.capacity, 4);
    assert_int_equal(counts.misses, 1);
    assert_int_equal(counts.hits, 2);
    cache_destroy(cache);
}

static void test_replacement_kills_the_key(void **state)
{
    (void) state;
    struct cache *cache = cache_create(4, FIRST_KEY);
    int64_t old = keep(cache, 7, 2);
    int64_t new = keep(cache, 7, 3);
    assert_int_not_equal(old, new);
    assert_true(find(cache, 7, old) == 0);
    assert_true(find(cache, 7, new) == 3);
    /* The old components again are new all the same: the old key stays dead. */
    int64_t again = keep(cache, 7, 2);
    assert_int_not_equal(again, old);
    assert_true(find(cache, 7, old) == 0);
    assert_int_equal(cache_counts(cache).replacements, 2);
    assert_int_equal(cache_counts(cache).bodies, 1);
    cache_destroy(cache);
}

static void test_components_are_compared_bit_by_bit(void **state)
{
    (void) state;
    struct cache *cache = cache_create(4, FIRST_KEY);
    double components[9];
    cube(1, components);
    int64_t key = key_of(cache, 1, 3, FMB_CUBOID, components);
    components[1] = -0.0;
    assert_int_not_equal(key_of(cache, 1, 3, FMB_CUBOID, components), key);
    key = key_of(cache, 1, 3, FMB_CUBOID, components);
    assert_int_not_equal(key_of(cache, 1, 3, FMB_TETRAHEDRON, components), key);
    const struct fmb_body *body = cache_keep(cache, 1, 3, FMB_TETRAHEDRON, components, &key);
    assert_int_equal(body->shape, FMB_TETRAHEDRON);
    /* Four numbers of a 2D body are not the first four of a 3D one. */
    key = key_of(cache, 2, 2, FMB_CUBOID, components);
    assert_int_equal(key_of(cache, 2, 2, FMB_CUBOID, components), key);
    assert_int_not_equal(key_of(cache, 2, 3, FMB_CUBOID, components), key);
    cache_destroy(cache);
}

static void test_the_least_recently_used_goes(void **state)
{
    (void) state;
    struct cache *cache = cache_create(3, FIRST_KEY);
    int64_t key[5];
    for (int id = 1; id <= 3; id++)
        key[id] = keep(cache, id, id);
    assert_true(find(cache, 1, key[1]) == 1); /* by key: used */
    keep(cache, 2, 2);                        /* by components: used */
    key[4] = keep(cache, 4, 4);
    assert_true(find(cache, 3, key[3]) == 0);
    for (int id = 1; id <= 4; id++)
        if (id != 3)
            assert_true(find(cache, id, key[id]) == id);
    assert_int_equal(cache_counts(cache).evictions, 1);
    assert_int_equal(cache_counts(cache).bodies, 3);
    cache_destroy(cache);
}

static void test_keys_of_others_find_nothing(void **state)
{
    (void) state;
    struct cache *cache = cache_create(3, FIRST_KEY);
    int64_t one = keep(cache, 1, 1), two = keep(cache, 2, 2);
    assert_true(find(cache, 1, two) == 0);
    assert_true(find(cache, 2, one) == 0);
    assert_true(find(cache, 3, one) == 0);
    assert_true(find(cache, 0, 0) == 0);
    assert_true(find(cache, 1, 0) == 0);
    cache_destroy(cache);
}

/* Against a plain list of all that was ever kept: the same held, the same dead. */
static void test_against_a_list(void **state)
{
    (void) state;
    enum { IDS = 40, CAPACITY = 16, ROUNDS = 200000 };
    struct cache *cache = cache_create(CAPACITY, FIRST_KEY);
    struct {
        double edge;
        int64_t key, used_at;
    } list[IDS] = {0};
    srand(1);
    for (int now = 1; now <= ROUNDS; now++) {
        int id = rand() % IDS;
        double edge = rand() % 2 + 1;
        int64_t key = keep(cache, id + 1, edge);
        if (list[id].key && list[id].edge == edge)
            assert_int_equal(key, list[id].key);
        else
            assert_true(key >= FIRST_KEY);
        list[id].edge = edge;
        list[id].key = key;
        list[id].used_at = 2 * now;
        int held = 0, oldest = -1;
        for (int i = 0; i < IDS; i++) {
            held += list[i].key != 0;
            if (list[i].key && (oldest < 0 || list[i].used_at < list[oldest].used_at))
                oldest = i;
        }
        if (held > CAPACITY) {
            assert_true(find(cache, oldest + 1, list[oldest].key) == 0);
            list[oldest].key = 0;
        }
        int probe = rand() % IDS;
        if (list[probe].key) {
            assert_true(find(cache, probe + 1, list[probe].key) == list[probe].edge);
            list[probe].used_at = 2 * now + 1;
        }
    }
    assert_int_equal(cache_counts(cache).bodies, CAPACITY);
    cache_destroy(cache);
}

static void test_room_for_one(void **state)
{
    (void) state;
    struct cache *cache = cache_create(1, FIRST_KEY);
    int64_t one = keep(cache, 1, 1), two = keep(cache, 2, 2);
    assert_true(find(cache, 1, one) == 0);
    assert_true(find(cache, 2, two) == 2);
    cache_destroy(cache);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hit_and_miss),
        cmocka_unit_test(test_replacement_kills_the_key),
        cmocka_unit_test(test_components_are_compared_bit_by_bit),
        cmocka_unit_test(test_the_least_recently_used_goes),
        cmocka_unit_test(test_keys_of_others_find_nothing),
        cmocka_unit_test(test_against_a_list),
        cmocka_unit_test(test_room_for_one),
    };
    return cmocka_run_group_tests_name("cache", tests, NULL, NULL);
}
