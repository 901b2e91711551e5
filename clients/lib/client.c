#include "client.h"

#include "client_scene.h"
#include "clock.h"
#include "fmb_client_raw.h"
#include "process.h"
#include "wire_type.h"

#include <assert.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static_assert((int) FMB_CLIENT_PREFIX_MAX == BUS_PREFIX_MAX &&
                  (int) FMB_CLIENT_WHY_MAX == BUS_WHY_MAX,
              "limits of the public header");

enum {
    TRIES = 6,
    /* Most calls of bus_receive() in a row: some 16,000 datagrams, more than a buffer of 4 MB
     * holds. A flood of datagrams from another client cannot keep this one from sending. */
    BATCHES_MAX = 256,
    HANDLE_MAX_S = 1000000
};

static const double timeout_s = 0.5, timeout_max_s = 1e6, ns_per_s = 1e9;

bool fmb_client_prefix_ok(const char *prefix)
{
    return bus_prefix_ok(prefix);
}

/* ---- Messages ---- */

/* Passes a result for this client to the request engine. Of results for others, only the header is
 * read, unless they are definitions. */
static const char *on_result(struct fmb_client *client, const struct bus_message *message,
                             enum fmb_client_kind kind)
{
    const unsigned char *bytes = message->bytes;
    const uint32_t size = (uint32_t) message->size;
    struct result_head *head = &client->received.head;
    const char *error = kind == FMB_CLIENT_PAIR
                            ? wire_read_pair_result_header(bytes, size, &head->header)
                        : kind == FMB_CLIENT_SCENE
                            ? wire_read_scene_result_header(bytes, size, &head->header)
                            : wire_read_definition(bytes, size, &client->received.definition);
    if (error || head->client_id != client->requests.client_id)
        return error;
    if (kind == FMB_CLIENT_PAIR)
        error = wire_read_pair_result(bytes, size, &client->received.pair);
    else if (kind == FMB_CLIENT_SCENE)
        error = wire_read_scene_result(bytes, size, &client->received.scene);
    const struct request_result result = {.kind = kind,
                                          .status = head->status,
                                          .detail = head->detail,
                                          .pair = &client->received.pair,
                                          .scene = &client->received.scene,
                                          .bytes = bytes,
                                          .size = message->size,
                                          .number = head->sequence_number};
    if (!error)
        requests_take(&client->requests, &result);
    return error;
}

static const char *on_status(struct fmb_client *client, const struct bus_message *message)
{
    struct wire_status status;
    const char *error = wire_read_status(message->bytes, (uint32_t) message->size, &status);
    if (error)
        return error;
    struct fmb_client_counter counters[WIRE_COUNTERS];
    for (int i = 0; i < WIRE_COUNTERS; i++)
        counters[i].name = wire_status_counter(&status, i, &counters[i].value);
    const struct fmb_client_heartbeat out = {.utime = status.utime,
                                             .server_id = status.server_id,
                                             .version = status.version,
                                             .counters = counters,
                                             .counter_count = WIRE_COUNTERS};
    if (client->watcher.heartbeat)
        client->watcher.heartbeat(client->watcher.user, &out);
    return NULL;
}

int64_t fmb_client_get_counter(const struct fmb_client_heartbeat *heartbeat, const char *name)
{
    for (size_t i = 0; i < heartbeat->counter_count; i++)
        if (strcmp(heartbeat->counters[i].name, name) == 0)
            return heartbeat->counters[i].value;
    return 0;
}

/* ---- The bus ---- */

static const char *const channels[CLIENT_CHANNELS] = {
    [FMB_CLIENT_PAIR] = WIRE_PAIR_RESULT,
    [FMB_CLIENT_SCENE] = WIRE_SCENE_RESULT,
    [FMB_CLIENT_DEFINITION] = WIRE_DEFINITION,
    [CLIENT_STATUS] = WIRE_STATUS,
};

static void on_message(void *user, const struct bus_message *message)
{
    struct fmb_client *client = user;
    if (client->tap)
        client->tap(client->tap_user, message);
    if (message->listener >= client->listener_count) /* only the tap receives it */
        return;
    const int channel = client->channel[message->listener];
    const char *error =
        channel == CLIENT_STATUS ? on_status(client, message) : on_result(client, message, channel);
    if (!error)
        return;
    client->requests.counts.malformed++;
    if (client->watcher.malformed)
        client->watcher.malformed(client->watcher.user, error);
}

/* Receives a channel from now on. Returns false if the bus cannot; client->why is the reason. */
static bool client_listen(struct fmb_client *client, int channel)
{
    char name[BUS_CHANNEL_MAX];
    for (int i = 0; i < client->listener_count; i++)
        if (client->channel[i] == channel)
            return true;
    bus_channel(name, client->prefix, channels[channel]);
    if (!bus_listen(client->bus, name, client->why))
        return false;
    client->channel[client->listener_count++] = channel;
    return true;
}

