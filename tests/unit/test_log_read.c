/* Good logs, every way to break small ones, and logs that would make a reader slow. */
#include "unit.h"

#include "log_draft.h"
#include "log_read.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <lcm/lcm.h>

/* ---- What the reader reads with -------------------------------------------------------------- */

static struct {
    int64_t calls, bytes; /* so far */
    size_t piece;         /* no more at once; 0: as much as there is */
    int error;            /* errno of all that follow; 0: none */
    bool interrupted;     /* every other call is, before it has read */
    int64_t change_at;    /* the file is changed before this call; 0: never */
} reads;

static void change_file(void);

ssize_t __real_pread64(int fd, void *out, size_t count, off_t offset);
ssize_t __wrap_pread64(int fd, void *out, size_t count, off_t offset);

ssize_t __wrap_pread64(int fd, void *out, size_t count, off_t offset)
{
    reads.calls++;
    if (reads.calls == reads.change_at)
        change_file();
    if (reads.error || (reads.interrupted && reads.calls % 2)) {
        errno = reads.error ? reads.error : EINTR;
        return -1;
    }
    if (reads.piece > 0 && count > reads.piece)
        count = reads.piece;
    const ssize_t got = __real_pread64(fd, out, count, offset);
    if (got > 0)
        reads.bytes += got;
    return got;
}

/* ---- What is read ---------------------------------------------------------------------------- */

enum { REPORT_MAX = 64, BYTES_MAX = 1 << 22, EVENTS_MAX = 1 << 16 };

/* All that was reported of a small log. */
struct report {
    size_t count;
    struct {
        const char *damage; /* NULL: an event */
        int64_t offset, length;
    } item[REPORT_MAX];
};

static int descriptor = -1;

/* Returns the path of a file with these bytes, which replaces the one before. */
static const char *put_file(const void *bytes, size_t size)
{
    static char path[LOG_DRAFT_PATH_MAX];
    if (descriptor >= 0)
        close(descriptor);
    descriptor = log_draft_file(bytes, size, path);
    return path;
}

static struct log_reader *open_bytes(const void *bytes, size_t size)
{
    char why[LOG_WHY_MAX];
    struct log_reader *reader = log_open(put_file(bytes, size), why);
    assert_non_null(reader);
    assert_int_equal(log_size(reader), size);
    return reader;
}

/* Each event is checked against the bytes at its place. */
static void check_event(const struct log_event *event, const unsigned char *bytes)
{
    const unsigned char *name = bytes + event->offset + LOG_HEADER_BYTES;
    assert_int_equal(event->length, LOG_HEADER_BYTES + event->channel_length + event->size);
    assert_true(event->channel_length >= 1 && event->channel_length < LOG_CHANNEL_MAX);
    assert_memory_equal(event->channel, name, event->channel_length);
    assert_int_equal(event->channel[event->channel_length], 0);
    assert_int_equal(event->kept, event->size < LOG_DATA_MAX ? event->size : LOG_DATA_MAX);
    assert_memory_equal(event->data, name + event->channel_length, event->kept);
}

/* From where the reader is to the end; reports follow each other, nothing left out. */
static struct report read_on(struct log_reader *reader, int64_t at, const unsigned char *bytes)
{
    struct report report = {0};
    struct log_event event;
    struct log_damage damage = {0};
    enum log_outcome outcome;
    while ((outcome = log_next(reader, &event, &damage)) != LOG_END) {
        assert_true(report.count < REPORT_MAX && (outcome == LOG_EVENT || outcome == LOG_DAMAGE));
        const bool good = outcome == LOG_EVENT;
        if (good)
            check_event(&event, bytes);
        report.item[report.count].damage = good ? NULL : damage.what;
        report.item[report.count].offset = good ? event.offset : damage.offset;
        report.item[report.count].length = good ? event.length : damage.length;
        assert_int_equal(report.item[report.count].offset, at);
        assert_true(report.item[report.count].length > 0);
        at += report.item[report.count++].length;
    }
    assert_int_equal(at, log_size(reader));
    assert_int_equal(log_next(reader, &event, &damage), LOG_END);
    return report;
}

