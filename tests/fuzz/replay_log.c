/* Any bytes, as an event log that is replayed: all of it adds up and is told, whatever fits into
 * memory; a second replay reports the same, and so do several parts of any size, taken together,
 * and one with so little memory that most of it goes through files. */
#include "fuzz.h"

#include "definition.h"
#include "log_draft.h"
#include "message.h"
#include "replay_junit.h"
#include "replay_json.h"
#include "replay_report.h"
#include "replay_small.h"
#include "replay_text.h"
#include "wire.h"

#include <cjson/cJSON.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Of an input that has larger scenes, or more of all, nothing is asked. */
enum { FRAMES_MAX = 20, PAIRS_MAX = 100, EVENTS_MAX = 200 };

/* Room for all that an input has, mostly; and for little of it. */
enum { RECENT_MANY = 1 << 18, BODIES_MANY = 64, BODIES_FEW = 2 };

/* ---- What the log holds ---- */

/* A first look at the events. */
struct look {
    bool slow;                    /* answering may take long */
    bool once;                    /* no two results have the same ids, and no two queries */
    bool keys;                    /* there are some in queries */
    int64_t events[LOG_KINDS];    /* [enum log_kind] */
    int64_t definitions, results; /* of these, those; and results whose ids can be read */
    int count;                    /* queries and results */
    struct {
        enum log_kind kind;
        struct query_header ids;
    } message[EVENTS_MAX];
};

/* Exponents of the numbers of a query: from the least to the largest that is not 0. Numbers from
 * one end of the doubles to the other take exact arithmetic long. */
struct spread {
    int least, most;
};

static void widen(struct spread *spread, const struct query_numbers *numbers)
{
    const int kept = numbers->count < FMB_COMPONENTS_MAX ? numbers->count : FMB_COMPONENTS_MAX;
    for (int i = 0; i < kept; i++) {
        if (numbers->number[i] == 0 || !isfinite(numbers->number[i]))
            continue;
        const int exponent = ilogb(numbers->number[i]);
        spread->least = exponent < spread->least ? exponent : spread->least;
        spread->most = exponent > spread->most ? exponent : spread->most;
    }
}

static void look_at_frames(struct look *look, const struct query_frame *frame, int32_t count)
{
    struct spread spread = {0, 0};
    for (int32_t i = 0; i < count; i++) {
        widen(&spread, &frame[i].origin);
        widen(&spread, &frame[i].components);
        widen(&spread, &frame[i].velocity);
        look->keys = look->keys || frame[i].key != 0;
    }
    look->slow = look->slow || spread.most - spread.least > 100;
}

static void look_at_query(struct look *look, enum log_kind kind, const struct log_event *event)
{
    static struct pair_query pair;
    static struct scene_query scene;
    const uint32_t size = (uint32_t) event->kept;
    if (kind == LOG_PAIR_QUERY && !wire_read_pair_query(event->data, size, &pair))
        look_at_frames(look, pair.frame, 2);
    if (kind != LOG_SCENE_QUERY || wire_read_scene_query(event->data, size, &scene))
        return;
    if (scene.frame_count > FRAMES_MAX || scene.index_count > 2 * PAIRS_MAX)
        look->slow = true;
    else
        look_at_frames(look, scene.frame, scene.frame_count);
    look->definitions += scene.client_id == DEFINITION_CLIENT && definition_is(&scene);
}

static void look_at_ids(struct look *look, enum log_kind kind, const struct query_header *ids)
{
    for (int i = 0; i < look->count; i++)
        if (look->message[i].kind == kind && look->message[i].ids.client_id == ids->client_id &&
            look->message[i].ids.sequence_number == ids->sequence_number)
            look->once = false;
    look->message[look->count].kind = kind;
    look->message[look->count++].ids = *ids;
}

static void look_at_event(struct look *look, enum log_kind kind, const struct log_event *event)
{
    struct match_item item;
    look->events[kind]++;
    look_at_query(look, kind, event);
    if (!(message_is_query(kind) || message_is_result(kind)) ||
        message_read_ids(kind, event, &item))
        return;
    look->results += message_is_result(kind);
    look_at_ids(look, kind, &item.ids);
}

