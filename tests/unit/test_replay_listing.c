/* Which differences are listed, and in which order: against all of them, sorted. */
#include "unit.h"

#include "listing.h"
#include "replay_draw.h"

enum { PUT_MAX = 3000 };

static struct difference put[PUT_MAX];
static int listed_count;

/* What is listed next has to be put[listed_count]. */
static void on_listed(void *user, const struct difference *found)
{
    const struct difference *expected = &put[listed_count++];
    (void) user;
    assert_int_equal(found->place.log, expected->place.log);
    assert_int_equal(found->place.offset, expected->place.offset);
    assert_int_equal(found->place.number, expected->place.number);
    const char *certificate = found->then.certificate;
    const int64_t number = found->place.number;
    char text[32];
    snprintf(text, sizeof text, "certificate %d", (int) number);
    if (number % 2)
        assert_string_equal(certificate, text);
    else
        assert_null(certificate);
    assert_null(found->now.certificate);
}

static struct difference draw_found(int number)
{
    struct difference found = {.place = {.number = number}};
    found.place.log = (int32_t) draw(3);
    found.place.offset = (int64_t) draw(40) - 20;
    found.kind = (enum difference_kind) draw(DIFFERENT_KINDS);
    return found;
}

/* Numbers and certificates come last. */
static bool is_number(const struct difference *difference)
{
    return difference->kind >= DIFFERENT_INTERVAL && difference->kind <= DIFFERENT_CERTIFICATE;
}

static int compare(const void *left, const void *right)
{
    const struct difference *a = left, *b = right;
    if (is_number(a) != is_number(b))
        return is_number(a) - is_number(b);
    if (a->place.log != b->place.log)
        return a->place.log < b->place.log ? -1 : 1;
    if (a->place.offset != b->place.offset)
        return a->place.offset < b->place.offset ? -1 : 1;
    return a->place.number < b->place.number ? -1 : 1;
}

static void check(int count, int64_t limit, int order)
{
    struct listing *listing = listing_open(limit);
    for (int i = 0; i < count; i++) {
        char text[32];
        put[i] = draw_found(i);
        if (order != 0)
            put[i].place.offset = order * (int64_t) i;
        struct difference found = put[i];
        snprintf(text, sizeof text, "certificate %d", i);
        found.then.certificate = i % 2 ? text : NULL;
        listing_put(listing, &found);
    }
    qsort(put, (size_t) count, sizeof *put, compare);
    const int kept = count < limit ? count : (int) limit;
    assert_int_equal(listing_beyond(listing), count - kept);
    for (int times = 0; times < 2; times++) {
        listed_count = 0;
        listing_each(listing, on_listed, NULL);
        assert_int_equal(listed_count, kept);
    }
    listing_close(listing);
}

static void the_first_differences_are_listed(void **state)
{
    static const int64_t limits[] = {0, 1, 2, 3, 7, 100, 1000, PUT_MAX, INT32_MAX};
    for (size_t i = 0; i < COUNT(limits); i++)
        for (int order = -1; order <= 1; order++) {
            check(0, limits[i], order);
            for (int count = 1; count <= PUT_MAX; count = 3 * count + 1)
                check(count, limits[i], order);
        }
}

/* Of a long certificate the beginning. */
static void long_certificates_are_listed(void **state)
{
    static char text[1000];
    memset(text, 'x', sizeof text - 1);
    struct difference found = {.place = {.number = 1}};
    found.then.certificate = text;
    found.kind = DIFFERENT_CERTIFICATE;
    struct listing *listing = listing_open(1);
    listing_put(listing, &found);
    text[0] = '\0'; /* it is copied */
    listing_close(listing);
    listing_close(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_differences_are_listed),
        cmocka_unit_test(long_certificates_are_listed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