static struct report read_bytes(const unsigned char *bytes, size_t size)
{
    struct log_reader *reader = open_bytes(bytes, size);
    const struct report report = read_on(reader, 0, bytes);
    log_close(reader);
    return report;
}

static bool reports_event(const struct report *report, size_t begin, size_t end)
{
    for (size_t i = 0; i < report->count; i++)
        if (report->item[i].offset == (int64_t) begin)
            return !report->item[i].damage && report->item[i].length == (int64_t) (end - begin);
    return false;
}

static void expect_damage(const struct report *report, size_t i, size_t begin, size_t end,
                          const char *what)
{
    assert_true(i < report->count && report->item[i].damage);
    assert_string_equal(report->item[i].damage, what);
    assert_int_equal(report->item[i].offset, begin);
    assert_int_equal(report->item[i].length, end - begin);
}

/* ---- Good logs ------------------------------------------------------------------------------- */

/* A log, and where its good events are. */
static struct {
    struct log_draft log;
    size_t count, begin[EVENTS_MAX], end[EVENTS_MAX];
} whole;
static struct log_draft inner;
static unsigned char noise[3 * LOG_DATA_MAX];

static void clear(void)
{
    whole.log.size = whole.count = 0;
    whole.log.events = 0;
}

static void add_event(int64_t utime, const char *channel, const void *data, size_t size)
{
    assert_true(whole.count < EVENTS_MAX);
    whole.begin[whole.count] = whole.log.size;
    log_draft_event(&whole.log, channel, utime, data, size);
    whole.end[whole.count++] = whole.log.size;
}

static void make_noise(unsigned seed)
{
    srand(seed);
    for (size_t i = 0; i < sizeof noise; i++)
        noise[i] = (unsigned char) (rand() >> 8);
}

/* Five events, of different lengths. */
static void make_small(void)
{
    clear();
    add_event(10, "A", "", 0);
    add_event(20, "CHANNEL", "\xed\xa1\xda\x01, but impossible lengths", 28);
    add_event(20, "B", "12345", 5);
    add_event(-1, "SOMEWHAT_LONGER", "\xed\xed\xa1\xed\xa1\xda", 6);
    add_event(30, "C", "\0\0\0", 3);
}

static void an_event_is_what_was_written(void **state)
{
    struct log_event event;
    struct log_damage damage;
    clear();
    log_draft_header(&whole.log, INT64_MIN + 5, -7, 9, 3);
    log_draft_raw(&whole.log, "a\0b\n\x1b\xff xy123", 12);
    struct log_reader *reader = open_bytes(whole.log.bytes, whole.log.size);
    assert_int_equal(log_next(reader, &event, &damage), LOG_EVENT);
    assert_int_equal(event.offset, 0);
    assert_int_equal(event.length, whole.log.size);
    assert_int_equal(event.number, INT64_MIN + 5);
    assert_int_equal(event.utime, -7);
    assert_int_equal(event.channel_length, 9);
    assert_memory_equal(event.channel, "a\0b\n\x1b\xff xy", 10);
    assert_int_equal(event.size, 3);
    assert_memory_equal(event.data, "123", 3);
    assert_int_equal(log_next(reader, &event, &damage), LOG_END);
    log_close(reader);
}

/* Names and data as long as can be, and around what is kept. */
static void the_longest_event_is_read(void **state)
{
    static const size_t sizes[] = {0, LOG_DATA_MAX - 1, LOG_DATA_MAX, LOG_DATA_MAX + 1,
                                   sizeof noise};
    static const int names[] = {1, 63, 64, 65, LOG_CHANNEL_MAX - 1};
    char name[LOG_CHANNEL_MAX] = "";
    make_noise(1);
    clear();
    for (int n = 0; n < 5; n++) {
        memset(name, 'a' + n, (size_t) names[n]);
        for (int s = 0; s < 5; s++)
            add_event(s, name, noise, sizes[s]);
    }
    const struct report report = read_bytes(whole.log.bytes, whole.log.size);
    assert_int_equal(report.count, 25);
    for (size_t i = 0; i < report.count; i++)
        assert_null(report.item[i].damage);
}

