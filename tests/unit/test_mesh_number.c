/* Numbers of text against strtod(), which rounds as it should. */
#include "unit.h"

#include "mesh_source.h"

#include <inttypes.h>
#include <math.h>
#include <stdbool.h>

static bool is_fast(void)
{
    return getenv("FMB_FAST") != NULL;
}

static uint64_t drawn = 1;

static uint64_t draw(void)
{
    drawn = drawn * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return drawn >> 16 ^ drawn << 32;
}

static uint64_t bits_of(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* The number takes all of the text. */
static void expect_same(const char *text)
{
    double value = 0;
    const unsigned char *at = (const unsigned char *) text, *end = at + strlen(text);
    const double expected = strtod(text, NULL);
    if (mesh_number(at, &value) != end || bits_of(value) != bits_of(expected))
        fail_msg("'%s' is %.17g, read as %.17g", text, expected, value);
}

static void numbers_at_the_limits_round_as_strtod(void **state)
{
    static const char *const texts[] = {"0",
                                        "-0",
                                        "+0",
                                        "00",
                                        "1",
                                        "-1",
                                        "+1",
                                        "007",
                                        "1.",
                                        ".5",
                                        "-.5",
                                        "+.5",
                                        "0.1",
                                        "1e0",
                                        "1e-0",
                                        "1e+0",
                                        "1E5",
                                        "1e22",
                                        "1e23",
                                        "1e-22",
                                        "1e-23",
                                        "123456789012345678e22",
                                        "9007199254740991",
                                        "9007199254740992",
                                        "9007199254740993",
                                        "9007199254740993e22",
                                        "9007199254740992e22",
                                        "9007199254740992e-22",
                                        "9007199254740991e-23",
                                        "9007199254740995",
                                        "18014398509481985",
                                        "18446744073709551615",
                                        "18446744073709551616",
                                        "18446744073709551617",
                                        "9999999999999999999",
                                        "99999999999999999999",
                                        "1e-320",
                                        "4.9e-324",
                                        "5e-324",
                                        "2.4703282292062327e-324",
                                        "2.4703282292062328e-324",
                                        "2.2250738585072011e-308",
                                        "2.2250738585072014e-308",
                                        "1.7976931348623157e308",
                                        "1.7976931348623158e308",
                                        "1.7976931348623159e308",
                                        "1e308",
                                        "1e309",
                                        "1e999",
                                        "-1e999",
                                        "1e99999999999",
                                        "1e-99999999999",
                                        "0e99999999999",
                                        "0.000000000000000000000000001",
                                        "00000000000000000000000000001",
                                        "1.00000000000000000000000000000",
                                        "1.00000000000000011102230246251565404236316680908203125",
                                        "1.00000000000000011102230246251565404236316680908203124",
                                        "1.00000000000000011102230246251565404236316680908203126",
                                        "0.500000000000000166533453693773481063544750213623046875",
                                        "3.518437208883201171875e13",
                                        "62.5364939768271845828",
                                        "8.10109172351e-10",
                                        "1.50000000000000011102230246251565",
                                        "2251799813685248.25",
                                        "4503599627370497.5",
                                        "4503599627370496.5",
                                        "0.1e1",
                                        "1000000e-6"};
    for (size_t i = 0; i < COUNT(texts); i++)
        expect_same(texts[i]);
}

/* As many digits as one likes, with the point anywhere. */
static void drawn_decimals_round_as_strtod(void **state)
{
    const int count = is_fast() ? 100000 : 1000000;
    for (int i = 0; i < count; i++) {
        char text[64];
        const int digits = 1 + (int) (draw() % 20), point = (int) (draw() % 21);
        size_t at = 0;
        if (draw() % 4 == 0)
            text[at++] = draw() % 2 ? '-' : '+';
        for (int digit = 0; digit < digits; digit++) {
            if (digit == point)
                text[at++] = '.';
            text[at++] = (char) ('0' + draw() % 10);
        }
        if (draw() % 2 == 0)
            at += (size_t) sprintf(text + at, "e%d", (int) (draw() % 61) - 30);
        text[at] = '\0';
        expect_same(text);
    }
}

/* Doubles as programs write them, and what lies just between two. */
static void drawn_doubles_read_back(void **state)
{
    const int count = is_fast() ? 20000 : 200000;
    for (int i = 0; i < count; i++) {
        char text[2000];
        const uint64_t bits = draw() ^ draw() << 20;
        double value, next;
        memcpy(&value, &bits, sizeof value);
        if (!isfinite(value))
            continue;
        for (int digits = 1; digits <= 17; digits += 4) {
            sprintf(text, "%.*g", digits, value);
            expect_same(text);
        }
        value = ldexp((double) (bits >> 11), (int) (draw() % 60) - 56);
        next = nextafter(value, INFINITY);
        if (bits >> 11 >= UINT64_C(1) << 52) { /* 54 bits: the half has the odd one */
            sprintf(text, "%.60Lf", (long double) value + ((long double) next - value) / 2);
            expect_same(text);
        }
    }
}

static void nan_and_infinity_are_numbers(void **state)
{
    static const struct {
        const char *text;
        double value;
    } words[] = {
        {"nan", NAN},       {"NaN", NAN},        {"-nan", NAN},          {"inf", INFINITY},
        {"+Inf", INFINITY}, {"-inf", -INFINITY}, {"infinity", INFINITY}, {"-INFINITY", -INFINITY}};
    for (size_t i = 0; i < COUNT(words); i++) {
        const unsigned char *at = (const unsigned char *) words[i].text;
        double value;
        assert_ptr_equal(mesh_number(at, &value), at + strlen(words[i].text));
        assert_true(isnan(words[i].value) ? isnan(value) : value == words[i].value);
    }
}

static void a_number_ends_where_strtod_ends(void **state)
{
    static const struct {
        const char *text;
        int length; /* -1: no number */
    } texts[] = {{"", -1},     {"-", -1},   {"+", -1},   {".", -1},      {"-.", -1},    {"e5", -1},
                 {".e5", -1},  {"--1", -1}, {"+-1", -1}, {" 1", -1},     {"na", -1},    {"x", -1},
                 {"1e", 1},    {"1e+", 1},  {"1e-x", 1}, {"1.5e", 3},    {"1x", 1},     {"0x10", 1},
                 {"1.5.5", 3}, {"1 2", 1},  {"1-2", 1},  {"infinit", 3}, {"nan(1)", 3}, {"1,5", 1},
                 {"1e5.5", 3}, {"1/2", 1}};
    for (size_t i = 0; i < COUNT(texts); i++) {
        const unsigned char *at = (const unsigned char *) texts[i].text;
        const unsigned char *end = texts[i].length < 0 ? NULL : at + texts[i].length;
        double value;
        assert_ptr_equal(mesh_number(at, &value), end);
    }
}

/* Text of many thousand digits. */
static void long_numbers_round_as_strtod(void **state)
{
    enum { DIGITS = 20000 };
    static char text[DIGITS + 32];
    memset(text, '0', DIGITS);
    strcpy(text + DIGITS, "1");
    expect_same(text);
    text[1] = '.';
    expect_same(text);
    strcpy(text + DIGITS, "1e20000");
    expect_same(text);
    memset(text, '9', DIGITS);
    strcpy(text + DIGITS, "e-20000");
    expect_same(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_at_the_limits_round_as_strtod),
        cmocka_unit_test(drawn_decimals_round_as_strtod),
        cmocka_unit_test(drawn_doubles_read_back),
        cmocka_unit_test(nan_and_infinity_are_numbers),
        cmocka_unit_test(a_number_ends_where_strtod_ends),
        cmocka_unit_test(long_numbers_round_as_strtod),
    };
    return cmocka_run_group_tests_name("mesh_number", tests, NULL, NULL);
}
