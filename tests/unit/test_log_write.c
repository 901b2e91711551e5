/* What is written to a log is what LCM's own reader reads, in one file and in several, and no error
 * stays unsaid. */
#include "unit.h"

#include "log_parts.h"
#include "log_read.h"
#include "log_write.h"

#include <errno.h>
#include <fcntl.h>
#include <lcm/eventlog.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- Files of their own ---------------------------------------------------------------------- */

static char folder[] = "/tmp/test_log_write.XXXXXX";

static const char *in_folder(const char *name)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static int make_folder(void **state)
{
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    char command[300];
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command);
}

static bool exists(const char *name)
{
    return access(in_folder(name), F_OK) == 0;
}

static int64_t size_of(const char *name)
{
    struct stat status;
    return stat(in_folder(name), &status) == 0 ? status.st_size : -1;
}

static void put_file(const char *name, const char *text)
{
    FILE *file = fopen(in_folder(name), "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

/* ---- Events: each is identified by its number
 * ------------------------------------------------------ */

enum { DATA_MAX = 100000 };

static size_t size_of_event(int number)
{
    static const size_t sizes[] = {0, 1, 430, 17, 65499, 5000, 8, DATA_MAX};
    return sizes[number % 8];
}

static void data_of_event(int number, unsigned char out[DATA_MAX])
{
    for (size_t i = 0; i < size_of_event(number); i++)
        out[i] = (unsigned char) (i * 31 + (size_t) number * 7 + i / 256);
}

/* Time goes backward too. */
static int64_t utime_of_event(int number)
{
    return (number % 3 - 1) * INT64_C(1234567890123456);
}

/* With a zero in it, and as long as LCM's reader takes. */
static size_t channel_of_event(int number, char out[LOG_CHANNEL_MAX])
{
    static const size_t lengths[] = {1, 14, 63, LOG_CHANNEL_MAX - 1};
    const size_t length = lengths[number % 4];
    memset(out, 'A' + number % 26, length);
    if (length > 1)
        out[1] = number % 5 == 0 ? '\0' : 'x';
    return length;
}

static int64_t bytes_of_event(int number)
{
    char channel[LOG_CHANNEL_MAX];
    return 28 + (int64_t) channel_of_event(number, channel) + (int64_t) size_of_event(number);
}

typedef bool append(void *log, int64_t utime, const char *channel, size_t channel_length,
                    const void *data, size_t size);

static bool append_event(append *function, void *log, int number)
{
    static unsigned char data[DATA_MAX];
    char channel[LOG_CHANNEL_MAX];
    const size_t length = channel_of_event(number, channel);
    data_of_event(number, data);
    return function(log, utime_of_event(number), channel, length, data, size_of_event(number));
}

static bool to_writer(void *log, int64_t utime, const char *channel, size_t channel_length,
                      const void *data, size_t size)
{
    return log_append(log, utime, channel, channel_length, data, size);
}

static bool to_parts(void *log, int64_t utime, const char *channel, size_t channel_length,
                     const void *data, size_t size)
{
    struct log_parts *parts = log;
    return log_parts_prepare(parts, log_event_bytes(channel_length, size)) &&
           log_append(parts->writer, utime, channel, channel_length, data, size);
}

static void assert_event(const lcm_eventlog_event_t *event, int number)
{
    static unsigned char data[DATA_MAX];
    char channel[LOG_CHANNEL_MAX];
    assert_int_equal(event->timestamp, utime_of_event(number));
    assert_int_equal(event->channellen, channel_of_event(number, channel));
    assert_memory_equal(event->channel, channel, event->channellen);
    assert_int_equal(event->datalen, size_of_event(number));
    data_of_event(number, data);
    assert_memory_equal(event->data, data, event->datalen);
}

/* Reads a log with LCM's reader: its events are those from `first` on, and numbered from `number`
 * on. Returns how many. */
static int read_numbered(const char *name, int first, int number)
{
    lcm_eventlog_t *log = lcm_eventlog_create(in_folder(name), "r");
    lcm_eventlog_event_t *event;
    assert_non_null(log);
    int count = 0;
    for (; (event = lcm_eventlog_read_next_event(log)); count++) {
        assert_int_equal(event->eventnum, number + count);
        assert_event(event, first + count);
        lcm_eventlog_free_event(event);
    }
    lcm_eventlog_destroy(log);
    return count;
}

static int read_events(const char *name, int first)
{
    return read_numbered(name, first, 0);
}

/* ---- One file -------------------------------------------------------------------------------- */

/* fsync() by the linker's --wrap: counted. */
static int synced;
int __wrap_fsync(int file);
int __real_fsync(int file);

int __wrap_fsync(int file)
{
    synced++;
    return __real_fsync(file);
}

static void a_finished_log_is_on_the_disk(void **state)
{
    struct log_writer *writer = log_begin(output_open_in_place(in_folder("synced"), false));
    assert_non_null(writer);
    assert_true(append_event(to_writer, writer, 0));
    synced = 0;
    assert_int_equal(log_finish(writer), 0);
    assert_int_equal(synced, 1);
}

static void what_is_written_is_read(void **state)
{
    enum { COUNT = 100 };
    int64_t bytes = 0;
    struct log_writer *writer = log_begin(output_open_in_place(in_folder("log"), false));
    assert_non_null(writer);
    for (int i = 0; i < COUNT; i++) {
        assert_true(append_event(to_writer, writer, i));
        assert_int_equal(log_written(writer), bytes += bytes_of_event(i));
    }
    assert_int_equal(log_finish(writer), 0);
    assert_int_equal(size_of("log"), bytes);
    assert_int_equal(read_events("log", 0), COUNT);
}

static void a_log_without_events_is_empty(void **state)
{
    assert_int_equal(log_finish(log_begin(output_open_in_place(in_folder("empty"), false))), 0);
    assert_int_equal(size_of("empty"), 0);
    assert_int_equal(log_finish(NULL), 0);
}

static void what_was_flushed_is_there(void **state)
{
    struct log_writer *writer = log_begin(output_open_in_place(in_folder("flushed"), false));
    for (int i = 0; i < 3; i++) {
        assert_true(append_event(to_writer, writer, i));
        assert_true(size_of("flushed") < log_written(writer));
        assert_true(log_flush(writer));
        assert_int_equal(size_of("flushed"), log_written(writer));
    }
    assert_int_equal(read_events("flushed", 0), 3);
    assert_int_equal(log_finish(writer), 0);
}

static void nothing_is_overwritten_without_force(void **state)
{
    put_file("precious", "precious");
    assert_null(log_begin(output_open_in_place(in_folder("precious"), false)));
    assert_int_equal(errno, EEXIST);
    assert_int_equal(size_of("precious"), 8);
    struct log_writer *writer = log_begin(output_open_in_place(in_folder("precious"), true));
    assert_non_null(writer);
    assert_true(append_event(to_writer, writer, 3));
    assert_int_equal(log_finish(writer), 0);
    assert_int_equal(read_events("precious", 3), 1);
}

static void a_file_that_cannot_be_created_is_an_error(void **state)
{
    for (int force = 0; force < 2; force++) {
        assert_null(log_begin(output_open_in_place(in_folder("no/such/folder"), force)));
        assert_int_equal(errno, ENOENT);
    }
    assert_null(log_begin(output_open_in_place(folder, true)));
    assert_int_equal(errno, EISDIR);
}

/* ---- Disks that are full --------------------------------------------------------------------- */

static void a_full_disk_is_said(void **state)
{
    struct log_writer *writer = log_begin(output_open_in_place("/dev/full", true));
    assert_non_null(writer);
    assert_true(append_event(to_writer, writer, 3));
    assert_false(log_flush(writer));
    assert_int_equal(errno, ENOSPC);
    errno = 0;
    assert_false(append_event(to_writer, writer, 3));
    assert_int_equal(errno, ENOSPC);
    assert_int_equal(log_finish(writer), ENOSPC);

    writer = log_begin(output_open_in_place("/dev/full", true));
    assert_true(append_event(to_writer, writer, 3));
    assert_int_equal(log_finish(writer), ENOSPC);
}

static void limit_files(rlim_t bytes)
{
    struct rlimit limit;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    limit.rlim_cur = bytes;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

/* Writes until a file of so many bytes is full, in buffers of some events each or event by event.
 * No torn event is left, and nothing more is written, even where there is space again. */
static void fill(const char *name, rlim_t limit, bool flush)
{
    struct log_writer *writer = log_begin(output_open_in_place(in_folder(name), true));
    int64_t bytes = 0;
    int count = 0;
    signal(SIGXFSZ, SIG_IGN);
    limit_files(limit);
    while (append_event(to_writer, writer, count) && (!flush || log_flush(writer)))
        count++;
    assert_int_equal(errno, EFBIG);
    limit_files(RLIM_INFINITY);
    assert_false(append_event(to_writer, writer, count));
    assert_false(log_flush(writer));
    assert_false(log_check(writer));
    assert_int_equal(log_written(writer), size_of(name));
    assert_int_equal(log_finish(writer), EFBIG);
    const int whole = read_events(name, 0);
    for (int i = 0; i < whole; i++)
        bytes += bytes_of_event(i);
    assert_int_equal(size_of(name), bytes);
    assert_true(bytes <= (int64_t) limit && (int64_t) limit < bytes + bytes_of_event(whole));
}

static void a_full_disk_leaves_whole_events(void **state)
{
    rlim_t whole = 0;
    for (rlim_t limit = 1000003; limit < 1000003 + 200000; limit += 7919) {
        fill("limited", limit, false);
        fill("limited", limit, true);
    }
    for (int count = 0; whole < 1000003; count++)
        whole += (rlim_t) bytes_of_event(count);
    fill("limited", whole, false);
}

/* Larger than the buffer. */
static void large_events_are_written(void **state)
{
    static unsigned char data[3000000];
    struct log_writer *writer = log_begin(output_open_in_place(in_folder("large"), true));
    for (size_t i = 0; i < sizeof data; i++)
        data[i] = (unsigned char) (i * i >> 7);
    assert_true(append_event(to_writer, writer, 1));
    assert_true(log_append(writer, 5, "CAMERA", 6, data, sizeof data));
    assert_true(append_event(to_writer, writer, 2));
    assert_int_equal(log_finish(writer), 0);
    lcm_eventlog_t *log = lcm_eventlog_create(in_folder("large"), "r");
    for (int i = 0; i < 3; i++) {
        lcm_eventlog_event_t *event = lcm_eventlog_read_next_event(log);
        assert_non_null(event);
        assert_int_equal(event->eventnum, i);
        if (i == 1) {
            assert_int_equal(event->datalen, sizeof data);
            assert_memory_equal(event->data, data, sizeof data);
        }
        lcm_eventlog_free_event(event);
    }
    lcm_eventlog_destroy(log);
    writer = log_begin(output_open_in_place(in_folder("large"), true));
    limit_files(1000000);
    assert_true(append_event(to_writer, writer, 1));
    assert_true(log_append(writer, 5, "CAMERA", 6, data, sizeof data));
    assert_false(log_flush(writer));
    limit_files(RLIM_INFINITY);
    assert_int_equal(log_finish(writer), EFBIG);
    assert_int_equal(size_of("large"), bytes_of_event(1));
}

/* ---- Files that are gone --------------------------------------------------------------------- */

static struct log_writer *begin_log(const char *name)
{
    struct log_writer *writer = log_begin(output_open_in_place(in_folder(name), true));
    assert_true(append_event(to_writer, writer, 2));
    assert_true(log_flush(writer) && log_check(writer));
    return writer;
}

static void a_deleted_file_is_noticed(void **state)
{
    struct log_writer *writer = begin_log("deleted");
    assert_int_equal(unlink(in_folder("deleted")), 0);
    assert_false(log_check(writer));
    assert_int_equal(errno, ESTALE);
    assert_true(append_event(to_writer, writer, 2));
    assert_int_equal(log_finish(writer), ESTALE);
    /* Also only at the end, and where another file has taken its place. */
    writer = begin_log("deleted");
    put_file("other", "other");
    char other[256];
    snprintf(other, sizeof other, "%s", in_folder("other"));
    assert_int_equal(rename(other, in_folder("deleted")), 0);
    assert_int_equal(log_finish(writer), ESTALE);
}

static void a_truncated_file_is_noticed(void **state)
{
    struct log_writer *writer = begin_log("truncated");
    assert_int_equal(truncate(in_folder("truncated"), 100), 0);
    assert_false(log_check(writer));
    assert_int_equal(log_finish(writer), ESTALE);
}

/* The bytes written after a truncation are a whole log, whatever error ends it. */
static void a_file_that_was_truncated_gets_no_hole(void **state)
{
    enum { BEFORE = 400, AFTER = 300 };
    for (int full = 0; full < 2; full++) {
        struct log_writer *writer = log_begin(output_open_in_place(in_folder("copied"), true));
        int64_t bytes = 0;
        for (int i = 0; i < BEFORE; i++)
            assert_true(append_event(to_writer, writer, i));
        assert_true(log_flush(writer));
        assert_int_equal(truncate(in_folder("copied"), 0), 0);
        if (full)
            limit_files(1000003);
        for (int i = 0; i < AFTER && append_event(to_writer, writer, BEFORE + i); i++)
            bytes += bytes_of_event(BEFORE + i);
        if (!full)
            assert_true(log_flush(writer));
        limit_files(RLIM_INFINITY);
        assert_false(log_check(writer));
        assert_int_equal(errno, full ? EFBIG : ESTALE);
        assert_int_equal(log_finish(writer), full ? EFBIG : ESTALE);
        assert_true(full ? size_of("copied") > 700000 : size_of("copied") == bytes);
        const int whole = read_numbered("copied", BEFORE, BEFORE);
        bytes = 0;
        for (int i = 0; i < whole; i++)
            bytes += bytes_of_event(BEFORE + i);
        assert_int_equal(size_of("copied"), bytes);
    }
}

/* ---- Several files --------------------------------------------------------------------------- */

static struct log_parts_options several(const char *name, int64_t part_bytes, bool force)
{
    static char path[256];
    snprintf(path, sizeof path, "%s", in_folder(name));
    return (struct log_parts_options){.path = path, .part_bytes = part_bytes, .force = force};
}

static void write_parts(const struct log_parts_options *options, int count, struct log_parts *out)
{
    const int next = open("/dev/null", O_RDONLY | O_CLOEXEC); /* the next free descriptor */
    int64_t bytes = 0;
    close(next);
    synced = 0;
    assert_true(log_parts_open(options, out));
    for (int i = 0; i < count; i++) {
        assert_true(append_event(to_parts, out, i));
        assert_int_equal(log_parts_written(out), bytes += bytes_of_event(i));
        if (i % 7 == 0)
            assert_true(log_flush(out->writer));
    }
    assert_int_equal(log_parts_finish(out), 0);
    assert_int_equal(log_parts_written(out), bytes);
    assert_int_equal(synced, out->number + 1);
    assert_int_equal(open("/dev/null", O_RDONLY | O_CLOEXEC), next);
    close(next);
}

static const char *part_name(const char *name, long number)
{
    static char out[64];
    snprintf(out, sizeof out, "%s.%03ld", name, number);
    return out;
}

/* Files are as full as they can be, and have no more than one event that is too large by itself. */
static void several_files_divide_no_event(void **state)
{
    enum { COUNT = 200, LIMIT = 80000 };
    const struct log_parts_options options = several("parts", LIMIT, false);
    struct log_parts parts;
    write_parts(&options, COUNT, &parts);
    int seen = 0;
    for (long number = 0; number <= parts.number; number++) {
        const int64_t size = size_of(part_name("parts", number));
        const int count = read_events(part_name("parts", number), seen);
        assert_true(count >= 1);
        assert_true(size <= LIMIT || count == 1);
        seen += count;
        if (seen < COUNT)
            assert_true(size + bytes_of_event(seen) > LIMIT);
    }
    assert_int_equal(seen, COUNT);
    assert_true(parts.number > 20);
    assert_false(exists(part_name("parts", parts.number + 1)));
    assert_false(exists("parts"));
    log_parts_close(&parts);
}

/* Also if the user has removed one. */
static void the_newest_files_are_kept(void **state)
{
    for (int gone = 0; gone < 2; gone++) {
        struct log_parts_options options = several("kept", 80000, true);
        struct log_parts parts;
        options.keep = 3;
        assert_true(log_parts_open(&options, &parts));
        for (int i = 0; i < 200; i++) {
            assert_true(append_event(to_parts, &parts, i));
            if (gone && i == 20)
                assert_int_equal(unlink(in_folder(part_name("kept", parts.first))), 0);
        }
        assert_true(parts.first > 2);
        assert_int_equal(parts.first, parts.number - 2);
        assert_int_equal(log_parts_finish(&parts), 0);
        for (long number = 0; number <= parts.number; number++)
            assert_int_equal(exists(part_name("kept", number)), number >= parts.first);
        log_parts_close(&parts);
    }
}

static void a_single_file_has_no_number(void **state)
{
    const struct log_parts_options options = several("single", 0, false);
    struct log_parts parts;
    put_file("single.000", "of others");
    write_parts(&options, 100, &parts);
    log_parts_close(&parts);
    assert_int_equal(read_events("single", 0), 100);
    assert_int_equal(size_of("single.000"), 9);
}

static void files_of_before_are_overwritten_only_with_force(void **state)
{
    static const char *const others[] = {"run", "run.00", "run.0x1", "run.000.gz", "xrun.000"};
    for (size_t i = 0; i < COUNT(others); i++)
        put_file(others[i], "of others");
    put_file("run.007", "of before");
    put_file("run.1234", "of before");
    struct log_parts_options options = several("run", 1000, false);
    struct log_parts parts;
    assert_false(log_parts_open(&options, &parts));
    assert_int_equal(errno, EEXIST);
    assert_true(strcmp(parts.name, in_folder("run.007")) == 0 ||
                strcmp(parts.name, in_folder("run.1234")) == 0);
    log_parts_close(&parts);
    assert_false(exists("run.000"));
    assert_true(exists("run.007") && exists("run.1234"));

    options.force = true;
    assert_true(log_parts_open(&options, &parts));
    assert_true(exists("run.000"));
    assert_false(exists("run.007") || exists("run.1234"));
    log_parts_close(&parts);
    for (size_t i = 0; i < COUNT(others); i++)
        assert_int_equal(size_of(others[i]), 9);
}

static void a_next_file_that_cannot_be_created_is_an_error(void **state)
{
    const struct log_parts_options options = several("next", 1000, false);
    struct log_parts parts;
    assert_true(log_parts_open(&options, &parts));
    put_file("next.001", "of others");
    int count = 0;
    while (append_event(to_parts, &parts, count))
        count++;
    assert_int_equal(errno, EEXIST);
    assert_string_equal(parts.name, in_folder("next.001"));
    log_parts_close(&parts);
    assert_int_equal(read_events("next.000", 0), count);
    assert_int_equal(size_of("next.001"), 9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_is_read),
        cmocka_unit_test(a_log_without_events_is_empty),
        cmocka_unit_test(a_finished_log_is_on_the_disk),
        cmocka_unit_test(what_was_flushed_is_there),
        cmocka_unit_test(nothing_is_overwritten_without_force),
        cmocka_unit_test(a_file_that_cannot_be_created_is_an_error),
        cmocka_unit_test(a_full_disk_is_said),
        cmocka_unit_test(a_full_disk_leaves_whole_events),
        cmocka_unit_test(large_events_are_written),
        cmocka_unit_test(a_deleted_file_is_noticed),
        cmocka_unit_test(a_truncated_file_is_noticed),
        cmocka_unit_test(a_file_that_was_truncated_gets_no_hole),
        cmocka_unit_test(several_files_divide_no_event),
        cmocka_unit_test(the_newest_files_are_kept),
        cmocka_unit_test(a_single_file_has_no_number),
        cmocka_unit_test(files_of_before_are_overwritten_only_with_force),
        cmocka_unit_test(a_next_file_that_cannot_be_created_is_an_error),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
