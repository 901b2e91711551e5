/* A replay of a cut reports for each of its queries what a replay of the whole log reports; and its
 * events are those of the log, byte for byte, after the definitions that they need. */
#include "unit.h"

#include "log_cut.h"

#include "input.h"
#include "log_world.h"
#include "log_write.h"
#include "replay.h"
#include "wire.h"

#include <errno.h>
#include <math.h>
#include <unistd.h>

enum { EVENTS_MAX = 4000 };

/* ---- Files ---- */

enum { PATH_MAX_OF_TESTS = 128 };

static char folder[100];

static int make_folder(void **state)
{
    const char *temporary = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%.80s/fmb_cut.XXXXXX", temporary ? temporary : "/tmp");
    return mkdtemp(folder) ? 0 : -1;
}

static char *path_of(const char *name, char path[PATH_MAX_OF_TESTS])
{
    snprintf(path, PATH_MAX_OF_TESTS, "%s/%s", folder, name);
    return path;
}

static int remove_folder(void **state)
{
    static const char *const names[] = {"whole", "cut", "again", "first", "second"};
    char path[PATH_MAX_OF_TESTS];
    for (size_t i = 0; i < COUNT(names); i++)
        unlink(path_of(names[i], path));
    return rmdir(folder);
}

/* ---- Reading ---- */

static int reads, fails_at; /* the number of a read, from 1; 0: none fails */

ssize_t __real_pread64(int fd, void *out, size_t count, off_t offset);
ssize_t __wrap_pread64(int fd, void *out, size_t count, off_t offset);

ssize_t __wrap_pread64(int fd, void *out, size_t count, off_t offset)
{
    errno = EIO;
    return ++reads == fails_at ? -1 : __real_pread64(fd, out, count, offset);
}

/* ---- What a replay says of each query ---- */

struct query_outcomes {
    size_t count;
    struct {
        int64_t sequence_number; /* no two clients have the same */
        enum replay_outcome outcome;
    } query[EVENTS_MAX];
};

static struct query_outcomes *taken;

void __wrap_page_take(struct page *page, const struct page_replayed *replayed,
                      struct exchange *then, struct exchange *now);

void __wrap_page_take(struct page *page, const struct page_replayed *replayed,
                      struct exchange *then, struct exchange *now)
{
    (void) page;
    (void) then;
    assert_true(taken->count < EVENTS_MAX);
    taken->query[taken->count].sequence_number = now->query->header.sequence_number;
    taken->query[taken->count++].outcome = replayed->outcome;
}

static void on_found(void *user, const struct difference *found)
{
    (void) user;
    (void) found;
}

static void on_unreadable(void *user, const struct match_place *place, const char *channel,
                          const char *what)
{
    (void) user;
    (void) place;
    (void) channel;
    (void) what;
}

static void on_damage(void *user, int log, const struct log_damage *damage)
{
    (void) user;
    (void) log;
    (void) damage;
    fail_msg("a damaged log");
}

static void on_progress(void *user, int64_t bytes, int64_t of)
{
    (void) user;
    assert_in_range(bytes, 0, of);
}

static const struct replay_sink replay_sink = {on_found, on_unreadable, on_damage, on_progress,
                                               NULL};

static void replay(char *log, struct query_outcomes *out)
{
    struct replay_options options = {
        .log = &log, .log_count = 1, .prefix = "", .frames = 1000, .page = (struct page *) &taken};
    struct tally tally = {.events = 0};
    out->count = 0;
    taken = out;
    assert_true(replay_run(&options, &replay_sink, &tally));
}

/* Queries of cuts that were the same, so far. */
static int64_t compared;

/* Of what: for people. */
static char cut_name[200];

/* Whether a query with this number had this outcome. */
static bool has_outcome(const struct query_outcomes *outcomes, int64_t sequence_number,
                        enum replay_outcome outcome)
{
    for (size_t i = 0; i < outcomes->count; i++)
        if (outcomes->query[i].sequence_number == sequence_number &&
            outcomes->query[i].outcome == outcome)
            return true;
    return false;
}

/* Where a client repeated a query, the results may have gone to the one or the other. */
static void assert_same_outcomes(const struct query_outcomes *whole,
                                 const struct query_outcomes *cut)
{
    for (size_t i = 0; i < cut->count; i++) {
        const int64_t number = cut->query[i].sequence_number;
        const enum replay_outcome outcome = cut->query[i].outcome;
        if (!has_outcome(whole, number, outcome))
            fail_msg("%s: query %ld was another one before than %d", cut_name, (long) number,
                     (int) outcome);
        compared += outcome == REPLAY_SAME;
    }
}

