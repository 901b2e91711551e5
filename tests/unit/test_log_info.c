/* What is counted of a log, and that no log makes it take more memory. */
#include "unit.h"

#include "log_info.h"

static void take(struct log_info *info, int64_t utime, const char *channel, const void *data,
                 size_t size)
{
    const struct log_event event = {.utime = utime,
                                    .channel = channel,
                                    .channel_length = strlen(channel),
                                    .data = data,
                                    .size = size,
                                    .kept = size < LOG_DATA_MAX ? size : LOG_DATA_MAX};
    log_info_event(info, &event);
}

static void expect_tally(const struct log_tally *tally, struct log_tally expected)
{
    assert_int_equal(tally->events, expected.events);
    assert_int_equal(tally->bytes, expected.bytes);
    assert_int_equal(tally->least, expected.least);
    assert_int_equal(tally->most, expected.most);
    assert_int_equal(tally->begin, expected.begin);
    assert_int_equal(tally->end, expected.end);
}

static void expect_row(const struct log_row *row, const char *channel, bool known,
                       int64_t fingerprint)
{
    assert_int_equal(row->channel_length, strlen(channel));
    assert_memory_equal(row->channel, channel, strlen(channel));
    assert_int_equal(row->type.known, known);
    assert_int_equal(row->type.fingerprint, fingerprint);
}

/* Returns a row, by number from 0. It must exist. */
static const struct log_row *row_at(const struct log_info *info, int number)
{
    const struct log_row *row = info->rows;
    while (row && number-- > 0)
        row = row->hh.next;
    assert_non_null(row);
    return row;
}

static void an_empty_log_has_no_channels(void **state)
{
    struct log_info *info = log_info_open();
    log_info_end(info);
    assert_int_equal(HASH_COUNT(info->rows), 0);
    expect_tally(&info->all, (struct log_tally){0});
    log_info_close(info);
}

static void channels_and_types_are_counted(void **state)
{
    struct log_info *info = log_info_open();
    take(info, 50, "B", "\1\2\3\4\5\6\7\x80...", 11);
    take(info, -9, "A", "\0\0\0\0\0\0\0", 7);
    take(info, -9, "A", "\0\0\0\0\0\0\0\0", 8);
    take(info, 70, "B", "\1\2\3\4\5\6\7\x80", 8);
    take(info, 60, "B", "\xff\2\3\4\5\6\7\x80", 8);
    take(info, 80, "AB", "", 0);
    take(info, 65, "B", "\1\2\3\4\5\6\7\x80.", 9);
    log_info_end(info);
    assert_int_equal(info->backward, 3);
    assert_int_equal(HASH_COUNT(info->rows), 5);
    expect_row(row_at(info, 0), "A", false, 0);
    expect_row(row_at(info, 1), "A", true, 0);
    expect_row(row_at(info, 2), "AB", false, 0);
    expect_row(row_at(info, 3), "B", true, -0xfdfcfbfaf9f880);
    expect_row(row_at(info, 4), "B", true, 0x0102030405060780);
    expect_tally(&row_at(info, 4)->tally, (struct log_tally){3, 28, 8, 11, 50, 70});
    expect_tally(&info->all, (struct log_tally){7, 51, 0, 11, -9, 80});
    log_info_close(info);
}

/* There is no limit on the number of channels. */
static void many_channels_are_counted(void **state)
{
    enum { MANY = 5000, ROUNDS = 3 };
    struct log_info *info = log_info_open();
    char channel[32];
    for (int round = 0; round < ROUNDS; round++)
        for (int i = 0; i < MANY; i++) {
            snprintf(channel, sizeof channel, "%05d", i);
            take(info, i, channel, "1234567", (size_t) (i % 8));
        }
    log_info_end(info);
    const struct log_row *row = info->rows;
    for (int i = 0; i < MANY; i++, row = row->hh.next) {
        const size_t size = (size_t) (i % 8);
        snprintf(channel, sizeof channel, "%05d", i);
        expect_row(row, channel, false, 0);
        expect_tally(&row->tally,
                     (struct log_tally){ROUNDS, (int64_t) (ROUNDS * size), size, size, i, i});
    }
    assert_null(row);
    assert_int_equal(info->all.events, ROUNDS * MANY);
    assert_int_equal(info->backward, ROUNDS - 1);
    log_info_close(info);
}

/* Beside a list, searched from its beginning. */
static void counts_match_a_list(void **state)
{
    enum { CHANNELS = 12, EVENTS = 20000 };
    static int64_t events[CHANNELS], bytes[CHANNELS];
    struct log_info *info = log_info_open();
    unsigned char data[8] = {0};
    char channel[2] = "";
    srand(1);
    for (int i = 0; i < EVENTS; i++) {
        const int which = rand() % CHANNELS;
        channel[0] = (char) ('a' + which / 2);
        data[7] = (unsigned char) (which % 2);
        const size_t size = 8 + (size_t) rand() % 100;
        take(info, i, channel, data, size);
        events[which]++;
        bytes[which] += (int64_t) size;
    }
    log_info_end(info);
    assert_int_equal(HASH_COUNT(info->rows), CHANNELS);
    for (int which = 0; which < CHANNELS; which++) {
        assert_int_equal(row_at(info, which)->tally.events, events[which]);
        assert_int_equal(row_at(info, which)->tally.bytes, bytes[which]);
    }
    log_info_close(info);
}

static void damages_are_counted(void **state)
{
    struct log_info *info = log_info_open();
    for (int64_t i = 0; i < LOG_INFO_DAMAGES_MAX + 5; i++)
        log_info_damage(info, &(struct log_damage){.offset = i, .length = 2, .what = "no event"});
    log_info_end(info);
    assert_int_equal(info->damages, LOG_INFO_DAMAGES_MAX + 5);
    assert_int_equal(info->damaged, 2 * (LOG_INFO_DAMAGES_MAX + 5));
    for (int64_t i = 0; i < LOG_INFO_DAMAGES_MAX; i++)
        assert_int_equal(info->damage[i].offset, i);
    log_info_close(info);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_empty_log_has_no_channels),
        cmocka_unit_test(channels_and_types_are_counted),
        cmocka_unit_test(many_channels_are_counted),
        cmocka_unit_test(counts_match_a_list),
        cmocka_unit_test(damages_are_counted),
    };
    return cmocka_run_group_tests_name("log_info", tests, NULL, NULL);
}