static struct look look_at(const char *path)
{
    const struct log_channels channels = log_channels("");
    struct look look = {.once = true};
    char why[LOG_WHY_MAX];
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    struct log_reader *reader = log_open(path, why);
    FUZZ_CHECK(reader);
    for (int events = 0; (outcome = log_next(reader, &event, &damage)) != LOG_END; events++) {
        FUZZ_CHECK(outcome != LOG_FAILED);
        look.slow = look.slow || events == EVENTS_MAX;
        if (look.slow)
            break;
        if (outcome == LOG_EVENT)
            look_at_event(&look, log_kind_of(&channels, &event), &event);
    }
    log_close(reader);
    return look;
}

/* ---- What is told of a replay ---- */

struct telling {
    struct listing *list;
    struct replay_json json;
    int64_t found, told;
    const struct replay_options *options;
};

static void on_found(void *user, const struct found *found)
{
    struct telling *telling = user;
    telling->found++;
    listing_put(telling->list, found);
}

static void on_unreadable(void *user, const struct match_place *place, const char *channel,
                          const char *what)
{
    (void) user;
    FUZZ_CHECK(place->offset >= 0 && channel[0] && what[0]);
}

static void on_damage(void *user, int log, const struct log_damage *damage)
{
    (void) user;
    FUZZ_CHECK(log == 0 && damage->length > 0 && damage->what[0]);
}

static void on_progress(void *user, int64_t bytes)
{
    (void) user;
    FUZZ_CHECK(bytes >= 0);
}

static void tell_one(void *user, const struct found *found)
{
    struct telling *telling = user;
    char line[REPLAY_LINE_MAX];
    replay_line(found, NULL, 0, line);
    FUZZ_CHECK(line[0] && !strchr(line, '\n'));
    replay_json_found(&telling->json, found, telling->options->log[0], 0);
    telling->told++;
}

static int64_t number_in(const cJSON *json, const char *name)
{
    const cJSON *number = cJSON_GetObjectItemCaseSensitive(json, name);
    FUZZ_CHECK(cJSON_IsNumber(number));
    return (int64_t) number->valuedouble;
}

static void check_json(const char *text, const struct telling *telling, const struct tally *tally)
{
    static const char *const outcome[] = {"same", "different", "busy", "unknown_body", "no_result"};
    cJSON *json = cJSON_Parse(text);
    FUZZ_CHECK(json);
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(json, "differences");
    FUZZ_CHECK(cJSON_GetArraySize(list) == telling->told);
    FUZZ_CHECK(number_in(json, "untold") == telling->found - telling->told);
    FUZZ_CHECK(number_in(json, "queries") == tally_queries(tally));
    for (int i = 0; i <= REPLAY_ALONE; i++)
        FUZZ_CHECK(number_in(json, outcome[i]) == tally_outcome(tally, (enum replay_outcome) i));
    cJSON_Delete(json);
}

static char *tell_all(struct telling *telling, const struct tally *tally)
{
    char *text;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    FUZZ_CHECK(out);
    telling->json = replay_json_begin(out);
    listing_each(telling->list, tell_one, telling);
    replay_json_end(&telling->json, tally, listing_beyond(telling->list), 0);
    FUZZ_CHECK(fclose(out) == 0);
    return text;
}

/* For people and for CI systems: whatever it is, it can be written. */
static void tell_others(struct telling *telling, const struct tally *tally)
{
    char *text;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    FUZZ_CHECK(out);
    replay_text_summary(out, tally);
    replay_junit(out, telling->options, telling->list, tally, 0);
    if (telling->options->page)
        page_write(telling->options->page, out);
    FUZZ_CHECK(!ferror(out) && fclose(out) == 0);
    free(text);
}

/* limit: of the differences that are told. */
static void check_telling(struct replay_options options, int64_t size, int64_t limit, bool page)
{
    struct telling telling = {.list = listing_open(limit), .options = &options};
    const struct replay_sink sink = {on_found, on_unreadable, on_damage, on_progress, &telling};
    struct tally tally = {.events = 0};
    options.page = page ? page_open(options.log[0], 0) : NULL;
    FUZZ_CHECK(replay_run(&options, (struct replay_part){0, size}, &sink, &tally));
    char *json = tell_all(&telling, &tally);
    FUZZ_CHECK(telling.told == (telling.found < limit ? telling.found : limit));
    check_json(json, &telling, &tally);
    tell_others(&telling, &tally);
    free(json);
    page_close(options.page);
    listing_close(telling.list);
}