/* ---- What is in a cut ---- */

/* Reads the logs, one after the other. */
struct reading {
    struct input input;
    struct log_event event;
};

static void open_reading(struct reading *reading, char *const *log, int count)
{
    assert_true(input_open(&reading->input, log, count));
}

static bool read_next(struct reading *reading)
{
    struct log_damage damage;
    const enum log_outcome outcome = input_next(&reading->input, &reading->event, &damage);
    assert_true(outcome == LOG_EVENT || outcome == LOG_END);
    return outcome == LOG_EVENT;
}

static struct log_channels channels;

static enum log_kind kind_of(const struct log_event *event)
{
    return log_kind_of(&channels, event);
}

static bool is_same_event(const struct log_event *a, const struct log_event *b)
{
    assert_int_equal(a->utime, b->utime);
    assert_string_equal(a->channel, b->channel);
    return a->size == b->size && memcmp(a->data, b->data, a->kept) == 0;
}

/* One that a cut has added. */
static bool is_added(const struct log_event *event)
{
    static struct definition definition;
    if (kind_of(event) != LOG_DEFINITION ||
        wire_read_definition(event->data, (uint32_t) event->kept, &definition))
        return false;
    return definition.client_id == 0 && definition.server_id == 0;
}

static bool is_chosen(const struct log_choice *choice, const struct log_event *event)
{
    return log_choice_has_time(choice, LOG_WORLD_BEGIN, event->utime) &&
           log_choice_has_channel(choice, event->channel);
}

/* The next event that the cut has not added. */
static bool read_copied(struct reading *reading)
{
    bool more = read_next(reading);
    while (more && is_added(&reading->event))
        more = read_next(reading);
    return more;
}

/* What a cut has to hold is there, in its order, and nothing else but definitions; results are
 * checked by the outcomes of their queries. */
static void assert_holds(char *log, char *cut, const struct log_choice *choice)
{
    struct reading whole, part;
    open_reading(&whole, &log, 1);
    open_reading(&part, &cut, 1);
    bool more = read_copied(&part);
    while (read_copied(&whole)) {
        const bool is_here = more && part.event.utime == whole.event.utime;
        if (!log_kind_is_result(kind_of(&whole.event)))
            assert_int_equal(is_here, is_chosen(choice, &whole.event));
        if (!is_here)
            continue;
        assert_true(is_same_event(&whole.event, &part.event));
        more = read_copied(&part);
    }
    assert_false(more);
    input_close(&whole.input);
    input_close(&part.input);
}

/* ---- Cutting ---- */

static struct log_cut_counts cut_logs(char *const *log, int count, const char *output,
                                      const struct log_choice *choice)
{
    const struct output_rules rules = {.force = true, .input = log, .input_count = count};
    const struct log_cut_options options = {.log = log,
                                            .log_count = count,
                                            .prefix = "",
                                            .output = {output, OUTPUT_LOG, &rules, NULL},
                                            .choice = *choice};
    struct log_cut_counts counts;
    unlink(output);
    reads = 0;
    const bool good = log_cut(&options, &counts);
    assert_int_equal(good, fails_at == 0 || reads < fails_at);
    assert_int_equal(counts.damages, 0);
    if (!good || counts.kept_events == 0) {
        assert_int_equal(access(output, F_OK), -1);
        close(output_open_in_place(output, false));
    }
    return counts;
}

/* Cuts, and checks that all is as it was. whole: what a replay of the log reports. */
static struct log_cut_counts cut_and_check(char *log, char *cut, const struct log_choice *choice,
                                           const struct query_outcomes *whole,
                                           struct query_outcomes *out)
{
    const struct log_cut_counts counts = cut_logs(&log, 1, cut, choice);
    assert_holds(log, cut, choice);
    replay(cut, out);
    assert_same_outcomes(whole, out);
    return counts;
}

/* ---- Small worlds ---- */

static struct query_outcomes whole_outcomes, cut_outcomes, again_outcomes;

/* What the cuts of the test had to do. */
static struct log_cut_counts all;

static void add_counts(const struct log_cut_counts *counts)
{
    all.defined += counts->defined;
    all.unknown += counts->unknown;
}

static struct log_choice between(double from, double to)
{
    struct log_choice choice = log_choice_all();
    choice.from = from;
    choice.to = to;
    return choice;
}

