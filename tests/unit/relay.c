#define _GNU_SOURCE /* pipe2() */
#include "relay.h"

#include "clock.h"
#include "wire.h"

#include <fcntl.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

static bool every(int times, int count)
{
    return times > 0 && count % times == 0;
}

static void publish(struct relay *relay, enum relay_kind kind, const void *bytes, size_t size)
{
    static const char *const channel[] = {WIRE_PAIR_RESULT, WIRE_SCENE_RESULT, WIRE_DEFINITION};
    if (!bus_publish(relay->bus, channel[kind], bytes, size))
        abort();
}

void relay_publish(struct relay *relay, const char *channel, const void *bytes, size_t size)
{
    pthread_mutex_lock(&relay->lock);
    if (!bus_publish(relay->bus, channel, bytes, size))
        abort();
    pthread_mutex_unlock(&relay->lock);
}

uint64_t relay_dropped(struct relay *relay)
{
    pthread_mutex_lock(&relay->lock);
    const uint64_t dropped = bus_counts(relay->bus).dropped;
    pthread_mutex_unlock(&relay->lock);
    return dropped;
}

/* ---- Results ---- */

static void change(struct relay *relay, enum relay_kind kind, relay_lie *lie, relay_pair_lie *pair,
                   const unsigned char *bytes, size_t size)
{
    unsigned char changed[QUERY_BYTES_MAX];
    if (kind == RELAY_SCENE && lie) {
        const char *error = wire_read_scene_result(bytes, (uint32_t) size, &relay->result);
        lie(&relay->result, ++relay->turn);
        publish(relay, kind, changed, error ? 0 : wire_write_scene_result(&relay->result, changed));
    } else if (kind == RELAY_PAIR && pair) {
        struct pair_result result;
        const char *error = wire_read_pair_result(bytes, (uint32_t) size, &result);
        pair(&result, ++relay->turn);
        publish(relay, kind, changed, error ? 0 : wire_write_pair_result(&result, changed));
    } else {
        publish(relay, kind, bytes, size);
    }
}

static void deliver(struct relay *relay, enum relay_kind kind, const unsigned char *bytes,
                    size_t size)
{
    relay->results++;
    if (every(relay->lose_result, relay->results))
        return;
    if (relay->late_size == 0 && every(relay->delay_result, relay->results)) {
        memcpy(relay->late, bytes, size);
        relay->late_size = size;
        relay->late_kind = kind;
        return;
    }
    change(relay, kind, relay->lie, relay->pair_lie, bytes, size);
    if (every(relay->double_result, relay->results))
        change(relay, kind, relay->second_lie, relay->second_pair_lie, bytes, size);
    if (relay->late_size > 0)
        publish(relay, relay->late_kind, relay->late, relay->late_size);
    relay->late_size = 0;
}

/* ---- Queries ---- */

static size_t refuse_busy(struct relay *relay, const struct bus_message *message,
                          unsigned char out[QUERY_BYTES_MAX])
{
    struct query_header header;
    if (message->listener != RELAY_SCENE ||
        wire_read_scene_header(message->bytes, (uint32_t) message->size, &header))
        return 0;
    answer_scene_refused(relay->service[0], &header, FMB_BUSY, &relay->result);
    return wire_write_scene_result(&relay->result, out);
}

static size_t answer(struct relay *relay, struct answerer *service,
                     const struct bus_message *message, unsigned char out[QUERY_BYTES_MAX])
{
    struct pair_query query;
    struct pair_result result;
    const uint32_t size = (uint32_t) message->size;
    switch (message->listener) {
    case RELAY_PAIR:
        if (wire_read_pair_query(message->bytes, size, &query))
            return 0;
        answer_pair(service, &query, &result);
        return wire_write_pair_result(&result, out);
    case RELAY_SCENE:
        if (scene_job_begin(relay->job, message->bytes, size))
            return 0;
        while (!scene_job_step(relay->job, service))
            continue;
        return wire_write_scene_result(scene_job_result(relay->job), out);
    default:
        if (wire_read_definition_query(message->bytes, size, &relay->definition_query))
            return 0;
        answer_definition(service, &relay->definition_query, &relay->definition);
        return wire_write_definition(&relay->definition, out);
    }
}

