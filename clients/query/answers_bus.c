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
    struct fmb_client *client; /* NULL: could not be opened */
    double patience;           /* seconds until a query is given up */
    uint64_t advised;          /* outages that have been reported */
    int64_t heartbeat_by;      /* end of the wait for a heartbeat; clock_ns() */
    bool heartbeat;            /* a service has sent one */
};

static void on_heartbeat(void *user, const struct fmb_client_heartbeat *heartbeat)
{
    struct answers_bus *answers = user;
    (void) heartbeat;
    answers->heartbeat = true;
}

struct answers_bus *answers_bus_open(const struct args_bus *bus, double timeout, int retries)
{
    struct answers_bus *answers = allocate(1, sizeof *answers);
    answers->bus = *bus;
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

void answers_bus_close(struct answers_bus *answers)
{
    fmb_client_close(answers->client);
    free(answers);
}

/* ---- The answers ---- */

/* A scene, and the state of its answers. */
struct bus_scene {
    struct owned_scene *scene;
    struct pair_cursor delivered; /* pairs so far */
    fmb_client_sink *sink;
    void *user;
    int newest; /* status of the newest answer */
};

/* Delivers the pairs before the one of `until`, or all that are left: with this status; FMB_OK:
 * they are separated. */
static void deliver(struct bus_scene *run, int status, const char *text,
                    const struct fmb_client_answer *until)
{
    const unsigned last[2] = {until ? until->a : 0, until ? until->b : 0};
    unsigned pair[2];
    while (scene_next_pair_before(run->scene, &run->delivered, until ? last : NULL, pair)) {
        struct fmb_client_answer answer = {
            .a = pair[0], .b = pair[1], .status = status, .text = text};
        if (status == FMB_OK)
            answer.answer.verdict = FMB_SEPARATED;
        run->sink(run->user, &answer);
    }
}

static void take_answer(void *user, const struct fmb_client_answer *answer)
{
    struct bus_scene *run = user;
    deliver(run, FMB_OK, "", answer);
    run->newest = answer->status;
    run->sink(run->user, answer);
}

static struct fmb_client_counts counts_of(const struct answers_bus *answers)
{
    struct fmb_client_counts counts;
    fmb_client_get_counts(answers->client, &counts);
    return counts;
}

/* Whether a service has answered or sent a heartbeat since the bus was opened. Waits for one. */
static bool service_seen(struct answers_bus *answers)
{
    int64_t left_ns;
    while (!answers->heartbeat && counts_of(answers).answered == 0 &&
           (left_ns = answers->heartbeat_by - clock_ns()) > 0)
        if (fmb_client_handle(answers->client, 1e-9 * (double) left_ns) < 0)
            return false;
    return answers->heartbeat || counts_of(answers).answered > 0;
}

/* Reports each outage once. kind: of the queries. Returns false if no service has ever been seen.
 */
static bool advise(struct answers_bus *answers, const char *kind)
{
    const char *prefix = answers->bus.prefix;
    const struct fmb_client_counts counts = counts_of(answers);
    if (answers->advised == counts.outages)
        return true;
    answers->advised = counts.outages;
    const bool seen = service_seen(answers);
    complain("no fmbd answered on channel %sFMB_%s_RESULT of %s within %g s%s", prefix, kind,
             args_bus_name(&answers->bus), answers->patience,
             seen ? "" : ", and none sends a heartbeat: later scenes are not answered");
    if (counts.malformed > 0)
        complain("%" PRIu64 " results could not be read: another version of fmbd?",
                 counts.malformed);
    args_advise_service(&answers->bus, ", or decide without it: fmb query --local");
    return seen;
}

/* Returns the list of all pairs of a scene. The caller frees it. */
static unsigned (*list_pairs(struct owned_scene *scene, size_t *count))[2]
{
    struct pair_cursor cursor = {0};
    *count = (size_t) scene_count_pairs(scene);
    unsigned(*pair)[2] = allocate(*count, sizeof *pair);
    for (size_t i = 0; i < *count && scene_next_pair(scene, &cursor, pair[i]); i++)
        continue;
    return pair;
}

/* Queries the listed pairs. The service refuses a certificate of a pair that has none: a run of
 * such pairs is queried without. Once the service has stopped answering, no further run is queried.
 */
static int query_listed(struct answers_bus *answers, struct fmb_scene *queried,
                        struct bus_scene *run)
{
    const unsigned(*pair)[2] = queried->pairs;
    const size_t count = queried->pair_count;
    const unsigned want = queried->want;
    int status = FMB_OK;
    for (size_t i = 0, end; i < count && status == FMB_OK; i = end) {
        const bool certified = pair_is_certified(queried, pair[i]);
        end = want & FMB_WANT_CERTIFICATE ? i + 1 : count;
        while (end < count && pair_is_certified(queried, pair[end]) == certified)
            end++;
        queried->pairs = pair + i;
        queried->pair_count = end - i;
        queried->want = certified ? want : want & ~(unsigned) FMB_WANT_CERTIFICATE;
        status = fmb_client_query(answers->client, queried, take_answer, run);
        if (run->newest == FMB_CLIENT_NO_SERVICE) {
            deliver(run, run->newest, fmb_client_status_text(run->newest), NULL);
            break;
        }
    }
    return status;
}

/* Of all pairs the library answers only contacts and near ones. So pairs are listed if each gets a
 * gap or a certificate, and for a method that takes listed pairs only. */
bool answers_bus_scene(struct answers_bus *answers, struct owned_scene *owner,
                       fmb_client_sink *sink, void *user)
{
    const struct fmb_scene *scene = &owner->scene;
    struct bus_scene run = {.scene = owner, .sink = sink, .user = user};
    struct fmb_scene queried = *scene;
    unsigned(*pair)[2] = NULL;
    if (!answers->client) {
        deliver(&run, FMB_CLIENT_NO_BUS, "no bus", NULL);
        return false;
    }
    if (scene->which == FMB_PAIRS_ALL && (scene->want & (FMB_WANT_GAP | FMB_WANT_CERTIFICATE) ||
                                          (scene->method && !scene->method->certain))) {
        pair = list_pairs(owner, &queried.pair_count);
        queried.which = FMB_PAIRS_LISTED;
        queried.pairs = (const unsigned(*)[2]) pair;
        queried.ignored_count = 0;
    }
    const int status = queried.which == FMB_PAIRS_LISTED
                           ? query_listed(answers, &queried, &run)
                           : fmb_client_query(answers->client, &queried, take_answer, &run);
    deliver(&run, status, fmb_client_why(answers->client), NULL);
    free(pair);
    return advise(answers, scene->want & FMB_WANT_CERTIFICATE ? "PAIR" : "SCENE");
}