/* A message belongs to the first listener for its channel. Those of the library come first, so that
 * the tap does not take messages from them. */
bool fmb_client_raw_listen(struct fmb_client *client, bool every, bus_handler *tap, void *user)
{
    bool good = true;
    client->tap = tap;
    client->tap_user = user;
    for (int channel = 0; good && channel < CLIENT_CHANNELS; channel++)
        good = client_listen(client, channel);
    for (int kind = 0; good && kind < (every ? 1 : FMB_CLIENT_KINDS); kind++)
        good = bus_listen(client->bus, every ? NULL : client->query_channel[kind], client->why);
    return good;
}

static void wait_for_datagram(void *user, int other_fd, int timeout_ms)
{
    struct fmb_client *client = user;
    if (bus_wait(client->bus, other_fd, timeout_ms) < 0)
        client->failed = true;
}

static int receive_pending(struct fmb_client *client)
{
    int received = 0, count = BUS_BATCH;
    for (int i = 0; i < BATCHES_MAX && count == BUS_BATCH && !client->failed; i++) {
        count = bus_receive(client->bus, on_message, client);
        client->failed = count < 0;
        received += count > 0 ? count : 0;
    }
    return received;
}

static bool receive_results(void *user)
{
    struct fmb_client *client = user;
    receive_pending(client);
    return !client->failed;
}

static bool publish(void *user, enum fmb_client_kind kind, const unsigned char *query, size_t size)
{
    const struct fmb_client *client = user;
    return bus_publish(client->bus, client->query_channel[kind], query, size);
}

int fmb_client_watch(struct fmb_client *client, const struct fmb_client_watcher *watcher)
{
    if (client->inside)
        return FMB_CLIENT_INSIDE;
    client->watcher = *watcher;
    return client_listen(client, CLIENT_STATUS) ? FMB_OK : FMB_CLIENT_NO_BUS;
}

int fmb_client_fileno(const struct fmb_client *client)
{
    return bus_fileno(client->bus);
}

int fmb_client_handle(struct fmb_client *client, double timeout)
{
    if (client->inside)
        return FMB_CLIENT_INSIDE;
    const double most = timeout < HANDLE_MAX_S ? timeout : HANDLE_MAX_S;
    client->inside = true;
    wait_for_datagram(client, -1, timeout < 0 ? -1 : (int) ceil(1000 * most));
    const int received = receive_pending(client);
    client->inside = false;
    return client->failed ? FMB_CLIENT_NO_BUS : received;
}

void fmb_client_get_counts(const struct fmb_client *client, struct fmb_client_counts *out)
{
    *out = client->requests.counts;
}

/* ---- Queries ---- */

const char *fmb_client_why(const struct fmb_client *client)
{
    return client->why;
}

/* Sets the reason of a status of the whole scene. Returns the status. */
static int fail(struct fmb_client *client, int status)
{
    snprintf(client->why, sizeof client->why, "%s", fmb_client_status_text(status));
    return status;
}

/* single: each pair is a separate query. */
static int query(struct fmb_client *client, const struct fmb_scene *scene, bool single,
                 fmb_client_sink *sink, void *user)
{
    if (client->inside)
        return FMB_CLIENT_INSIDE;
    int status = client_scene_check(scene, client->why);
    if (status != FMB_OK)
        return status;
    if (client->failed || !client_listen(client, single ? FMB_CLIENT_PAIR : FMB_CLIENT_SCENE))
        return fail(client, FMB_CLIENT_NO_BUS);
    client->inside = true;
    status = scene_run(&client->run, scene, single, sink, user);
    client->inside = false;
    return status == FMB_OK ? status : fail(client, status);
}

int fmb_client_query(struct fmb_client *client, const struct fmb_scene *scene,
                     fmb_client_sink *sink, void *user)
{
    return query(client, scene, scene->want & FMB_WANT_CERTIFICATE, sink, user);
}

/* The sink of fmb_client_query_pair(): copies the answer and its texts into the client. */
static void keep_answer(void *user, const struct fmb_client_answer *answer)
{
    struct fmb_client *client = user;
    client->answer = *answer;
    snprintf(client->text, sizeof client->text, "%s", answer->text);
    client->answer.text = client->text;
    if (answer->certificate)
        client->answer.certificate = strcpy(client->certificate, answer->certificate);
}