/* In seconds: there is an event each millisecond. */
static double draw_time(struct log_world *world)
{
    return 1e-3 * world_draw(world, (int) world->count);
}

static struct log_choice draw_choice(struct log_world *world)
{
    static const char *const channel[] = {"FMB_(PAIR|SCENE)_.*|CAMERA", "FMB_SCENE_.*|.*RESULT",
                                          "FMB_.*_RESULT"};
    struct log_choice choice = log_choice_all();
    if (world_draw(world, 4) > 0)
        choice.from = draw_time(world);
    if (world_draw(world, 4) > 1)
        choice.to = choice.from == -INFINITY ? draw_time(world) : choice.from + draw_time(world);
    if (world_draw(world, 4) == 0) {
        optarg = (char *) (uintptr_t) channel[world_draw(world, 3)];
        assert_true(log_choice_take_channel(NULL, &choice));
    }
    return choice;
}

static void name_cut(const struct log_world *world, const struct log_choice *choice)
{
    snprintf(cut_name, sizeof cut_name, "seed %lu: from %g to %g", (unsigned long) world->seed,
             choice->from, choice->to);
}

/* A cut of the world's log, and a cut of that. */
static void cut_twice(struct log_world *world, char *whole)
{
    char cut[PATH_MAX_OF_TESTS], again[PATH_MAX_OF_TESTS];
    path_of("cut", cut);
    path_of("again", again);
    struct log_choice choice = draw_choice(world), narrower = draw_choice(world);
    name_cut(world, &choice);
    struct log_cut_counts counts =
        cut_and_check(whole, cut, &choice, &whole_outcomes, &cut_outcomes);
    add_counts(&counts);
    /* Times count from the first event of the log that is cut. */
    narrower.from = -INFINITY;
    narrower.to = INFINITY;
    counts = cut_logs(&(char *){cut}, 1, again, &narrower);
    replay(again, &again_outcomes);
    assert_same_outcomes(&cut_outcomes, &again_outcomes);
    log_choice_clear(&choice);
    log_choice_clear(&narrower);
}

/* options: of the world; its seed is the first of so many. */
static void cut_worlds(struct world_options options, int count)
{
    char whole[PATH_MAX_OF_TESTS];
    path_of("whole", whole);
    channels = log_channels("");
    for (const uint64_t first = options.seed; options.seed < first + (uint64_t) count;
         options.seed++) {
        struct log_world world;
        world_make(&options, &world);
        world_write(&world, whole);
        replay(whole, &whole_outcomes);
        for (int i = 0; i < 12; i++)
            cut_twice(&world, whole);
        log_world_clear(&world);
    }
}

enum { STEPS = 60 };

static int worlds(void)
{
    return getenv("FMB_FAST") ? 2 : 6;
}

static void cuts_of_small_worlds(void **state)
{
    all = (struct log_cut_counts){.events = 0};
    compared = 0;
    cut_worlds((struct world_options){.seed = 1, .steps = STEPS, .once = true}, worlds());
    assert_true(all.defined > 0 && all.unknown == 0);
    assert_true(compared > 0);
}

static void cuts_where_clients_repeat_queries(void **state)
{
    cut_worlds((struct world_options){.seed = 1, .steps = STEPS}, worlds());
}

static void all_is_copied_where_nothing_is_left_out(void **state)
{
    char whole[PATH_MAX_OF_TESTS], cut[PATH_MAX_OF_TESTS];
    const struct world_options options = {.seed = 3, .steps = 100};
    const struct log_choice choice = log_choice_all();
    struct log_world world;
    channels = log_channels("");
    world_make(&options, &world);
    world_write(&world, path_of("whole", whole));
    replay(whole, &whole_outcomes);
    const struct log_cut_counts counts =
        cut_and_check(whole, path_of("cut", cut), &choice, &whole_outcomes, &cut_outcomes);
    assert_int_equal(counts.kept_events, world.count);
    assert_true(counts.defined > 0 || counts.kept_bytes == counts.bytes);
    log_world_clear(&world);
}

