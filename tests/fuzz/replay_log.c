/* Any bytes, as an event log that is replayed: all counts agree and all is reported; a second
 * replay reports the same, and so do ranges of time, taken together. Its results are rows. */
#include "fuzz.h"

#include "cursor.h"
#include "log_draft.h"
#include "replay_output.h"
#include "replay_report.h"
#include "result_rows.h"
#include "wire.h"

#include <cjson/cJSON.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Inputs with larger scenes, or more events, are not replayed. */
enum { PLACEMENTS_MAX = 20, PAIRS_MAX = 100, EVENTS_MAX = 200 };

/* ---- What the log holds ---- */

/* A first look at the events. */
struct look {
    bool slow;                 /* answering may take long */
    int64_t events[LOG_KINDS]; /* [enum log_kind] */
    int64_t results;           /* whose ids can be read */
};

/* Exponents of the numbers of a query: from the least to the largest that is not 0. Numbers from
 * one end of the doubles to the other take exact arithmetic long. */
struct spread {
    int least, most;
};

static void widen(struct spread *spread, double number)
{
    if (number == 0 || !isfinite(number))
        return;
    const int exponent = ilogb(number);
    spread->least = exponent < spread->least ? exponent : spread->least;
    spread->most = exponent > spread->most ? exponent : spread->most;
}

/* The numbers of a geometry are its last bytes. */
static void look_at_geometry(struct look *look, struct spread *spread,
                             const struct body_view *geometry)
{
    for (size_t at = 8; at + 8 <= geometry->size; at += 8)
        widen(spread, cursor_double_at(geometry->bytes + geometry->size - at));
    look->slow = look->slow || spread->most - spread->least > 100;
}

static void look_at_placements(struct look *look, const struct query_placement *placement,
                               int32_t count)
{
    struct spread spread = {0, 0};
    for (int32_t i = 0; i < count; i++) {
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            widen(&spread, placement[i].placed.position[axis]);
            widen(&spread, placement[i].placed.velocity[axis]);
        }
        look_at_geometry(look, &spread, &placement[i].body);
    }
}

static void look_at_query(struct look *look, enum log_kind kind, const struct log_event *event)
{
    static struct logged_query query;
    if (!log_kind_is_query(kind) ||
        logged_query_read(&query, kind, event->data, (uint32_t) event->kept))
        return;
    if (query.placement_count > PLACEMENTS_MAX ||
        (kind == LOG_SCENE_QUERY && query.scene.index_count > 2 * PAIRS_MAX))
        look->slow = true;
    else if (event->kept <= QUERY_BYTES_MAX)
        look_at_placements(look, query.placement, query.placement_count);
}

static void look_at_definition(struct look *look, const struct log_event *event)
{
    static struct definition definition;
    struct spread spread = {0, 0};
    if (!wire_read_definition(event->data, (uint32_t) event->kept, &definition))
        for (int32_t i = 0; i < definition.body_count; i++)
            look_at_geometry(look, &spread, &definition.body[i]);
}

static void look_at_event(struct look *look, enum log_kind kind, const struct log_event *event)
{
    struct match_key key;
    look->events[kind]++;
    look_at_query(look, kind, event);
    if (kind == LOG_DEFINITION)
        look_at_definition(look, event);
    look->results += log_kind_is_result(kind) && !match_key_of(kind, event, &key);
}