int fmb_client_query_pair(struct fmb_client *client, const struct fmb_placement pair[2],
                          double duration, unsigned want, struct fmb_client_answer *out)
{
    struct fmb_placement placement[2] = {pair[0], pair[1]};
    placement[0].group = placement[1].group = 0;
    const bool ends = pair[0].end_count || pair[1].end_count;
    const struct fmb_scene scene = {.placements = placement,
                                    .placement_count = 2,
                                    .duration = duration,
                                    .instant = duration == 0 && !ends,
                                    .want = want};
    *out = (struct fmb_client_answer){.b = 1, .text = ""};
    out->status = query(client, &scene, true, keep_answer, client);
    if (out->status == FMB_OK)
        *out = client->answer;
    else
        out->text =
            out->status == FMB_CLIENT_INSIDE ? fmb_client_status_text(out->status) : client->why;
    return out->status;
}

/* ---- Raw requests ---- */

int64_t fmb_client_raw_id(const struct fmb_client *client)
{
    return client->requests.client_id;
}

struct bus_counts fmb_client_raw_bus_counts(const struct fmb_client *client)
{
    return bus_counts(client->bus);
}

bool fmb_client_raw_ready(const struct fmb_client *client, size_t bytes)
{
    return requests_ready(&client->requests, bytes);
}

/* The handler of raw requests. */
static enum request_taken deliver_raw(void *user, struct request *request,
                                      const struct request_result *result)
{
    const struct fmb_client_raw_result out = {result->status, result->bytes, result->size,
                                              request->query, request->size};
    request->raw_sink(user, &out);
    return REQUEST_COMPLETE;
}

int fmb_client_raw_send(struct fmb_client *client, enum fmb_client_kind kind,
                        const unsigned char *message, size_t size, size_t bytes,
                        fmb_client_raw_sink *sink, void *user)
{
    if (client->inside)
        return FMB_CLIENT_INSIDE;
    if (size > QUERY_BYTES_MAX)
        return FMB_OVER_LIMIT;
    if (size < REQUEST_IDS_END)
        return FMB_WRONG_COUNT;
    if (client->failed || !client_listen(client, (int) kind))
        return FMB_CLIENT_NO_BUS;
    client->inside = true;
    struct request *request = request_begin(&client->requests, kind, bytes, deliver_raw, user);
    request->raw_sink = sink;
    request->size = size;
    memcpy(request->query, message, size);
    request_send(&client->requests, request);
    client->inside = false;
    return FMB_OK;
}

int fmb_client_raw_step(struct fmb_client *client, int other_fd, double timeout)
{
    if (client->inside)
        return FMB_CLIENT_INSIDE;
    client->inside = true;
    requests_step(&client->requests, other_fd, clock_ns() + (int64_t) (1e9 * timeout));
    client->inside = false;
    return client->failed ? FMB_CLIENT_NO_BUS : client->requests.count;
}

/* ---- Opening and closing ---- */

/* The generated code computes the fingerprint of a type at its first use, and stores it: two
 * threads must not do that at the same time. No type has the fingerprint 0, so this computes all of
 * them. */
static void compute_fingerprints(void)
{
    wire_type_name(0);
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
    if (!(timeout > 0 && timeout <= timeout_max_s)) {
        snprintf(why, BUS_WHY_MAX, "timeout: expected more than 0 and at most %g seconds, found %g",
                 timeout_max_s, timeout);
        return false;
    }
    if (options->tries < 0) {
        snprintf(why, BUS_WHY_MAX, "tries: %d is negative", options->tries);
        return false;
    }
    if (!(options->within >= 0)) {
        snprintf(why, BUS_WHY_MAX, "within: expected 0 or more seconds, found %g", options->within);
        return false;
    }
    snprintf(client->prefix, sizeof client->prefix, "%s", prefix);
    bus_channel(client->query_channel[FMB_CLIENT_PAIR], prefix, WIRE_PAIR_QUERY);
    bus_channel(client->query_channel[FMB_CLIENT_SCENE], prefix, WIRE_SCENE_QUERY);
    bus_channel(client->query_channel[FMB_CLIENT_DEFINITION], prefix, WIRE_DEFINITION_QUERY);
    client->requests.timeout_ns = (int64_t) (timeout * ns_per_s);
    client->requests.tries = options->tries ? options->tries : TRIES;
    client->run.within = options->within;
    return true;
}

static bool open_parts(struct fmb_client *client, const char *url, char why[BUS_WHY_MAX])
{
    client->bus = bus_open(url, why);
    client->requests.transport =
        (struct request_transport){client, publish, wait_for_datagram, receive_results};
    client->requests.client_id = random_id();
    client->run.requests = &client->requests;
    client->run.held = &client->held;
    requests_forget_pace(&client->requests);
    return client->bus != NULL;
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
    if (client && set_options(client, options, text) && open_parts(client, options->url, text))
        return client;
    if (size > 0)
        snprintf(why, size, "%s", text);
    fmb_client_close(client);
    return NULL;
}

void fmb_client_close(struct fmb_client *client)
{
    if (!client)
        return;
    bus_close(client->bus);
    held_clear(&client->held);
    free(client);
}
