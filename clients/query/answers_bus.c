#include "answers.h"

#include "allocate.h"
#include "clock.h"
#include "complain.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Longest time to wait for the first heartbeat. A service sends one each second. */
static const double heartbeat_max_s = 1.5;

struct answers_bus {
    struct args_bus bus;
    struct answers_options options;
    struct fmb_client *client; /* NULL: could not be opened */
    double patience;           /* seconds until a query is given up */
    uint64_t advised;          /* outages that have been reported */
    int64_t heartbeat_by;      /* end of the wait for a heartbeat; clock_ns() */
    bool heartbeat;            /* a service has sent one */
};

/* A scene, and the state of its answers. */
struct bus_scene {
    const struct scene *scene;
    struct scene_cursor delivered; /* pairs so far */
    answers_sink *sink;
    void *user;
};

static void on_heartbeat(void *user, const struct fmb_client_heartbeat *heartbeat)
{
    struct answers_bus *answers = user;
    (void) heartbeat;
    answers->heartbeat = true;
}

struct answers_bus *answers_bus_open(const struct args_bus *bus,
                                     const struct answers_options *options, double timeout,
                                     int retries)
{
    struct answers_bus *answers = allocate(1, sizeof *answers);
    answers->bus = *bus;
    answers->options = *options;
    answers->patience = timeout * (retries + 1);
    answers->client = args_open_client(
        bus, (struct fmb_client_options){.timeout = timeout, .tries = retries + 1});
    answers->heartbeat_by = clock_ns() + (int64_t) (1e9 * heartbeat_max_s);
    const struct fmb_client_watcher watcher = {.heartbeat = on_heartbeat, .user = answers};
    if (answers->client)
        fmb_client_watch(answers->client, &watcher);
    else
        complain("to decide without a bus: fmb query --local");
    return answers;
}

/* Reports contradicting results. The answers are those of the first results. */
static void report_contradictions(const struct fmb_client *client)
{
    const uint64_t count = client ? fmb_client_get_counts(client).contradicting : 0;
    if (count > 0)
        complain("%" PRIu64
                 " queries got a second result that contradicts the first: another "
                 "program on the bus is wrong, or forges results",
                 count);
}

void answers_bus_close(struct answers_bus *answers)
{
    report_contradictions(answers->client);
    fmb_client_close(answers->client);
    free(answers);
}

/* ---- The query ---- */

/* Returns the placements of a scene, which the caller frees. They point into it. */
static struct fmb_placement *placements_of(const struct scene *scene)
{
    struct fmb_placement *out = allocate(scene->body_count, sizeof *out);
    for (size_t i = 0; i < scene->body_count; i++) {
        const struct scene_body *body = &scene->body[i];
        out[i] = scene_placement(body);
        out[i].id = body->id;
        out[i].name = body->name;
        out[i].group = body->group;
    }
    return out;
}

/* Copies pairs of a scene for the library: those to be queried if they are listed, else those to be
 * ignored. The caller frees them. */
static unsigned (*copy_pairs(const struct scene *scene, bool listed, size_t *count))[2]
{
    *count = listed ? (size_t) scene_count_pairs(scene) : scene->ignored_count;
    unsigned(*pair)[2] = allocate(*count, sizeof *pair);
    struct scene_cursor cursor = {0};
    struct scene_pair next;
    for (size_t i = 0; i < *count; i++) {
        if (!listed)
            next = scene->ignored[i];
        else if (!scene_next_pair(scene, &cursor, &next))
            break;
        pair[i][0] = (unsigned) next.a;
        pair[i][1] = (unsigned) next.b;
    }
    return pair;
}

static unsigned want_of(const struct answers_options *options)
{
    return FMB_WANT_TIMES | (options->box ? FMB_WANT_BOX : 0) |
           (options->certificate ? FMB_WANT_CERTIFICATE : 0) | (options->gap ? FMB_WANT_GAP : 0);
}

/* ---- The answers ---- */

/* Of all pairs, those that the library leaves out are separated. */
static void deliver_separated(const struct bus_scene *run, struct scene_pair pair)
{
    const struct outcome outcome = {.pair = pair, .answer.verdict = FMB_SEPARATED};
    run->sink(run->user, run->scene, &outcome);
}

