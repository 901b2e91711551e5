/* The hash of tables with keys from untrusted input. */

#include "unit.h"

#include "keyed_hash.h"

/* SipHash-1-3 of the bytes 0, 1, ... with the secret 0, 1, ..., 15: values of an implementation in
 * Python that gives the vector of SipHash-2-4 in its authors' paper. Machines of other byte order
 * have others. */
static void it_is_siphash(void **state)
{
    static const struct {
        size_t size;
        uint64_t value;
    } cases[] = {{0, UINT64_C(0xabac0158050fc4dc)},  {1, UINT64_C(0xc9f49bf37d57ca93)},
                 {7, UINT64_C(0xd3927d989bb11140)},  {8, UINT64_C(0x369095118d299a8e)},
                 {16, UINT64_C(0xcc4fdd1a7d908b66)}, {24, UINT64_C(0xf464aeb267349c8c)},
                 {63, UINT64_C(0x9d199062b7bbb3a8)}};
    unsigned char bytes[64];
    uint64_t secret[2];
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = (unsigned char) i;
    memcpy(secret, bytes, sizeof secret);
    for (size_t i = 0; i < COUNT(cases); i++)
        assert_int_equal(keyed_hash_of(secret, bytes, cases[i].size), (unsigned) cases[i].value);
}

/* Keys that differ in the upper bits of one word alone, as the coordinates of a grid do. A secret
 * with which a bucket has 40 of 4096 keys, where 4 are to be expected, is one in 10^20. */
static void upper_bits_reach_the_buckets(void **state)
{
    enum { KEYS = 4096, BUCKETS = 1024, BUCKET_MAX = 40 };
    for (int shift = 0; shift <= 52; shift += 4) {
        int count[BUCKETS] = {0};
        for (uint64_t i = 0; i < KEYS; i++) {
            const uint64_t key[3] = {1, i << shift, 2};
            const unsigned bucket = keyed_hash_value(key, sizeof key) % BUCKETS;
            assert_true(++count[bucket] < BUCKET_MAX);
        }
    }
}

/* All tables have the same secret, which is not 0. */
static void tables_have_a_secret(void **state)
{
    const uint64_t none[2] = {0, 0};
    struct entry {
        uint64_t key[2];
        UT_hash_handle hh;
    } entry = {.key = {1, 2}}, *table = NULL, *found;
    HASH_ADD(hh, table, key, sizeof entry.key, &entry);
    HASH_FIND(hh, table, entry.key, sizeof entry.key, found);
    assert_ptr_equal(found, &entry);
    assert_int_equal(entry.hh.hashv, keyed_hash_value(entry.key, sizeof entry.key));
    assert_int_not_equal(entry.hh.hashv, keyed_hash_of(none, entry.key, sizeof entry.key));
    HASH_CLEAR(hh, table);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_siphash),
        cmocka_unit_test(upper_bits_reach_the_buckets),
        cmocka_unit_test(tables_have_a_secret),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