/* Of the parts of a log each has what the others have not: results go with their queries. */
static void parts_are_the_whole(void **state)
{
    char whole[PATH_MAX_OF_TESTS], cut[PATH_MAX_OF_TESTS];
    const struct world_options options = {.seed = 9, .steps = 100};
    struct log_world world;
    int64_t events = 0;
    channels = log_channels("");
    world_make(&options, &world);
    world_write(&world, path_of("whole", whole));
    replay(whole, &whole_outcomes);
    for (int part = 0; part < 5; part++) {
        const struct log_choice choice =
            between(0.1 * part, part == 4 ? INFINITY : 0.1 * (part + 1));
        events += cut_and_check(whole, path_of("cut", cut), &choice, &whole_outcomes, &cut_outcomes)
                      .kept_events;
    }
    assert_int_equal(events, world.count);
    log_world_clear(&world);
}

/* ---- Several logs ---- */

static void several_logs_are_one(void **state)
{
    char whole[PATH_MAX_OF_TESTS], first[PATH_MAX_OF_TESTS], second[PATH_MAX_OF_TESTS],
        cut[PATH_MAX_OF_TESTS], again[PATH_MAX_OF_TESTS];
    const struct world_options options = {.seed = 4, .steps = 80};
    struct log_world world, begin, end;
    channels = log_channels("");
    world_make(&options, &world);
    begin = end = world;
    begin.count = world.count / 3;
    end.event = world.event + begin.count;
    end.count = world.count - begin.count;
    world_write(&world, path_of("whole", whole));
    world_write(&begin, path_of("first", first));
    world_write(&end, path_of("second", second));
    const struct log_choice choice = between(1e-3 * (double) (world.count / 2), INFINITY);
    char *logs[] = {first, second};
    const struct log_cut_counts counts = cut_logs(logs, 2, path_of("cut", cut), &choice);
    const struct log_cut_counts same =
        cut_logs(&(char *){whole}, 1, path_of("again", again), &choice);
    assert_true(counts.defined > 0);
    assert_memory_equal(&counts, &same, sizeof counts);
    assert_holds(again, cut, &(struct log_choice){.from = -INFINITY, .to = INFINITY});
    log_world_clear(&world);
}

/* ---- Many bodies ---- */

enum { LARGE_BODIES = 700, LARGE_SCENES = 3 };

/* Three scenes have the bodies whole; in a cut without them they take two definitions. */
static void many_bodies_are_defined(void **state)
{
    char whole[PATH_MAX_OF_TESTS], cut[PATH_MAX_OF_TESTS], again[PATH_MAX_OF_TESTS];
    struct log_world world;
    channels = log_channels("");
    world_make_large(LARGE_BODIES, LARGE_SCENES, &world);
    world_write(&world, path_of("whole", whole));
    replay(whole, &whole_outcomes);
    struct log_choice choice = between(0.006, INFINITY);
    struct log_cut_counts counts =
        cut_and_check(whole, path_of("cut", cut), &choice, &whole_outcomes, &cut_outcomes);
    assert_int_equal(cut_outcomes.count, LARGE_SCENES);
    assert_int_equal(cut_outcomes.query[0].outcome, REPLAY_SAME);
    assert_int_equal(counts.kept_events, 2 * LARGE_SCENES);
    assert_int_equal(counts.defined, LARGE_BODIES);
    /* The copied queries define some of them. */
    choice = between(0.002, INFINITY);
    counts = cut_and_check(whole, cut, &choice, &whole_outcomes, &cut_outcomes);
    assert_int_equal(counts.defined, LARGE_BODIES % 300);
    /* Definitions that a cut leaves out are made anew. */
    choice = between(0.006, INFINITY);
    cut_logs(&(char *){whole}, 1, cut, &choice);
    choice = between(0.002, INFINITY);
    counts = cut_logs(&(char *){cut}, 1, path_of("again", again), &choice);
    assert_int_equal(counts.defined, LARGE_BODIES);
    replay(again, &again_outcomes);
    assert_int_equal(again_outcomes.count, LARGE_SCENES - 1);
    assert_int_equal(again_outcomes.query[0].outcome, REPLAY_SAME);
    /* Those that it keeps are copied, as any event. */
    choice = log_choice_all();
    counts = cut_logs(&(char *){cut}, 1, again, &choice);
    assert_int_equal(counts.defined, 0);
    assert_int_equal(counts.kept_bytes, counts.bytes);
    log_world_clear(&world);
}