static void take_answer(void *user, const struct fmb_client_answer *answer)
{
    struct bus_scene *run = user;
    struct outcome outcome = {.error = answer->status == FMB_OK ? NULL : answer->text};
    while (scene_next_pair(run->scene, &run->delivered, &outcome.pair) &&
           (outcome.pair.a != answer->a || outcome.pair.b != answer->b))
        deliver_separated(run, outcome.pair);
    if (!outcome.error) {
        outcome.answer = answer->answer;
        outcome.certificate = answer->certificate;
    }
    run->sink(run->user, run->scene, &outcome);
}

/* Delivers the remaining pairs. error: why no query was sent; NULL: one was. */
static void deliver_remaining(struct bus_scene *run, const char *error)
{
    struct outcome outcome = {.error = error};
    while (scene_next_pair(run->scene, &run->delivered, &outcome.pair))
        if (error)
            run->sink(run->user, run->scene, &outcome);
        else
            deliver_separated(run, outcome.pair);
}

/* Whether a service has answered or sent a heartbeat since the bus was opened. Waits for one. */
static bool service_seen(struct answers_bus *answers)
{
    int64_t left_ns;
    while (!answers->heartbeat && fmb_client_get_counts(answers->client).answered == 0 &&
           (left_ns = answers->heartbeat_by - clock_ns()) > 0)
        if (fmb_client_handle(answers->client, 1e-9 * (double) left_ns) < 0)
            return false;
    return answers->heartbeat || fmb_client_get_counts(answers->client).answered > 0;
}

/* Reports each outage once. Returns false if no service has ever been seen. */
static bool advise(struct answers_bus *answers)
{
    const char *prefix = answers->bus.prefix;
    const struct fmb_client_counts counts = fmb_client_get_counts(answers->client);
    if (answers->advised == counts.outages)
        return true;
    answers->advised = counts.outages;
    const bool seen = service_seen(answers);
    complain("no fmbd answered on channel %sFMB_%s_RESULT of %s within %g s%s", prefix,
             answers->options.certificate ? "PAIR" : "SCENE", args_bus_name(&answers->bus),
             answers->patience,
             seen ? "" : ", and none sends a heartbeat: later scenes are not answered");
    if (counts.malformed > 0)
        complain("%" PRIu64 " results could not be read: another version of fmbd?",
                 counts.malformed);
    complain("start one with 'fmbd%s%s &', or decide without it: fmb query --local",
             *prefix ? " --prefix " : "", prefix);
    return seen;
}

/* Of all pairs the library answers only contacts and near ones. So pairs are listed if each gets a
 * gap. */
static bool query(struct answers_bus *answers, struct bus_scene *run)
{
    const struct answers_options *options = &answers->options;
    const struct scene *scene = run->scene;
    struct fmb_placement *placements = placements_of(scene);
    const bool listed =
        !scene->all_pairs || options->gap || (options->method && !options->method->certain);
    size_t count;
    unsigned(*pair)[2] = copy_pairs(scene, listed, &count);
    const struct fmb_scene queried = {
        .placements = placements,
        .placement_count = scene->body_count,
        .which = listed ? FMB_PAIRS_LISTED : FMB_PAIRS_ALL,
        .pairs = (const unsigned(*)[2]) pair,
        .pair_count = listed ? count : 0,
        .ignored = (const unsigned(*)[2]) pair,
        .ignored_count = listed ? 0 : count,
        .duration = scene->duration,
        .instant = scene->duration == 0,
        .margin = scene->margin,
        .want = want_of(options),
        .method = options->method,
        .label = scene->label,
    };
    const int status = fmb_client_query(answers->client, &queried, take_answer, run);
    deliver_remaining(run, status == FMB_OK ? NULL : fmb_client_why(answers->client));
    free(placements);
    free(pair);
    return advise(answers);
}

bool answers_bus_scene(struct answers_bus *answers, const struct scene *scene, answers_sink *sink,
                       void *user)
{
    struct bus_scene run = {.scene = scene, .sink = sink, .user = user};
    if (answers->client)
        return query(answers, &run);
    deliver_remaining(&run, "no bus");
    return false;
}
