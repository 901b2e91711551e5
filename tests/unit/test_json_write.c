/* What the writer of JSON and the escaper write. */

#include "unit.h"

#include "escape.h"
#include "json_write.h"

#include <float.h>
#include <math.h>

static char *bytes;
static size_t used;

static struct json_writer begin_text(bool page)
{
    FILE *out = open_memstream(&bytes, &used);
    assert_non_null(out);
    return (struct json_writer){.out = out, .page = page};
}

static void expect_text(struct json_writer *json, const char *expected)
{
    fclose(json->out);
    assert_string_equal(bytes, expected);
    assert_int_equal(used, strlen(expected));
    free(bytes);
}

static void expect_escaped(const char *string, const char *expected)
{
    struct json_writer json = begin_text(false);
    json_string(&json, NULL, string);
    expect_text(&json, expected);
}

static void strings_are_escaped(void **state)
{
    expect_escaped("", "\"\"");
    expect_escaped("a \"b\" \\ c/d", "\"a \\\"b\\\" \\\\ c/d\"");
    expect_escaped("</script><!-- & ]]>", "\"\\u003c/script\\u003e\\u003c!-- \\u0026 ]]\\u003e\"");
    expect_escaped("\x01\t\n\x7f", "\"\\u0001\\u0009\\u000a\\u007f\"");
    expect_escaped("\xc3\xa4 \xe2\x82\xac \xf0\x9f\x98\x80", "\"\\u00e4 \\u20ac \\ud83d\\ude00\"");
    expect_escaped("\xf4\x8f\xbf\xbf\xed\x9f\xbf", "\"\\udbff\\udfff\\ud7ff\"");
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
    for (size_t i = 0; i < COUNT(bad); i++) {
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
    for (size_t i = 0; i < COUNT(cases); i++) {
        struct json_writer json = begin_text(false);
        json_number(&json, NULL, cases[i].value);
        expect_text(&json, cases[i].text);
    }
}

static void integers_that_scripts_lose_are_strings_in_pages(void **state)
{
    for (int page = 0; page < 2; page++) {
        struct json_writer json = begin_text(page);
        json_begin(&json, NULL, '[');
        json_integer(&json, NULL, (INT64_C(1) << 53) - 1);
        json_integer(&json, NULL, -(INT64_C(1) << 53));
        json_integer(&json, NULL, INT64_MAX);
        json_end(&json, ']');
        expect_text(&json, page ? "[9007199254740991,\"-9007199254740992\",\"9223372036854775807\"]"
                                : "[9007199254740991, -9007199254740992, 9223372036854775807]");
    }
}

static void write_all(struct json_writer *json)
{
    static const double box[] = {0, 0.5, -0.0};
    json_begin(json, NULL, '{');
    json_begin(json, "none", '[');
    json_end(json, ']');
    json_begin(json, "some", '[');
    json_integer(json, NULL, -1);
    json_null(json, NULL);
    json_begin(json, NULL, '{');
    json_bool(json, "yes", true);
    json_bool(json, "no", false);
    json_end(json, '}');
    json_end(json, ']');
    json_numbers(json, "box", box, 3);
    json_begin(json, "raw", '"');
    fputs("AA==", json->out);
    json_end(json, '"');
    json_bytes(json, "bytes", "a\0b", 3);
    json_object_end(json);
}

static void commas_and_spaces(void **state)
{
    struct json_writer json = begin_text(false);
    write_all(&json);
    json_number(&json, NULL, 1);
    expect_text(&json,
                "{\"none\": [], \"some\": [-1, null, {\"yes\": true, \"no\": false}], "
                "\"box\": [0,0.5,-0], \"raw\": \"AA==\", \"bytes\": \"a\\u0000b\"}\n1");
    json = begin_text(true);
    write_all(&json);
    expect_text(&json,
                "{\"none\":[],\"some\":[-1,null,{\"yes\":true,\"no\":false}],"
                "\"box\":[0,0.5,-0],\"raw\":\"AA==\",\"bytes\":\"a\\u0000b\"}\n");
}

static void xml_is_escaped(void **state)
{
    static const char xml[] = "<a b=\"c\"> & \xc3\xa4\t\n\x7f\xff\xef\xbf\xbf\xc2\x80\xe2\x80\xae";
    struct json_writer json = begin_text(false);
    escape(json.out, ESCAPE_XML, xml, sizeof xml - 1);
    expect_text(&json,
                "&lt;a b=&quot;c&quot;&gt; &amp; \xc3\xa4\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd"
                "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(commas_and_spaces),
        cmocka_unit_test(strings_are_escaped),
        cmocka_unit_test(what_is_no_utf8_is_replaced),
        cmocka_unit_test(numbers_are_exact_or_null),
        cmocka_unit_test(integers_that_scripts_lose_are_strings_in_pages),
        cmocka_unit_test(xml_is_escaped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