static void note_query(struct relay *relay, const struct bus_message *message)
{
    struct relay_arrival *arrival = &relay->arrival[relay->queries % RELAY_ARRIVALS];
    struct query_header header = {0};
    wire_read_pair_header(message->bytes, (uint32_t) message->size, &header);
    *arrival = (struct relay_arrival){clock_ns(), header.sequence_number};
    relay->queries++;
    relay->bytes += message->size;
}

static void on_query(void *user, const struct bus_message *message)
{
    struct relay *relay = user;
    unsigned char bytes[QUERY_BYTES_MAX];
    note_query(relay, message);
    if (message->size > QUERY_BYTES_MAX)
        abort();
    if (relay->before)
        relay->before(relay);
    if (relay->deaf || every(relay->lose_query, relay->queries))
        return;
    if (every(relay->busy, relay->queries)) {
        deliver(relay, RELAY_SCENE, bytes, refuse_busy(relay, message, bytes));
        return;
    }
    for (int i = 0; i < RELAY_SERVICES; i++)
        if (relay->service[i])
            deliver(relay, (enum relay_kind) message->listener, bytes,
                    answer(relay, relay->service[i], message, bytes));
}

static void *serve(void *user)
{
    struct relay *relay = user;
    int ready = 0;
    while ((ready & 2) == 0) {
        ready = bus_wait(relay->bus, relay->stop[0], -1);
        pthread_mutex_lock(&relay->lock);
        if (ready & 1)
            bus_receive(relay->bus, on_query, relay);
        pthread_mutex_unlock(&relay->lock);
    }
    return NULL;
}

/* ---- Opening and closing ---- */

/* Of the unit tests that run at the same time in one network, each has ports of its own. */
static int next_port(void)
{
    static int port = 0;
    if (port == 0)
        port = 10000 + 97 * getpid() % 40000;
    return port++;
}

static struct answerer *start(size_t frames)
{
    static int64_t id = 100;
    const struct answerer_options options = {.frames = frames, .server_id = ++id, .secret = {3, 4}};
    struct answerer *answerer = answerer_create(&options);
    assert_non_null(answerer);
    return answerer;
}

struct relay *relay_new(void)
{
    struct relay *relay = calloc(1, sizeof *relay);
    assert_non_null(relay);
    return relay;
}

void relay_open(struct relay *relay, size_t frames)
{
    static const char *const channel[] = {WIRE_PAIR_QUERY, WIRE_SCENE_QUERY, WIRE_DEFINITION_QUERY};
    char why[BUS_WHY_MAX];
    snprintf(relay->url, sizeof relay->url, "udpm://239.255.76.67:%d?ttl=0", next_port());
    relay->bus = bus_open(relay->url, why);
    if (!relay->bus)
        fail_msg("%s", why);
    for (int kind = 0; kind < RELAY_KINDS; kind++)
        assert_true(bus_listen(relay->bus, channel[kind], why));
    relay->service[0] = start(frames);
    relay->job = scene_job_create();
    assert_non_null(relay->job);
    pthread_mutex_init(&relay->lock, NULL);
    assert_int_equal(pipe2(relay->stop, O_CLOEXEC), 0);
    assert_int_equal(pthread_create(&relay->thread, NULL, serve, relay), 0);
}

void relay_close(struct relay *relay)
{
    assert_int_equal(write(relay->stop[1], "", 1), 1);
    pthread_join(relay->thread, NULL);
    for (int i = 0; i < RELAY_SERVICES; i++)
        answerer_destroy(relay->service[i]);
    scene_job_destroy(relay->job);
    bus_close(relay->bus);
    close(relay->stop[0]);
    close(relay->stop[1]);
    pthread_mutex_destroy(&relay->lock);
    free(relay);
}

void relay_restart(struct relay *relay, size_t frames)
{
    answerer_destroy(relay->service[0]);
    relay->service[0] = start(frames);
}

void relay_add_service(struct relay *relay, size_t frames)
{
    pthread_mutex_lock(&relay->lock);
    relay->service[1] = relay->service[0];
    relay->service[0] = start(frames);
    pthread_mutex_unlock(&relay->lock);
}

struct fmb_client *relay_client(struct relay *relay, double timeout, int tries)
{
    const struct fmb_client_options options = {
        .url = relay->url, .timeout = timeout, .tries = tries};
    char why[FMB_CLIENT_WHY_MAX];
    struct fmb_client *client = fmb_client_open(&options, why, sizeof why);
    if (!client)
        fail_msg("%s", why);
    return client;
}