/* Mostly small ones, some with all that a datagram holds, some with more. */
static size_t draw_size(void)
{
    const int kind = rand() % 16;
    return (size_t) rand() % (kind == 0 ? sizeof noise : kind == 1 ? LOG_DATA_MAX : 500);
}

static void write_with_lcm(const char *path, int count)
{
    char name[64];
    lcm_eventlog_t *log = lcm_eventlog_create(path, "w");
    assert_non_null(log);
    for (int i = 0; i < count; i++) {
        const size_t size = draw_size();
        const int length = snprintf(name, sizeof name, "CHANNEL_%.*s", rand() % 40,
                                    "0123456789012345678901234567890123456789");
        lcm_eventlog_event_t event = {.timestamp = rand(),
                                      .channellen = length,
                                      .datalen = (int32_t) size,
                                      .channel = name,
                                      .data = noise + rand() % (sizeof noise - size)};
        assert_int_equal(lcm_eventlog_write_event(log, &event), 0);
    }
    lcm_eventlog_destroy(log);
}

static void expect_same(const struct log_event *event, const lcm_eventlog_event_t *theirs)
{
    assert_non_null(theirs);
    assert_int_equal(event->number, theirs->eventnum);
    assert_int_equal(event->utime, theirs->timestamp);
    assert_int_equal(event->channel_length, theirs->channellen);
    assert_string_equal(event->channel, theirs->channel);
    assert_int_equal(event->size, theirs->datalen);
    assert_memory_equal(event->data, theirs->data, event->kept);
}

/* Of a log of several buffers, read in pieces of any size and by calls that are interrupted, all is
 * as LCM's own reader has it. */
static void lcm_reads_the_same(void **state)
{
    struct log_event event;
    struct log_damage damage;
    char why[LOG_WHY_MAX];
    const char *path = put_file("", 0);
    make_noise(2);
    write_with_lcm(path, 1000);
    for (size_t piece = 0; piece < 100000; piece = 5 * piece + 777) {
        lcm_eventlog_t *log = lcm_eventlog_create(path, "r");
        struct log_reader *reader = log_open(path, why);
        reads.piece = piece;
        reads.interrupted = piece > 0;
        while (log_next(reader, &event, &damage) == LOG_EVENT) {
            lcm_eventlog_event_t *theirs = lcm_eventlog_read_next_event(log);
            expect_same(&event, theirs);
            lcm_eventlog_free_event(theirs);
        }
        assert_int_equal(event.number, 999);
        assert_int_equal(log_next(reader, &event, &damage), LOG_END);
        assert_null(lcm_eventlog_read_next_event(log));
        lcm_eventlog_destroy(log);
        log_close(reader);
    }
    reads.piece = 0;
    reads.interrupted = false;
}

/* ---- Small logs, broken in every way --------------------------------------------------------- */

static void every_truncation_is_read_up_to_its_end(void **state)
{
    make_small();
    for (size_t size = 0; size < whole.log.size; size++) {
        const struct report report = read_bytes(whole.log.bytes, size);
        size_t events = 0;
        while (whole.end[events] <= size)
            assert_true(reports_event(&report, whole.begin[events], whole.end[events])), events++;
        const bool cut = size > whole.begin[events];
        assert_int_equal(report.count, events + cut);
        if (cut)
            expect_damage(&report, events, whole.begin[events], size, "the last event is cut off");
    }
}

static bool touches(size_t byte, size_t event)
{
    return whole.begin[event] <= byte && byte < whole.end[event];
}

static const unsigned char flips[] = {0x01, 0x04, 0x08, 0x40, 0x80, 0xff};
enum { FLIPS = sizeof flips };

/* Where a number, a time, a name or data differ, nothing is damaged that a reader could see. */
static bool is_structure(size_t byte, size_t event)
{
    const size_t at = byte - whole.begin[event];
    return at < 4 || (at >= 20 && at < LOG_HEADER_BYTES);
}

