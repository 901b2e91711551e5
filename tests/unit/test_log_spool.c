/* Who hands events to the thread that writes never waits for it, and hears what became of them. */
#include "log_spool.h"

#include <errno.h>
#include <fcntl.h>
#include <lcm/eventlog.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

static char folder[] = "/tmp/test_log_spool.XXXXXX";
static char path[64], copy[64];

static int make_folder(void **state)
{
    (void) state;
    if (!mkdtemp(folder))
        return -1;
    snprintf(path, sizeof path, "%s/log", folder);
    snprintf(copy, sizeof copy, "%s/copy", folder);
    return 0;
}

static int remove_files(void **state)
{
    (void) state;
    unlink(path);
    unlink(copy);
    return 0;
}

static int remove_folder(void **state)
{
    (void) state;
    return rmdir(folder);
}

/* Event i: its number in as many bytes as make all sizes. */
enum { SIZE_MAX_OF_EVENT = 3000 };

static size_t fill(int i, int data[SIZE_MAX_OF_EVENT / sizeof(int)])
{
    const size_t count = 1 + (size_t) i * 7919 % (SIZE_MAX_OF_EVENT / sizeof *data);
    for (size_t j = 0; j < count; j++)
        data[j] = i;
    return count * sizeof *data;
}

static bool put(struct log_spool *spool, int i)
{
    int data[SIZE_MAX_OF_EVENT / sizeof(int)];
    const size_t size = fill(i, data);
    return log_spool_put(spool, i, "CHANNEL", 1 + (size_t) i % 7, data, size);
}

/* Events 0 to count - 1 are in the file, and no others. */
static void assert_events(const char *file, int count)
{
    lcm_eventlog_t *log = lcm_eventlog_create(file, "r");
    assert_non_null(log);
    for (int i = 0; i < count; i++) {
        int data[SIZE_MAX_OF_EVENT / sizeof(int)];
        const size_t size = fill(i, data);
        lcm_eventlog_event_t *event = lcm_eventlog_read_next_event(log);
        assert_non_null(event);
        assert_int_equal(event->timestamp, i);
        assert_int_equal(event->channellen, 1 + i % 7);
        assert_int_equal(event->datalen, size);
        assert_memory_equal(event->data, data, size);
        lcm_eventlog_free_event(event);
    }
    assert_null(lcm_eventlog_read_next_event(log));
    lcm_eventlog_destroy(log);
}

static struct log_spool *start(const char *file, bool force, size_t half, struct log_parts *parts)
{
    const struct log_parts_options options = {.path = file, .force = force};
    assert_true(log_parts_open(&options, parts));
    struct log_spool *spool = log_spool_start(parts, half);
    assert_non_null(spool);
    return spool;
}

/* Ten times what has room at once, so that halves change places again and again. */
static void test_all_is_written_in_order(void **state)
{
    (void) state;
    enum { COUNT = 20000 };
    struct log_parts parts;
    struct log_spool *spool = start(path, false, 3 << 20, &parts);
    for (int i = 0; i < COUNT; i++)
        while (!put(spool, i))
            nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    const struct log_spool_state end = log_spool_finish(spool);
    assert_int_equal(end.error, 0);
    assert_int_equal(end.events, COUNT);
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    assert_int_equal(end.bytes, status.st_size);
    log_parts_close(&parts);
    assert_events(path, COUNT);
}

/* Nothing has to come behind it to push it out. */
static void test_what_waits_is_written_soon(void **state)
{
    (void) state;
    struct log_parts parts;
    struct log_spool *spool = start(path, false, 1 << 20, &parts);
    for (int i = 0; i < 3; i++) {
        assert_true(put(spool, i));
        for (int tries = 0; tries < 1000 && log_spool_state(spool).events <= i; tries++)
            nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
        assert_int_equal(log_spool_state(spool).events, i + 1);
        assert_events(path, i + 1);
    }
    assert_int_equal(log_spool_finish(spool).events, 3);
    log_parts_close(&parts);
}

/* ---- A disk that stalls: a pipe that nobody reads yet ---------------------------------------- */

struct reading {
    int from, to;
};

static void *read_all(void *user)
{
    struct reading *reading = user;
    static char buffer[1 << 16];
    ssize_t count;
    while ((count = read(reading->from, buffer, sizeof buffer)) > 0)
        if (write(reading->to, buffer, (size_t) count) != count)
            return user;
    return count == 0 ? NULL : user;
}

static void test_a_disk_that_stalls_stops_nobody(void **state)
{
    (void) state;
    struct log_parts parts;
    pthread_t thread;
    assert_int_equal(mkfifo(path, 0600), 0);
    struct reading reading = {open(path, O_RDONLY | O_NONBLOCK),
                              open(copy, O_WRONLY | O_CREAT, 0600)};
    struct log_spool *spool = start(path, true, 1 << 20, &parts);
    fcntl(reading.from, F_SETFL, 0);
    int count = 0;
    while (put(spool, count)) /* until there is no room: without waiting, or this never ends */
        count++;
    assert_true(count > 100);
    assert_int_equal(log_spool_state(spool).error, 0);
    pthread_create(&thread, NULL, read_all, &reading);
    const struct log_spool_state end = log_spool_finish(spool);
    log_parts_close(&parts);
    void *failed;
    pthread_join(thread, &failed);
    assert_null(failed);
    close(reading.from);
    close(reading.to);
    assert_int_equal(end.error, 0);
    assert_int_equal(end.events, count);
    assert_events(copy, count);
}

static void test_an_event_that_has_no_room(void **state)
{
    (void) state;
    struct log_parts parts;
    struct log_spool *spool = start(path, false, 1000, &parts);
    static char data[1000];
    assert_false(log_spool_put(spool, 0, "CHANNEL", 7, data, sizeof data));
    assert_true(put(spool, 0));
    assert_int_equal(log_spool_finish(spool).events, 1);
    log_parts_close(&parts);
    assert_events(path, 1);
}

static void test_a_disk_that_is_full(void **state)
{
    (void) state;
    struct log_parts parts;
    struct log_spool *spool = start("/dev/full", true, 1 << 20, &parts);
    assert_true(put(spool, 0));
    for (int tries = 0; tries < 1000 && log_spool_state(spool).error == 0; tries++)
        nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
    assert_int_equal(log_spool_state(spool).error, ENOSPC);
    assert_false(put(spool, 1));
    const struct log_spool_state end = log_spool_finish(spool);
    assert_int_equal(end.error, ENOSPC);
    assert_int_equal(end.events, 0);
    log_parts_close(&parts);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_all_is_written_in_order, remove_files),
        cmocka_unit_test_teardown(test_what_waits_is_written_soon, remove_files),
        cmocka_unit_test_teardown(test_a_disk_that_stalls_stops_nobody, remove_files),
        cmocka_unit_test_teardown(test_an_event_that_has_no_room, remove_files),
        cmocka_unit_test_teardown(test_a_disk_that_is_full, remove_files),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