/* On output: the exit code of this program, run again in a network of its own. */
static int run_in_namespace(char *self)
{
    enum { SKIPPED = 77 };
    char netns[4096];
    int status;
    const char *slash = strrchr(self, '/');
    snprintf(netns, sizeof netns, "%.*s../netns", slash ? (int) (slash + 1 - self) : 0, self);
    const pid_t child = fork();
    if (child == 0) {
        execl(netns, netns, self, (char *) NULL);
        perror(netns);
        _exit(EXIT_FAILURE);
    }
    if (child < 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status))
        return EXIT_FAILURE;
    if (WEXITSTATUS(status) != SKIPPED)
        return WEXITSTATUS(status);
    puts("1..1\nok 1 - client # SKIP no network namespace, and no route for multicast");
    return EXIT_SUCCESS;
}

void relay_enter(char **argv)
{
    if (!getenv("FMB_NETNS"))
        exit(run_in_namespace(argv[0]));
}

/* ---- Scenes ---- */

static double draw(unsigned *state, double low, double high)
{
    *state = *state * 1664525u + 1013904223u;
    return low + (high - low) * (*state >> 8) / (double) (1 << 24);
}

void relay_draw(struct fmb_client_placement *out, size_t count, int dim, double size,
                int64_t first_id, unsigned seed)
{
    for (size_t i = 0; i < count; i++) {
        struct fmb_client_placement *placement = &out[i];
        memset(placement, 0, sizeof *placement);
        placement->body_id = first_id ? first_id + (int64_t) i : 0;
        placement->dim = dim;
        placement->shape = draw(&seed, 0, 1) < 0.5 ? FMB_CUBOID : FMB_TETRAHEDRON;
        if (dim == 3 && i % 20 == 7) /* few: they are slow to decide */
            placement->shape = FMB_FACE;
        placement->moving = draw(&seed, 0, 1) < 0.5;
        const int numbers = fmb_component_count(dim, placement->shape) * dim;
        for (int k = 0; k < numbers; k++)
            placement->components[k] = draw(&seed, -1, 1);
        for (int k = 0; k < dim; k++) {
            placement->position[k] = draw(&seed, 0, size);
            placement->velocity[k] = draw(&seed, -1, 1);
        }
        /* Some stand at whole places and touch. */
        for (int k = 0; k < dim && i % 3 == 0; k++)
            placement->position[k] = floor(placement->position[k]);
        for (int k = 0; k < numbers && i % 3 == 0; k++)
            placement->components[k] = k / dim == k % dim;
        placement->moving = placement->moving && i % 3 != 0;
    }
}

static void prepare(const struct fmb_client_scene *scene, struct fmb_prepared *out)
{
    for (size_t i = 0; i < scene->placement_count; i++) {
        const struct fmb_client_placement *of = &scene->placements[i];
        struct fmb_body body;
        struct fmb_frame frame = {.body = &body, .moving = of->moving};
        const int count = fmb_component_count(of->dim, of->shape) * of->dim;
        assert_int_equal(fmb_body_make(of->dim, of->shape, of->components, (size_t) count, &body),
                         FMB_OK);
        memcpy(frame.origin, of->position, sizeof frame.origin);
        memcpy(frame.velocity, of->velocity, sizeof frame.velocity);
        assert_int_equal(fmb_prepare(&frame, &out[i]), FMB_OK);
    }
}

static void add(struct relay_truth *truth, const unsigned pair[2], const struct fmb_answer *answer)
{
    if (truth->count == truth->capacity) {
        truth->capacity = 2 * truth->capacity + 1000;
        truth->pair = realloc(truth->pair, truth->capacity * sizeof *truth->pair);
        assert_non_null(truth->pair);
    }
    truth->pair[truth->count++] = (struct relay_pair){pair[0], pair[1], *answer};
}

enum { BATCH = 4096 };

/* Some pairs at a time. */
struct batch {
    unsigned pair[BATCH][2];
    unsigned char verdict[BATCH];
    double contact[BATCH][2], box[BATCH][2][FMB_DIM_MAX];
};