/* Of a log that begins late: two of the three scenes that define bodies are not in it. */
static void undefined_handles_are_counted(void **state)
{
    char whole[PATH_MAX_OF_TESTS], cut[PATH_MAX_OF_TESTS];
    struct log_world world;
    const struct log_choice choice = log_choice_all();
    channels = log_channels("");
    world_make_large(LARGE_BODIES, LARGE_SCENES, &world);
    const struct log_world late = {.event = world.event + 4, .count = world.count - 4};
    world_write(&late, path_of("whole", whole));
    const struct log_cut_counts counts =
        cut_logs(&(char *){whole}, 1, path_of("cut", cut), &choice);
    assert_int_equal(counts.unknown, LARGE_BODIES - 300);
    assert_int_equal(counts.defined, 0);
    assert_int_equal(counts.kept_events, late.count);
    log_world_clear(&world);
}

/* In either pass: there is no cut then. */
static void a_read_error_is_one_of_the_cut(void **state)
{
    char whole[PATH_MAX_OF_TESTS], cut[PATH_MAX_OF_TESTS];
    const struct log_choice choice = log_choice_all();
    struct log_world world;
    world_make_large(LARGE_BODIES, LARGE_SCENES, &world);
    world_write(&world, path_of("whole", whole));
    do {
        fails_at++;
        cut_logs(&(char *){whole}, 1, path_of("cut", cut), &choice);
    } while (reads >= fails_at);
    assert_true(fails_at > 4);
    fails_at = 0;
    log_world_clear(&world);
}

/* ---- Large logs ---- */

/* Results that stand megabytes after their queries. */
static void results_come_from_far(void **state)
{
    enum { PAIRS = 40000, BEGIN = 20000, COUNT = 1000 };
    char whole[PATH_MAX_OF_TESTS], cut[PATH_MAX_OF_TESTS];
    struct log_world world;
    channels = log_channels("");
    world_make_apart(PAIRS, &world);
    world_write(&world, path_of("whole", whole));
    log_world_clear(&world);
    struct log_choice choice = between(1e-3 * BEGIN, 1e-3 * (BEGIN + COUNT));
    const struct log_cut_counts counts =
        cut_logs(&(char *){whole}, 1, path_of("cut", cut), &choice);
    assert_int_equal(counts.kept[LOG_PAIR_QUERY], COUNT);
    assert_int_equal(counts.kept[LOG_PAIR_RESULT], COUNT);
    assert_int_equal(counts.kept_events, 2 * COUNT);
    replay(cut, &cut_outcomes);
    assert_int_equal(cut_outcomes.count, COUNT);
    for (size_t i = 0; i < cut_outcomes.count; i++)
        assert_int_equal(cut_outcomes.query[i].outcome, REPLAY_SAME);
}

/* What is kept of an event in memory is not all that is copied. */
static void long_events_are_copied_in_full(void **state)
{
    static unsigned char image[3000001], data[sizeof image];
    char whole[PATH_MAX_OF_TESTS], cut[PATH_MAX_OF_TESTS];
    struct log_world world = {.state = 1};
    const struct log_choice choice = log_choice_all();
    struct reading reading;
    for (size_t i = 0; i < sizeof image; i++)
        image[i] = (unsigned char) (i * i >> 5);
    world_add(&world, "CAMERA", image, sizeof image);
    world_add(&world, "CAMERA", image, LOG_DATA_MAX + 1);
    world_add(&world, "FMB_SCENE_QUERY", image, LOG_DATA_MAX + 2);
    world_write(&world, path_of("whole", whole));
    cut_logs(&(char *){whole}, 1, path_of("cut", cut), &choice);
    open_reading(&reading, &(char *){cut}, 1);
    for (size_t i = 0; i < world.count; i++) {
        assert_true(read_next(&reading));
        assert_int_equal(reading.event.size, world.event[i].size);
        assert_int_equal(reading.event.utime, world.event[i].utime);
        assert_string_equal(reading.event.channel, world.event[i].channel);
        assert_true(log_read_data(reading.input.reader, &reading.event, data));
        assert_memory_equal(data, world.event[i].bytes, world.event[i].size);
    }
    assert_false(read_next(&reading));
    input_close(&reading.input);
    log_world_clear(&world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cuts_of_small_worlds),
        cmocka_unit_test(cuts_where_clients_repeat_queries),
        cmocka_unit_test(all_is_copied_where_nothing_is_left_out),
        cmocka_unit_test(parts_are_the_whole),
        cmocka_unit_test(several_logs_are_one),
        cmocka_unit_test(many_bodies_are_defined),
        cmocka_unit_test(undefined_handles_are_counted),
        cmocka_unit_test(a_read_error_is_one_of_the_cut),
        cmocka_unit_test(results_come_from_far),
        cmocka_unit_test(long_events_are_copied_in_full),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
