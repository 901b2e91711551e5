#include "client.h"

#include "clock.h"
#include "random_id.h"
#include "wire.h"

#include "fmb_msgs_pair_query_t.h"
#include "fmb_msgs_pair_result_t.h"
#include "fmb_msgs_scene_query_t.h"
#include "fmb_msgs_scene_result_t.h"
#include "fmb_msgs_status_t.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <poll.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static_assert((int) FMB_CLIENT_PREFIX_MAX == BUS_PREFIX_MAX &&
                  (int) FMB_CLIENT_WHY_MAX == BUS_WHY_MAX,
              "what the header promises");
static_assert((int) FMB_CLIENT_LISTED == QUERY_PAIRS_LISTED &&
                  (int) FMB_CLIENT_ALL == QUERY_PAIRS_ALL &&
                  (int) FMB_CLIENT_ACROSS == QUERY_PAIRS_ACROSS,
              "which pairs");
static_assert((int) FMB_CLIENT_WANT_BOX == QUERY_WANT_BOX &&
                  (int) FMB_CLIENT_WANT_CERTIFICATE == QUERY_WANT_CERTIFICATE &&
                  (int) FMB_CLIENT_WANT_TIMES == QUERY_WANT_TIMES,
              "wants");

enum {
    TRIES = 6,
    /* Messages taken before queries are looked after again: another client's flood must not keep
     * this one from sending. */
    TAKEN_MAX = 2 * ASKING_WINDOW,
    HANDLE_MAX_S = 1000000
};

static const double timeout_s = 0.5, timeout_max_s = 1e6, ns_per_s = 1e9;

const char *fmb_client_status_text(int status)
{
    switch (status) {
#define X(name, number, text) \
    case number: return text;
        FMB_CLIENT_STATUS_MAP(X)
#undef X
    }
    return fmb_status_text(status);
}

bool fmb_client_prefix_ok(const char *prefix)
{
    return bus_prefix_ok(prefix);
}

/* ---- What comes in --------------------------------------------------------------------------- */

static void note_malformed(struct fmb_client *client, const char *what)
{
    client->counts.malformed++;
    if (client->watcher.malformed)
        client->watcher.malformed(client->watcher.user, what);
}

static const char *text_of(int32_t status, const char *detail)
{
    if (status == FMB_OK)
        return "";
    return detail[0] ? detail : fmb_client_status_text(status);
}

static void show_pair(const struct fmb_client *client, const struct pair_result *result)
{
    const struct fmb_client_pair_result out = {
        .utime = result->utime,
        .client_id = result->client_id,
        .sequence_number = result->sequence_number,
        .server_id = result->server_id,
        .body_id = {result->body_id[0], result->body_id[1]},
        .status = result->status,
        .text = text_of(result->status, result->detail),
        .dim = result->dim,
        .answer = result->answer,
        .certificate = result->certificate,
        .compute_ns = result->compute_ns,
    };
    client->watcher.pair(client->watcher.user, &out);
}

static void show_scene(const struct fmb_client *client, const struct scene_result *result)
{
    int64_t count[FMB_OVERLAPPING + 1] = {0};
    for (int32_t i = 0; i < result->verdict_count; i++)
        count[result->verdict[i]]++;
    const struct fmb_client_scene_result out = {
        .utime = result->utime,
        .client_id = result->client_id,
        .sequence_number = result->sequence_number,
        .server_id = result->server_id,
        .status = result->status,
        .text = text_of(result->status, result->detail),
        .names_pairs = result->names_pairs || result->verdict_count == 0,
        .end_pair = result->end_pair,
        .overlapping = count[FMB_OVERLAPPING],
        .touching = count[FMB_TOUCHING],
        .separated = count[FMB_SEPARATED],
        .undecided = count[0],
        .lost = result->lost,
        .compute_ns = result->compute_ns,
    };
    client->watcher.scene(client->watcher.user, &out);
}

static void on_pair(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct fmb_client *client = user;
    struct pair_result result;
    (void) channel;
    const char *error = wire_read_pair_result(buffer->data, buffer->data_size, &result);
    if (error) {
        note_malformed(client, error);
        return;
    }
    if (client->watcher.pair)
        show_pair(client, &result);
    asking_take_pair(client, &result);
}

static void on_scene(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct fmb_client *client = user;
    (void) channel;
    const char *error = wire_read_scene_result(buffer->data, buffer->data_size, &client->result);
    if (error) {
        note_malformed(client, error);
        return;
    }
    if (client->watcher.scene)
        show_scene(client, &client->result);
    asking_take_scene(client, &client->result);
}

static void on_status(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct fmb_client *client = user;
    struct wire_status status;
    (void) channel;
    const char *error = wire_read_status(buffer->data, buffer->data_size, &status);
    if (error) {
        note_malformed(client, error);
        return;
    }
    struct fmb_client_heartbeat out = {
        .utime = status.utime, .server_id = status.server_id, .version = status.version};
#define X(name) out.name = status.name;
    FMB_CLIENT_COUNTERS(X)
#undef X
    memcpy(out.results, status.results, sizeof out.results);
    if (client->watcher.heartbeat)
        client->watcher.heartbeat(client->watcher.user, &out);
}

/* ---- The bus --------------------------------------------------------------------------------- */

/* Of results, those of other clients come in too: room for bursts of them. Beyond it LCM drops. */
static const struct {
    const char *name;
    lcm_msg_handler_t handler;
    int queue;
} intakes[CLIENT_INTAKES] = {
    [CLIENT_PAIRS] = {WIRE_PAIR_RESULT, on_pair, 10000},
    [CLIENT_SCENES] = {WIRE_SCENE_RESULT, on_scene, 1000},
    [CLIENT_STATUSES] = {WIRE_STATUS, on_status, 100},
};