static void decide(const struct fmb_client_scene *scene, const struct fmb_prepared *frame,
                   struct batch *batch, size_t count, struct relay_truth *out)
{
    const bool times = scene->want & FMB_CLIENT_WANT_TIMES, box = scene->want & FMB_CLIENT_WANT_BOX;
    const struct fmb_batch question = {.frames = frame,
                                       .frame_count = scene->placement_count,
                                       .pairs = (const unsigned(*)[2]) batch->pair,
                                       .pair_count = count,
                                       .duration = scene->duration,
                                       .verdicts = batch->verdict,
                                       .contacts = times ? batch->contact : NULL,
                                       .boxes = box ? batch->box : NULL};
    assert_int_equal(fmb_decide_batch(&question), FMB_OK);
    for (size_t i = 0; i < count; i++) {
        const bool contact = batch->verdict[i] != FMB_SEPARATED;
        struct fmb_answer answer = {.verdict = (enum fmb_verdict) batch->verdict[i]};
        if (scene->which != FMB_CLIENT_LISTED && !contact)
            continue;
        if (contact && times && !isnan(batch->contact[i][0])) {
            answer.has_contact = true;
            memcpy(answer.contact, batch->contact[i], sizeof answer.contact);
        }
        answer.has_box = contact && box;
        for (int k = 0; k < 2 * FMB_DIM_MAX && answer.has_box; k++)
            if (k % FMB_DIM_MAX < scene->placements[0].dim)
                answer.box[k / FMB_DIM_MAX][k % FMB_DIM_MAX] =
                    batch->box[i][k / FMB_DIM_MAX][k % FMB_DIM_MAX];
        add(out, batch->pair[i], &answer);
    }
}

/* The pairs in their order, counted here by other means than the library's. */
void relay_truth_make(const struct fmb_client_scene *scene, struct relay_truth *out)
{
    struct fmb_prepared *frame = calloc(scene->placement_count + 1, sizeof *frame);
    struct batch *batch = malloc(sizeof *batch);
    size_t count = 0;
    const unsigned n = (unsigned) scene->placement_count, split = (unsigned) scene->split;
    *out = (struct relay_truth){.count = 0};
    prepare(scene, frame);
    for (size_t i = 0; scene->which == FMB_CLIENT_LISTED && i < scene->pair_count; i++) {
        memcpy(batch->pair[count++], scene->pairs[i], sizeof *scene->pairs);
        if (count == BATCH || i + 1 == scene->pair_count) {
            decide(scene, frame, batch, count, out);
            count = 0;
        }
    }
    for (unsigned a = 0; scene->which != FMB_CLIENT_LISTED && a < n; a++)
        for (unsigned b = a + 1; b < n; b++) {
            if (scene->which == FMB_CLIENT_ACROSS && (a >= split) == (b >= split))
                continue;
            batch->pair[count][0] = a;
            batch->pair[count++][1] = b;
            if (count == BATCH) {
                decide(scene, frame, batch, count, out);
                count = 0;
            }
        }
    decide(scene, frame, batch, count, out);
    free(batch);
    free(frame);
}

void relay_truth_clear(struct relay_truth *truth)
{
    free(truth->pair);
}

void relay_check(void *user, const struct fmb_client_answer *answer)
{
    struct relay_truth *truth = user;
    if (answer->status != FMB_OK) {
        assert_true(strlen(answer->text) > 0);
        truth->failed++;
        return;
    }
    assert_true(truth->given < truth->count);
    const struct relay_pair *pair = &truth->pair[truth->given++];
    const struct fmb_answer *is = &answer->answer, *should = &pair->answer;
    assert_int_equal(answer->a, pair->a);
    assert_int_equal(answer->b, pair->b);
    assert_int_equal(is->verdict, should->verdict);
    assert_int_equal(is->has_contact, should->has_contact);
    assert_int_equal(is->has_box, should->has_box);
    assert_memory_equal(is->contact, should->contact, sizeof is->contact);
    assert_memory_equal(is->box, should->box, sizeof is->box);
}

void relay_query(struct fmb_client *client, const struct fmb_client_scene *scene)
{
    struct relay_truth truth;
    relay_truth_make(scene, &truth);
    assert_int_equal(fmb_client_query(client, scene, relay_check, &truth), FMB_OK);
    assert_int_equal(truth.failed, 0);
    assert_int_equal(truth.given, truth.count);
    relay_truth_clear(&truth);
}

size_t relay_size(size_t size, size_t fast)
{
    return getenv("FMB_FAST") ? fast : size;
}