static struct look look_at(const char *path)
{
    const struct log_channels channels = log_channels("");
    struct look look = {.slow = false};
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

/* ---- What is reported of a replay ---- */

struct reporting {
    struct listing *list;
    struct json_writer json;
    int64_t found, reported;
    const struct replay_options *options;
};

static void on_found(void *user, const struct difference *found)
{
    struct reporting *reporting = user;
    reporting->found++;
    listing_put(reporting->list, found);
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

static void on_progress(void *user, int64_t bytes, int64_t of)
{
    (void) user;
    FUZZ_CHECK(bytes >= 0 && bytes <= of);
}

static void report_one(void *user, const struct difference *found)
{
    struct reporting *reporting = user;
    char line[4096] = "";
    FILE *out = fmemopen(line, sizeof line - 1, "w");
    replay_line(out, ESCAPE_TERMINAL, found, reporting->options->names, NULL, 0);
    FUZZ_CHECK(fclose(out) == 0 && strchr(line, '\n') == line + strlen(line) - 1);
    replay_json_found(&reporting->json, found, reporting->options->names,
                      reporting->options->log[0], 0);
    reporting->reported++;
}

static int64_t number_in(const cJSON *json, const char *name)
{
    const cJSON *number = cJSON_GetObjectItemCaseSensitive(json, name);
    FUZZ_CHECK(cJSON_IsNumber(number));
    return (int64_t) number->valuedouble;
}

static void check_json(const char *text, const struct reporting *reporting,
                       const struct tally *tally)
{
    static const char *const outcome[] = {"same",        "different", "busy",     "unknown_body",
                                          "not_defined", "not_held",  "no_result"};
    _Static_assert(sizeof outcome / sizeof *outcome == REPLAY_OUTCOMES, "each has its name");
    cJSON *json = cJSON_Parse(text);
    FUZZ_CHECK(json);
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(json, "differences");
    FUZZ_CHECK(cJSON_GetArraySize(list) == reporting->reported);
    FUZZ_CHECK(number_in(json, "not_listed") == reporting->found - reporting->reported);
    FUZZ_CHECK(number_in(json, "queries") == tally_both(tally).queries);
    for (int i = 0; i < REPLAY_OUTCOMES; i++)
        FUZZ_CHECK(number_in(json, outcome[i]) == tally_both(tally).outcome[i]);
    cJSON_Delete(json);
}

static char *report_all_json(struct reporting *reporting, const struct tally *tally)
{
    char *text;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    FUZZ_CHECK(out);
    reporting->json = replay_json_begin(out);
    listing_each(reporting->list, report_one, reporting);
    replay_json_end(&reporting->json, tally, listing_beyond(reporting->list), 0);
    FUZZ_CHECK(fclose(out) == 0);
    return text;
}

/* For people and for CI systems: whatever it is, it can be written. */
static void report_others(struct reporting *reporting, struct tally *tally)
{
    char *text;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    FUZZ_CHECK(out);
    replay_text_summary(out, tally);
    replay_junit(out, reporting->options, reporting->list, tally, 0);
    if (reporting->options->page)
        page_write(reporting->options->page, out);
    FUZZ_CHECK(!ferror(out) && fclose(out) == 0);
    free(text);
}

/* limit: of the differences that are listed. */
static void check_reporting(struct replay_options options, int64_t limit, bool page)
{
    options.labels = true;
    struct reporting reporting = {.list = listing_open(limit), .options = &options};
    const struct replay_sink sink = {on_found, on_unreadable, on_damage, on_progress, &reporting};
    struct tally tally = {.events = 0};
    const struct page_options shown = {
        .kind = PAGE_REPLAY, .title = "fuzz", .sides = {"then", "now"}};
    options.page = page ? page_open(&shown) : NULL;
    FUZZ_CHECK(replay_run(&options, &sink, &tally));
    char *json = report_all_json(&reporting, &tally);
    FUZZ_CHECK(reporting.reported == (reporting.found < limit ? reporting.found : limit));
    check_json(json, &reporting, &tally);
    report_others(&reporting, &tally);
    free(json);
    tally_clear(&tally);
    page_close(options.page);
    listing_close(reporting.list);
}

/* ---- Replays ---- */

static uint64_t hash_of(const uint8_t *data, size_t size)
{
    uint64_t hash = 1;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ data[i]) * UINT64_C(1099511628211);
    return hash ^ hash >> 29;
}

/* Each event is counted, as what it is. */
static void check_counts(const struct tally *tally, const struct look *look)
{
    int64_t results = 0, events = 0, queries = 0;
    for (int i = 0; i < TALLY_CHANNELS; i++) {
        results += tally->channel[i].results;
        queries += tally->channel[i].queries + tally->channel[i].unreadable[0];
    }
    for (int kind = 0; kind < LOG_KINDS; kind++)
        events += look->events[kind];
    FUZZ_CHECK(tally->events == events);
    FUZZ_CHECK(tally->statuses == look->events[LOG_STATUS]);
    FUZZ_CHECK(tally->other_events == look->events[LOG_OTHER]);
    FUZZ_CHECK(tally->definitions + tally->unreadable_definitions == look->events[LOG_DEFINITION]);
    FUZZ_CHECK(queries == look->events[LOG_PAIR_QUERY] + look->events[LOG_SCENE_QUERY]);
    FUZZ_CHECK(results == look->results);
}

static void check_again(const struct replay_options *options, const struct replay_report *report)
{
    struct replay_report again = replay_report_of(options);
    FUZZ_CHECK(!replay_report_differ(report, &again));
    replay_report_free(&again);
}

static void check_replays(const struct replay_options *options, int64_t size, uint64_t hash,
                          const struct look *look)
{
    struct replay_report report = replay_report_of(options);
    FUZZ_CHECK(report.good);
    if (report.good) {
        FUZZ_CHECK(!replay_report_odd(&report, size));
        check_counts(&report.tally, look);
        if (hash % 4 == 1)
            check_again(options, &report);
        if (hash % 4 >= 2)
            check_reporting(*options, (int64_t) (hash >> 8) % 4, hash % 4 == 3);
    }
    replay_report_free(&report);
}

/* ---- Rows ---- */

/* Prints the results of a log. Returns the text, to be freed; *count: of the results. */
static char *rows_of(const char *path, enum report_form form, enum result_rows_pairs pairs,
                     int64_t *count)
{
    const struct log_channels channels = log_channels("");
    char *text, why[LOG_WHY_MAX];
    size_t size;
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    FILE *out = open_memstream(&text, &size);
    FUZZ_CHECK(out);
    struct result_rows *results = result_rows_open(out, form, pairs);
    struct log_reader *reader = log_open(path, why);
    while ((outcome = log_next(reader, &event, &damage)) != LOG_END)
        if (outcome == LOG_EVENT)
            result_rows_take(results, log_kind_of(&channels, &event), event.number, event.data,
                             (uint32_t) event.kept);
    *count = result_rows_count(results);
    log_close(reader);
    result_rows_close(results);
    FUZZ_CHECK(fclose(out) == 0 && strlen(text) == size);
    return text;
}

/* Each line of CSV has as many columns as the first one. */
static void check_csv(const char *text)
{
    int columns = 0, expected = 0;
    bool quoted = false;
    for (; *text; text++) {
        FUZZ_CHECK(*text == '\n' || (unsigned char) *text >= ' ');
        quoted = quoted != (*text == '"');
        columns += *text == ',' && !quoted;
        if (*text != '\n')
            continue;
        FUZZ_CHECK(!quoted && (expected == 0 || columns == expected));
        expected = columns;
        columns = 0;
    }
}

static void check_rows(const char *path)
{
    int64_t count;
    char *json = rows_of(path, REPORT_JSON, RESULT_ROWS_ALL, &count);
    int64_t lines = 0;
    for (const char *at = json; *at; lines++) {
        cJSON *line = cJSON_ParseWithOpts(at, &at, false);
        FUZZ_CHECK(cJSON_IsObject(line) && *at++ == '\n');
        cJSON_Delete(line);
    }
    FUZZ_CHECK(lines <= count);
    char *csv = rows_of(path, REPORT_CSV, RESULT_ROWS_CONTACTS, &count);
    check_csv(csv);
    free(rows_of(path, REPORT_TABLE, RESULT_ROWS_NAMED, &count));
    free(json);
    free(csv);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[LOG_DRAFT_PATH_MAX];
    char *const paths[] = {path};
    const int file = log_draft_file(data, size, path);
    const struct look look = look_at(path);
    const struct replay_options options = {.log = paths, .log_count = 1, .prefix = "", .frames = 4};
    if (!look.slow) {
        check_replays(&options, (int64_t) size, hash_of(data, size), &look);
        check_rows(path);
    }
    close(file);
    return 0;
}
