/* Marks of more events than are in memory at a time, and channels that are chosen. */
#include "log_choice.h"
#include "log_marks.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

/* A page has 2^19. */
enum { EVENTS = 1 << 21 };

static bool is_marked(int64_t event)
{
    return event % 7 == 3 || event % 1000003 == 5;
}

/* Some are marked late, as results are whose queries stand far off. */
static void marks_stay(void **state)
{
    struct log_marks *marks = log_marks_open();
    (void) state;
    assert_false(log_marks_has(marks, 0));
    for (int64_t event = 0; event < EVENTS; event++)
        if (event % 7 == 3)
            log_marks_set(marks, event);
    for (int64_t event = EVENTS - 1; event >= 0; event--)
        if (event % 1000003 == 5)
            log_marks_set(marks, event);
    for (int64_t event = 0; event < 2 * EVENTS; event++)
        if (log_marks_has(marks, event) != (event < EVENTS && is_marked(event)))
            fail_msg("event %ld", (long) event);
    assert_int_equal(log_marks_error(marks), 0);
    log_marks_close(marks);
}

static bool has(const struct log_choice *choice, const char *channel, size_t length)
{
    char name[64] = "";
    memcpy(name, channel, length);
    const struct log_event event = {.channel = name, .channel_length = length};
    return log_choice_has_channel(choice, &event);
}

static bool takes(const char *text, const char *channel)
{
    struct log_choice choice = log_choice_all();
    char why[LOG_CHOICE_WHY_MAX];
    assert_true(log_choice_is_all(&choice));
    assert_true(log_choice_add_channel(&choice, text, why));
    assert_false(log_choice_is_all(&choice));
    const bool taken = has(&choice, channel, strlen(channel));
    log_choice_clear(&choice);
    return taken;
}

static void channels_are_matched_whole(void **state)
{
    (void) state;
    assert_true(takes("CAMERA", "CAMERA"));
    assert_false(takes("CAMERA", "CAMERA_2"));
    assert_false(takes("CAMERA", "MY_CAMERA"));
    assert_true(takes("CAMERA.*", "CAMERA_2"));
    assert_false(takes("CAM|CAMERA_2", "CAMERA"));
    assert_true(takes("CAM|CAMERA", "CAMERA"));
    assert_true(takes("FMB_(PAIR|SCENE)_QUERY", "FMB_SCENE_QUERY"));
    assert_true(takes("a+b", "a+b"));
    assert_true(takes("a+b", "aab"));
    assert_false(takes("a+b", "xaab"));
    assert_false(takes("", "CAMERA"));
}

static void several_channels_are_all_taken(void **state)
{
    struct log_choice choice = log_choice_all();
    char why[LOG_CHOICE_WHY_MAX] = "";
    (void) state;
    assert_false(log_choice_add_channel(&choice, "(", why));
    assert_true(why[0] != '\0');
    assert_true(log_choice_add_channel(&choice, "A", why));
    assert_true(log_choice_add_channel(&choice, "B.", why));
    assert_true(has(&choice, "A", 1) && has(&choice, "BC", 2) && !has(&choice, "C", 1));
    /* A name that goes on behind a 0 is another one. */
    assert_false(has(&choice, "A\0B", 3) || has(&choice, "BC\0", 3));
    log_choice_clear(&choice);
}

static void times_are_half_open(void **state)
{
    struct log_choice choice = log_choice_all();
    (void) state;
    assert_true(log_choice_has_time(&choice, 5, INT64_MIN));
    assert_true(log_choice_has_time(&choice, INT64_MIN, INT64_MAX));
    choice.from = 0.5;
    choice.to = 1;
    assert_false(log_choice_has_time(&choice, 1000, 500999));
    assert_true(log_choice_has_time(&choice, 1000, 501000));
    assert_true(log_choice_has_time(&choice, 1000, 1000999));
    assert_false(log_choice_has_time(&choice, 1000, 1001000));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(marks_stay),
        cmocka_unit_test(channels_are_matched_whole),
        cmocka_unit_test(several_channels_are_all_taken),
        cmocka_unit_test(times_are_half_open),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