bool client_subscribe(struct fmb_client *client, enum client_intake intake)
{
    char channel[BUS_CHANNEL_MAX];
    if (client->intake[intake])
        return true;
    bus_channel(channel, client->prefix, intakes[intake].name);
    client->intake[intake] =
        bus_subscribe(client->lcm, channel, intakes[intake].handler, client, intakes[intake].queue);
    return client->intake[intake] != NULL;
}

int client_listen(struct fmb_client *client, int wait_ms, const bool *enough)
{
    struct pollfd bus = {.fd = lcm_get_fileno(client->lcm), .events = POLLIN};
    int taken = 0;
    while (taken < TAKEN_MAX && !client->failed && !(taken > 0 && enough && *enough)) {
        const int ready = poll(&bus, 1, taken == 0 ? wait_ms : 0);
        if (ready == 0 || (ready < 0 && errno == EINTR))
            break;
        client->failed = ready < 0 || lcm_handle(client->lcm) != 0;
        taken++;
    }
    return taken;
}

int fmb_client_watch(struct fmb_client *client, const struct fmb_client_watcher *watcher)
{
    if (client->inside)
        return FMB_CLIENT_INSIDE;
    client->watcher = *watcher;
    const bool good = (!watcher->pair || client_subscribe(client, CLIENT_PAIRS)) &&
                      (!watcher->scene || client_subscribe(client, CLIENT_SCENES)) &&
                      (!watcher->heartbeat || client_subscribe(client, CLIENT_STATUSES));
    return good ? FMB_OK : FMB_CLIENT_NO_BUS;
}

int fmb_client_fileno(const struct fmb_client *client)
{
    return lcm_get_fileno(client->lcm);
}

int fmb_client_handle(struct fmb_client *client, double timeout)
{
    if (client->inside)
        return FMB_CLIENT_INSIDE;
    const double most = timeout < HANDLE_MAX_S ? timeout : HANDLE_MAX_S;
    client->inside = true;
    const int taken = client_listen(client, timeout < 0 ? -1 : (int) ceil(1000 * most), NULL);
    client->inside = false;
    return client->failed ? FMB_CLIENT_NO_BUS : taken;
}

struct fmb_client_counts fmb_client_counts(const struct fmb_client *client)
{
    return client->counts;
}

/* ---- Life ------------------------------------------------------------------------------------ */

/* The generated code computes them when they are first asked for, and keeps them: so before there
 * are threads that could do that at once. */
static void compute_fingerprints(void)
{
    __fmb_msgs_pair_query_t_get_hash();
    __fmb_msgs_pair_result_t_get_hash();
    __fmb_msgs_scene_query_t_get_hash();
    __fmb_msgs_scene_result_t_get_hash();
    __fmb_msgs_status_t_get_hash();
}

static bool set_options(struct fmb_client *client, const struct fmb_client_options *options,
                        char why[BUS_WHY_MAX])
{
    const char *prefix = options->prefix ? options->prefix : "";
    const double timeout = options->timeout == 0 ? timeout_s : options->timeout;
    if (!bus_prefix_ok(prefix)) {
        snprintf(why, BUS_WHY_MAX, "prefix: expected at most %d letters, digits, '_' or '-'",
                 BUS_PREFIX_MAX);
        return false;
    }
    if (!(timeout > 0 && timeout <= timeout_max_s) || options->tries < 0) {
        snprintf(why, BUS_WHY_MAX, "timeout: expected seconds up to %g, and tries from 0",
                 timeout_max_s);
        return false;
    }
    snprintf(client->prefix, sizeof client->prefix, "%s", prefix);
    bus_channel(client->query_channel[CLIENT_PAIRS], prefix, WIRE_PAIR_QUERY);
    bus_channel(client->query_channel[CLIENT_SCENES], prefix, WIRE_SCENE_QUERY);
    client->timeout_ns = (int64_t) (timeout * ns_per_s);
    client->tries = options->tries ? options->tries : TRIES;
    return true;
}

static bool open_bus(struct fmb_client *client, const struct fmb_client_options *options,
                     char why[BUS_WHY_MAX])
{
    client->owned = !options->lcm;
    client->lcm = options->lcm ? options->lcm : bus_open_or_why(options->url, NULL, why);
    if (client->lcm && lcm_get_fileno(client->lcm) < 0)
        snprintf(why, BUS_WHY_MAX, "nothing comes through the LCM bus");
    return client->lcm && lcm_get_fileno(client->lcm) >= 0;
}

struct fmb_client *fmb_client_open(const struct fmb_client_options *options, char *why, size_t size)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    const struct fmb_client_options none = {0};
    char text[BUS_WHY_MAX] = "out of memory";
    struct fmb_client *client = calloc(1, sizeof *client);
    pthread_once(&once, compute_fingerprints);
    if (!options)
        options = &none;
    if (client && set_options(client, options, text) && open_bus(client, options, text)) {
        client->client_id = random_id();
        return client;
    }
    if (size > 0)
        snprintf(why, size, "%s", text);
    fmb_client_close(client);
    return NULL;
}

void fmb_client_close(struct fmb_client *client)
{
    if (!client)
        return;
    for (int intake = 0; intake < CLIENT_INTAKES; intake++)
        if (client->intake[intake])
            lcm_unsubscribe(client->lcm, client->intake[intake]);
    if (client->lcm && client->owned)
        lcm_destroy(client->lcm);
    free(client);
}