static void every_damaged_byte_is_reported(void **state)
{
    make_small();
    for (size_t byte = 0; byte < whole.log.size; byte++)
        for (int flip = 0; flip < FLIPS; flip++) {
            whole.log.bytes[byte] ^= flips[flip];
            const struct report report = read_bytes(whole.log.bytes, whole.log.size);
            for (size_t i = 0; i < whole.count; i++)
                assert_true((touches(byte, i) && is_structure(byte, i)) ||
                            reports_event(&report, whole.begin[i], whole.end[i]));
            whole.log.bytes[byte] ^= flips[flip];
        }
}

/* Any bytes between any two events, also such as begin like one. */
static void garbage_is_reported_everywhere(void **state)
{
    static const struct {
        const char *bytes;
        size_t size;
        const char *what;
    } garbage[] = {
        {"x", 1, "no event"},
        {"no event, but many bytes that stand where one should", 52, "no event"},
        {"\0", 1, "zeros"},
        {"\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 30, "zeros"},
        {"\0\0\0\0\0\0\0\1\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 30, "no event"},
        {"\xed\xa1\xda\x01, but impossible lengths", 28, "an event with impossible lengths"},
        {"\xed\xa1\xda\x01, but impossible lengths, and more", 38,
         "an event with impossible lengths"},
        {"\xed\xed\xa1\xda", 4, "no event"},
    };
    const size_t kinds = COUNT(garbage);
    make_small();
    for (size_t g = 0; g < kinds; g++)
        for (size_t place = 0; place <= whole.count; place++) {
            const size_t at = place < whole.count ? whole.begin[place] : whole.log.size;
            inner.size = 0;
            log_draft_raw(&inner, whole.log.bytes, at);
            log_draft_raw(&inner, garbage[g].bytes, garbage[g].size);
            log_draft_raw(&inner, whole.log.bytes + at, whole.log.size - at);
            const struct report report = read_bytes(inner.bytes, inner.size);
            assert_int_equal(report.count, whole.count + 1);
            expect_damage(&report, place, at, at + garbage[g].size, garbage[g].what);
        }
}

/* ---- Lengths that lie ------------------------------------------------------------------------ */

static const char wrong[] = "an event that is cut off, or has wrong lengths";
static const char impossible[] = "an event with impossible lengths";

static void false_lengths_are_damage(void **state)
{
    static const struct {
        uint32_t channel, data;
        const char *what, *what_last;
    } lies[] = {
        {0, 5, impossible, impossible},
        {LOG_CHANNEL_MAX, 5, impossible, impossible},
        {0x80000000, 5, impossible, impossible},
        {0xffffffff, 5, impossible, impossible},
        {5, 0x80000000, impossible, impossible},
        {5, 0xffffffff, impossible, impossible},
        {0x7fffffff, 5, impossible, impossible},
        {5, 0x7fffffff, wrong, "the last event is cut off"},
        {5, 100000, wrong, "the last event is cut off"},
        {5, 60, wrong, "the last event is cut off"}, /* into the event after the next */
        {40, 5, wrong, "the last event is cut off"},
        {5, 6, wrong, "the last event is cut off"}, /* one byte too far */
    };
    for (size_t i = 0; i < COUNT(lies); i++)
        for (int last = 0; last < 2; last++) {
            make_small();
            const size_t at = whole.log.size, begun = whole.count;
            log_draft_header(&whole.log, 5, 40, lies[i].channel, lies[i].data);
            log_draft_raw(&whole.log, "D1234five!", 10);
            const size_t end = whole.log.size;
            for (int more = 0; !last && more < 3; more++)
                add_event(50, "E", "data", 4);
            const struct report report = read_bytes(whole.log.bytes, whole.log.size);
            assert_int_equal(report.count, begun + (last ? 1 : 4));
            expect_damage(&report, begun, at, end, last ? lies[i].what_last : lies[i].what);
        }
}

/* An event whose data is shorter than it says, and another log after it: as when a recorder was
 * killed and began anew in the same file. */
static void a_log_after_a_truncated_log_is_read(void **state)
{
    make_small();
    for (size_t size = whole.begin[4] + 1; size < whole.end[4]; size++) {
        inner.size = 0;
        log_draft_raw(&inner, whole.log.bytes, size);
        log_draft_raw(&inner, whole.log.bytes, whole.log.size);
        const struct report report = read_bytes(inner.bytes, inner.size);
        assert_int_equal(report.count, 10);
        expect_damage(&report, 4, whole.begin[4], size, report.item[4].damage);
    }
}

/* Whole logs in the data of events, the last one too, are data. */
static void a_log_in_a_message_is_data(void **state)
{
    make_small();
    const struct log_draft before = inner;
    inner = whole.log;
    whole.log = before;
    clear();
    for (int i = 0; i < 4; i++) {
        add_event(i, "LOGS", inner.bytes, inner.size);
        add_event(i, "OTHERS", "1", 1);
        add_event(i, "LOGS", inner.bytes, inner.size);
    }
    struct report report = read_bytes(whole.log.bytes, whole.log.size);
    assert_int_equal(report.count, 12);
    for (size_t i = 0; i < 12; i++)
        assert_true(reports_event(&report, whole.begin[i], whole.end[i]));
    for (size_t size = whole.end[9] + 1; size < whole.end[10]; size++) {
        report = read_bytes(whole.log.bytes, size);
        assert_int_equal(report.count, 11);
        expect_damage(&report, 10, whole.begin[10], size, "the last event is cut off");
    }
}

/* ---- Large files, and hostile ones ----------------------------------------------------------- */

static const off_t large = INT64_C(10) << 30;

/* A small log, and a hole after it. */
static struct log_reader *open_hole(void)
{
    char why[LOG_WHY_MAX];
    make_small();
    const char *path = put_file(whole.log.bytes, whole.log.size);
    if (ftruncate(descriptor, large) != 0)
        skip(); /* no such large files here */
    struct log_reader *reader = log_open(path, why);
    assert_non_null(reader);
    assert_int_equal(log_size(reader), large);
    return reader;
}

/* The events before it, and then the hole. */
static void expect_hole(struct log_reader *reader)
{
    struct log_event event;
    struct log_damage damage;
    memset(&reads, 0, sizeof reads);
    for (int i = 0; i < 5; i++)
        assert_int_equal(log_next(reader, &event, &damage), LOG_EVENT);
    assert_int_equal(log_next(reader, &event, &damage), LOG_DAMAGE);
    assert_int_equal(damage.offset, whole.log.size);
    assert_int_equal(damage.length, large - (off_t) whole.log.size);
    assert_string_equal(damage.what, "zeros");
    assert_in_range(reads.bytes, 1, 2 << 20);
}

static void a_hole_of_ten_gigabytes_is_skipped(void **state)
{
    struct log_event event;
    struct log_damage damage;
    char why[LOG_WHY_MAX], path[64];
    log_close(open_hole());
    snprintf(path, sizeof path, "/proc/self/fd/%d", descriptor);
    assert_int_equal(pwrite(descriptor, whole.log.bytes, whole.log.size, large), whole.log.size);
    struct log_reader *reader = log_open(path, why);
    expect_hole(reader);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(log_next(reader, &event, &damage), LOG_EVENT);
        assert_int_equal(event.offset, large + (off_t) whole.begin[i]);
    }
    assert_int_equal(log_next(reader, &event, &damage), LOG_END);
    log_close(reader);
}

static void a_hole_at_the_end_is_damage(void **state)
{
    struct log_event event;
    struct log_damage damage;
    struct log_reader *reader = open_hole();
    expect_hole(reader);
    assert_int_equal(log_next(reader, &event, &damage), LOG_END);
    log_close(reader);
    reader = open_hole(); /* also where something is written far after it later */
    assert_int_equal(pwrite(descriptor, whole.log.bytes, whole.log.size, large + (1 << 20)),
                     whole.log.size);
    expect_hole(reader);
    assert_int_equal(log_next(reader, &event, &damage), LOG_END);
    log_close(reader);
}

/* A unit again and again, to the largest file here. */
static void fill_with(void (*unit)(void))
{
    clear();
    while (whole.log.size < BYTES_MAX - 2000)
        unit();
}

static void long_lie(void)
{
    log_draft_header(&whole.log, 0, 0, 1, 1 << 20);
}

static void lies_into_the_buffer(void)
{
    log_draft_header(&whole.log, 0, 0, 1, 200000);
    log_draft_header(&whole.log, 0, 0, 1, 2);
    log_draft_raw(&whole.log, "abc", 3);
}

static void sync_words(void)
{
    log_draft_raw(&whole.log, "\xed\xa1\xda\x01", 4);
}

static void first_bytes(void)
{
    log_draft_raw(&whole.log, "\xed\xed\xed\xed\xed\xed\xed\xed", 8);
}

/* Each possible place is within the header before it. */
static void nested_headers(void)
{
    log_draft_raw(&whole.log, "\xed\xa1\xda\x01\xed\xa1\xda\x01\0\0\0\1", 12);
    log_draft_raw(&whole.log, "\0\0\0\1\0\0\0\1\0\0\0\1\0\0\0\1\0\0\0\1", 20);
}

/* Nothing in it, and it is no hole. */
static void ones(void)
{
    static unsigned char bytes[1000];
    memset(bytes, 1, sizeof bytes);
    if (whole.log.size == 0)
        add_event(0, "CHANNEL", "data", 4);
    log_draft_raw(&whole.log, bytes, sizeof bytes);
}

static void garbage_after(void)
{
    log_draft_header(&whole.log, 0, 0, 1, 1000);
    log_draft_raw(&whole.log, noise, 1002);
}

/* Not much more is read than the file, in calls that are at most as many as there are headers. */
static void work_grows_only_with_the_size(void **state)
{
    static void (*const units[])(void) = {long_lie,     lies_into_the_buffer, sync_words,
                                          first_bytes,  nested_headers,       ones,
                                          garbage_after};
    struct log_event event;
    struct log_damage damage;
    make_noise(3);
    for (size_t i = 0; i < COUNT(units); i++) {
        fill_with(units[i]);
        struct log_reader *reader = open_bytes(whole.log.bytes, whole.log.size);
        memset(&reads, 0, sizeof reads);
        int64_t at = 0;
        for (;;) {
            const enum log_outcome outcome = log_next(reader, &event, &damage);
            if (outcome == LOG_END)
                break;
            assert_true(outcome != LOG_FAILED);
            at += outcome == LOG_EVENT ? event.length : damage.length;
        }
        assert_int_equal(at, whole.log.size);
        assert_in_range(reads.bytes, whole.log.size, 2 * whole.log.size);
        assert_in_range(reads.calls, 1, whole.log.size / 14);
        log_close(reader);
    }
}

/* ---- Seeking --------------------------------------------------------------------------------- */

/* From each byte of a log that is damaged in several places, what is read is what was read from
 * there on, or from the next event. */
static void seeking_finds_what_reading_found(void **state)
{
    make_small();
    log_draft_header(&whole.log, 5, 40, 5, 1000); /* into the next */
    log_draft_raw(&whole.log, "D1234five!", 10);
    for (int i = 0; i < 5; i++) {
        add_event(i, "CHANNEL", "data", 4);
        log_draft_raw(&whole.log, "??\0", (size_t) i % 4);
    }
    struct log_reader *reader = open_bytes(whole.log.bytes, whole.log.size);
    const struct report all = read_on(reader, 0, whole.log.bytes);
    for (size_t offset = whole.log.size + 1; offset-- > 0;) {
        size_t next = 0;
        while (next < all.count &&
               (all.item[next].damage || all.item[next].offset < (int64_t) offset))
            next++;
        const int64_t at = next < all.count ? all.item[next].offset : (int64_t) whole.log.size;
        log_seek(reader, (int64_t) offset);
        const struct report report = read_on(reader, at, whole.log.bytes);
        assert_int_equal(report.count, all.count - next);
    }
    log_close(reader);
}

static void seeking_in_a_log_of_many_buffers(void **state)
{
    struct log_event event;
    struct log_damage damage;
    make_noise(4);
    clear();
    while (whole.log.size < BYTES_MAX - sizeof noise - 100)
        add_event((int64_t) whole.count, "CHANNEL", noise, draw_size());
    struct log_reader *reader = open_bytes(whole.log.bytes, whole.log.size);
    for (int i = 0; i < 2000; i++) {
        const size_t index = (size_t) rand() % whole.count;
        log_seek(reader, (int64_t) whole.begin[index]);
        for (size_t n = index; n < index + 3 && n < whole.count; n++) {
            assert_int_equal(log_next(reader, &event, &damage), LOG_EVENT);
            assert_int_equal(event.offset, whole.begin[n]);
            check_event(&event, whole.log.bytes);
        }
    }
    log_close(reader);
}

/* ---- Files that change, and that cannot be read ---------------------------------------------- */

static void what_is_written_later_is_not_read(void **state)
{
    make_small();
    struct log_reader *reader = open_bytes(whole.log.bytes, whole.begin[2]);
    assert_int_equal(pwrite(descriptor, whole.log.bytes, whole.log.size, 0), whole.log.size);
    assert_int_equal(read_on(reader, 0, whole.log.bytes).count, 2);
    log_close(reader);
}

static void expect_failed(struct log_reader *reader, int error)
{
    struct log_event event;
    struct log_damage damage;
    for (int i = 0; i < 3; i++) {
        errno = 0;
        assert_int_equal(log_next(reader, &event, &damage), LOG_FAILED);
        assert_int_equal(errno, error);
    }
}

static void a_file_that_becomes_shorter_ends_reading(void **state)
{
    struct log_event event;
    struct log_damage damage;
    make_noise(5);
    clear();
    for (int i = 0; i < 10; i++)
        add_event(i, "CHANNEL", noise, LOG_DATA_MAX);
    for (size_t left = 0; left < whole.log.size; left += 99991) {
        struct log_reader *reader = open_bytes(whole.log.bytes, whole.log.size);
        assert_int_equal(log_next(reader, &event, &damage), LOG_EVENT);
        assert_int_equal(ftruncate(descriptor, (off_t) left), 0);
        int events = 1;
        while (events < 10 && log_next(reader, &event, &damage) == LOG_EVENT)
            check_event(&event, whole.log.bytes), events++;
        assert_in_range(events, 1, 9);
        expect_failed(reader, ENODATA);
        log_close(reader);
    }
}

/* Overwrites the lengths of the first event with impossible ones. */
static void change_file(void)
{
    static const unsigned char lengths[8] = {0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff};
    assert_int_equal(pwrite(descriptor, lengths, 8, LOG_HEADER_BYTES - 8), 8);
}

/* Reads to the end. Lengths are within their limits, whatever the file contains. */
static void read_changed(struct log_reader *reader)
{
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    int64_t at = 0;
    while ((outcome = log_next(reader, &event, &damage)) < LOG_END) {
        if (outcome == LOG_EVENT) {
            assert_in_range(event.channel_length, 1, LOG_CHANNEL_MAX - 1);
            assert_int_equal(event.channel[event.channel_length], 0);
            assert_int_equal(event.length, LOG_HEADER_BYTES + event.channel_length + event.size);
            assert_int_equal(event.kept, event.size < LOG_DATA_MAX ? event.size : LOG_DATA_MAX);
        }
        assert_int_equal(outcome == LOG_EVENT ? event.offset : damage.offset, at);
        at += outcome == LOG_EVENT ? event.length : damage.length;
    }
    assert_int_equal(outcome, LOG_END);
    assert_int_equal(at, whole.log.size);
}

/* The header of an event is read into the buffer several times, since the bytes after it are
 * damaged. It changes before each of these reads. */
static void a_file_may_change_while_it_is_read(void **state)
{
    static unsigned char image[4 * LOG_DATA_MAX];
    make_noise(5);
    clear();
    add_event(1, "CAMERA", image, sizeof image);
    log_draft_raw(&whole.log, "damage", 6);
    add_event(2, "CHANNEL", noise, 1000);
    for (int64_t call = 0, last = 0; call <= last; call++) {
        struct log_reader *reader = open_bytes(whole.log.bytes, whole.log.size);
        reads.calls = 0;
        reads.change_at = call;
        read_changed(reader);
        if (call == 0) /* the file does not change */
            last = reads.calls;
        assert_true(last > 3);
        log_close(reader);
    }
    reads.change_at = 0;
}

static void all_data_of_an_event_are_read(void **state)
{
    static unsigned char image[3 * LOG_DATA_MAX + 5], data[sizeof image];
    struct log_event event;
    struct log_damage damage;
    for (size_t i = 0; i < sizeof image; i++)
        image[i] = (unsigned char) (i * i >> 5);
    clear();
    add_event(1, "CAMERA", image, sizeof image);
    struct log_reader *reader = open_bytes(whole.log.bytes, whole.log.size);
    assert_int_equal(log_next(reader, &event, &damage), LOG_EVENT);
    assert_true(log_read_data(reader, &event, data));
    assert_memory_equal(data, image, sizeof image);
    assert_int_equal(ftruncate(descriptor, (off_t) whole.log.size - 1), 0);
    errno = 0;
    assert_false(log_read_data(reader, &event, data));
    assert_int_equal(errno, ENODATA);
    expect_failed(reader, ENODATA);
    log_close(reader);
}

/* Also where nothing but a hole is to come. */
static void a_hole_that_becomes_shorter_ends_reading(void **state)
{
    struct log_event event;
    struct log_damage damage;
    struct log_reader *reader = open_hole();
    for (int i = 0; i < 4; i++)
        assert_int_equal(log_next(reader, &event, &damage), LOG_EVENT);
    assert_int_equal(ftruncate(descriptor, large / 2), 0);
    expect_failed(reader, ENODATA);
    log_close(reader);
}

static void a_file_that_cannot_be_read_is_an_error(void **state)
{
    make_small();
    struct log_reader *reader = open_bytes(whole.log.bytes, whole.log.size);
    reads.error = EIO;
    expect_failed(reader, EIO);
    reads.error = 0;
    expect_failed(reader, EIO);
    log_close(reader);
}

static void expect_refused(const char *path, const char *reason)
{
    char why[LOG_WHY_MAX] = "";
    assert_null(log_open(path, why));
    assert_string_equal(why, reason);
}

static void what_is_no_file_is_refused(void **state)
{
    char folder[] = "/tmp/fmb-test-XXXXXX", pipe[64];
    assert_non_null(mkdtemp(folder));
    snprintf(pipe, sizeof pipe, "%s/pipe", folder);
    assert_int_equal(mkfifo(pipe, 0600), 0);
    expect_refused(pipe, "no regular file");
    expect_refused(folder, "no regular file");
    expect_refused("/dev/zero", "no regular file");
    unlink(pipe);
    expect_refused(pipe, strerror(ENOENT));
    rmdir(folder);
    log_close(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_event_is_what_was_written),
        cmocka_unit_test(the_longest_event_is_read),
        cmocka_unit_test(lcm_reads_the_same),
        cmocka_unit_test(every_truncation_is_read_up_to_its_end),
        cmocka_unit_test(every_damaged_byte_is_reported),
        cmocka_unit_test(garbage_is_reported_everywhere),
        cmocka_unit_test(false_lengths_are_damage),
        cmocka_unit_test(a_log_after_a_truncated_log_is_read),
        cmocka_unit_test(a_log_in_a_message_is_data),
        cmocka_unit_test(a_hole_of_ten_gigabytes_is_skipped),
        cmocka_unit_test(a_hole_at_the_end_is_damage),
        cmocka_unit_test(work_grows_only_with_the_size),
        cmocka_unit_test(seeking_finds_what_reading_found),
        cmocka_unit_test(seeking_in_a_log_of_many_buffers),
        cmocka_unit_test(what_is_written_later_is_not_read),
        cmocka_unit_test(a_file_that_becomes_shorter_ends_reading),
        cmocka_unit_test(a_file_may_change_while_it_is_read),
        cmocka_unit_test(all_data_of_an_event_are_read),
        cmocka_unit_test(a_hole_that_becomes_shorter_ends_reading),
        cmocka_unit_test(a_file_that_cannot_be_read_is_an_error),
        cmocka_unit_test(what_is_no_file_is_refused),
    };
    const int failed = cmocka_run_group_tests_name("log_read", tests, NULL, NULL);
    log_draft_free(&whole.log);
    log_draft_free(&inner);
    return failed;
}