/* ---- Replays ---- */

static uint64_t hash_of(const uint8_t *data, size_t size)
{
    uint64_t hash = 1;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ data[i]) * UINT64_C(1099511628211);
    return hash ^ hash >> 29;
}

static void check_same(const struct replay_report *report, struct replay_report again)
{
    FUZZ_CHECK(!replay_report_differ(report, &again));
    replay_report_free(&again);
}

/* Each event is counted, as what it is. */
static void check_counts(const struct tally *tally, const struct look *look)
{
    int64_t results = 0, events = 0, asked = look->definitions;
    for (int i = 0; i < TALLY_CHANNELS; i++) {
        results += tally->channel[i].results;
        asked += tally->channel[i].queries + tally->channel[i].unreadable[0];
    }
    for (int kind = 0; kind < LOG_KINDS; kind++)
        events += look->events[kind];
    FUZZ_CHECK(tally->events == events);
    FUZZ_CHECK(tally->statuses == look->events[LOG_STATUS]);
    FUZZ_CHECK(tally->other_events == look->events[LOG_OTHER]);
    FUZZ_CHECK(asked == look->events[LOG_PAIR_QUERY] + look->events[LOG_SCENE_QUERY]);
    FUZZ_CHECK(results == look->results);
}

static struct replay_report report_all(const struct replay_options *options, int64_t size,
                                       const struct look *look)
{
    struct replay_report report = replay_report_in(options, 1);
    FUZZ_CHECK(report.good);
    FUZZ_CHECK(!replay_report_odd(&report, size, look->once));
    check_counts(&report.tally, look);
    return report;
}

/* As the bytes choose them: the places are as good as any. */
static void check_parts(const struct replay_options *options, const struct replay_report *report,
                        int64_t size, uint64_t hash)
{
    const int64_t a = (int64_t) (hash >> 8) % (size + 1), b = (int64_t) (hash >> 20) % (size + 1);
    const int64_t boundary[] = {0, a < b ? a : b, a < b ? b : a, size};
    check_same(report, replay_report_of(options, boundary, 3));
}

/* Of ids that come once, what belongs together is found however far apart it stands. What keys
 * stand for is learned later then, and may be forgotten. */
static void check_small(const struct replay_options *options, const struct replay_report *report,
                        int64_t size, const struct look *look)
{
    struct replay_report small = report_all(options, size, look);
    if (look->once && !look->keys)
        FUZZ_CHECK(!replay_report_differ(report, &small));
    replay_report_free(&small);
}

static void check_replays(const struct replay_options *options, int64_t size, uint64_t hash,
                          const struct look *look)
{
    replay_small_begin(RECENT_MANY, BODIES_MANY);
    struct replay_report report = report_all(options, size, look);
    const struct replay_small used = replay_small_used();
    const bool fits = used.all <= RECENT_MANY && !used.forgets;
    if (fits && hash % 4 == 0)
        check_parts(options, &report, size, hash);
    if (hash % 4 == 1)
        check_same(&report, replay_report_in(options, 1));
    replay_small_begin(2 * used.longest, BODIES_FEW);
    if (fits)
        check_small(options, &report, size, look);
    if (hash % 4 >= 2)
        check_telling(*options, size, (int64_t) (hash >> 8) % 4, hash % 4 == 3);
    replay_report_free(&report);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[LOG_DRAFT_PATH_MAX];
    char *const paths[] = {path};
    const int file = log_draft_file(data, size, path);
    const struct look look = look_at(path);
    const struct replay_options options = {
        .log = paths, .log_count = 1, .prefix = "", .from = -INFINITY, .to = INFINITY, .bodies = 4};
    if (!look.slow)
        check_replays(&options, (int64_t) size, hash_of(data, size), &look);
    close(file);
    return 0;
}
