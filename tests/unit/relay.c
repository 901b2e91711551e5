#define _GNU_SOURCE /* pipe2() */
#include "relay.h"

#include "answer_now.h"
#include "wire.h"

#include <fcntl.h>
#include <math.h>
#include <sched.h>
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

void relay_wait(struct relay *relay, uint64_t queries)
{
    bool answered = false;
    while (!answered) {
        pthread_mutex_lock(&relay->lock);
        answered = (uint64_t) relay->queries >= queries;
        pthread_mutex_unlock(&relay->lock);
        sched_yield();
    }
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
    int32_t status;
    const uint32_t size = (uint32_t) message->size;
    switch (message->listener) {
    case RELAY_PAIR:
    case RELAY_SCENE:
        if (answer_job_begin(relay->job,
                             message->listener == RELAY_PAIR ? ANSWER_PAIR : ANSWER_SCENE,
                             message->bytes, size))
            return 0;
        while (!answer_job_step(relay->job, service))
            continue;
        return answer_job_write(relay->job, 0, out, &status);
    default:
        if (wire_read_definition_query(message->bytes, size, &relay->definition_query))
            return 0;
        answer_definition(service, &relay->definition_query, &relay->definition);
        return wire_write_definition(&relay->definition, out);
    }
}

static void on_query(void *user, const struct bus_message *message)
{
    struct relay *relay = user;
    unsigned char bytes[QUERY_BYTES_MAX];
    relay->queries++;
    relay->bytes += message->size;
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

/* before() runs with the lock held and may restart the service. */
static void make_recursive(pthread_mutex_t *lock)
{
    pthread_mutexattr_t attributes;
    pthread_mutexattr_init(&attributes);
    pthread_mutexattr_settype(&attributes, PTHREAD_MUTEX_RECURSIVE);
    pthread_mutex_init(lock, &attributes);
    pthread_mutexattr_destroy(&attributes);
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
    relay->job = answer_job_create();
    assert_non_null(relay->job);
    make_recursive(&relay->lock);
    assert_int_equal(pipe2(relay->stop, O_CLOEXEC), 0);
    assert_int_equal(pthread_create(&relay->thread, NULL, serve, relay), 0);
}

void relay_close(struct relay *relay)
{
    assert_int_equal(write(relay->stop[1], "", 1), 1);
    pthread_join(relay->thread, NULL);
    for (int i = 0; i < RELAY_SERVICES; i++)
        answerer_destroy(relay->service[i]);
    answer_job_destroy(relay->job);
    bus_close(relay->bus);
    close(relay->stop[0]);
    close(relay->stop[1]);
    pthread_mutex_destroy(&relay->lock);
    free(relay);
}

void relay_restart(struct relay *relay, size_t frames)
{
    pthread_mutex_lock(&relay->lock);
    answerer_destroy(relay->service[0]);
    relay->service[0] = start(frames);
    pthread_mutex_unlock(&relay->lock);
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

struct relay_test test;

int relay_set_up(void **state)
{
    (void) state;
    test = (struct relay_test){.relay = relay_new()};
    return 0;
}

int relay_tear_down(void **state)
{
    (void) state;
    fmb_client_close(test.client);
    if (test.relay->bus)
        relay_close(test.relay);
    else
        free(test.relay);
    return 0;
}

void relay_start(size_t frames, double timeout, int tries)
{
    relay_open(test.relay, frames);
    test.client = relay_client(test.relay, timeout, tries);
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
    printf("1..1\nok 1 - %s # SKIP no network namespace, and no route for multicast\n",
           slash ? slash + 1 : self);
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

/* Memory that stays reachable until the program ends. */
static void *keep(size_t size)
{
    static struct block {
        struct block *next;
        max_align_t bytes[];
    } * blocks;
    struct block *block = calloc(1, sizeof *block + size);
    assert_non_null(block);
    block->next = blocks;
    blocks = block;
    return block->bytes;
}

/* whole: its components are unit vectors, its origin 0. */
static void draw_frame(struct fmb_frame *out, int dim, int shape, bool whole, unsigned *seed)
{
    const int count = fmb_component_count(dim, shape) * (shape == FMB_BOX ? 1 : dim);
    double number[FMB_FRAME_NUMBERS_MAX] = {0};
    for (int k = 0; k < count; k++) {
        const double drawn = draw(seed, shape == FMB_BOX ? 0 : -1, 1);
        number[dim + k] = whole ? shape == FMB_BOX || k / dim == k % dim : drawn;
    }
    for (int k = 0; k < dim && !whole; k++)
        number[k] = draw(seed, -0.5, 0.5);
    assert_int_equal(fmb_frame_make(dim, shape, number, (size_t) (dim + count), out), FMB_OK);
}

const struct fmb_body *relay_body(const struct fmb_frame *frames, size_t count)
{
    struct fmb_body *body = keep(sizeof *body + count * sizeof *frames);
    struct fmb_frame *copy = memcpy(body + 1, frames, count * sizeof *frames);
    assert_int_equal(fmb_body_make_frames(copy, count, body), FMB_OK);
    return body;
}

const struct fmb_body *relay_change(const struct fmb_body *body, int number, double value)
{
    double numbers[FMB_FRAME_NUMBERS_MAX];
    struct fmb_frame frame;
    bool by_vertices;
    const size_t count =
        fmb_frame_numbers(fmb_body_frame(body, 0), &by_vertices, numbers, FMB_FRAME_NUMBERS_MAX);
    const int shape = (int) fmb_body_frame(body, 0)->shape;
    numbers[number] = value;
    assert_false(by_vertices);
    assert_int_equal(fmb_frame_make(body->dim, shape, numbers, count, &frame), FMB_OK);
    return relay_body(&frame, 1);
}

static void draw_place(struct fmb_placement *out, double size, bool whole, unsigned *seed)
{
    const bool moving = draw(seed, 0, 1) < 0.5 && !whole;
    for (int k = 0; k < out->body->dim; k++) {
        out->position[k] = draw(seed, 0, size);
        out->velocity[k] = moving ? draw(seed, -1, 1) : 0;
    }
    /* Some are at whole places, and touch. */
    for (int k = 0; k < out->body->dim && whole; k++)
        out->position[k] = floor(out->position[k]);
    out->orientation_count = draw(seed, 0, 1) < 0.5 ? 0 : out->body->dim == 2 ? 2 : 4;
    for (int k = 0; k < out->orientation_count; k++)
        out->orientation[k] = whole ? k == 0 : draw(seed, -2, 2);
}

void relay_draw(struct fmb_placement *out, size_t count, int dim, double size, int64_t first_id,
                unsigned seed)
{
    static const int shapes[] = {FMB_CUBOID, FMB_TETRAHEDRON, FMB_BOX};
    for (size_t i = 0; i < count; i++) {
        const size_t frames = i % 5 == 1 ? 3 : 1;
        const bool whole = i % 3 == 0;
        struct fmb_frame frame[3];
        for (size_t k = 0; k < frames; k++) {
            int shape = shapes[(int) draw(&seed, 0, 2.999)];
            if (dim == 3 && i % 20 == 7) /* few: they are slow to decide */
                shape = FMB_FACE;
            draw_frame(&frame[k], dim, shape, whole, &seed);
            if (i % 10 == 1 && k == 1)
                assert_int_equal(fmb_frame_inflate(&frame[k], whole ? 0.25 : 0.1), FMB_OK);
        }
        out[i] = (struct fmb_placement){.body = relay_body(frame, frames),
                                        .id = first_id ? first_id + (int64_t) i : 0};
        draw_place(&out[i], size, whole, &seed);
    }
}

void relay_use_first_frames(struct fmb_placement *placements, size_t count)
{
    for (size_t i = 0; i < count; i++)
        placements[i].body = relay_body(fmb_body_frame(placements[i].body, 0), 1);
}

/* ---- Truth ---- */

static void add(struct relay_truth *truth, const unsigned pair[2], const struct fmb_answer *answer)
{
    if (truth->count == truth->capacity) {
        truth->capacity = 2 * truth->capacity + 1000;
        truth->pair = realloc(truth->pair, truth->capacity * sizeof *truth->pair);
        assert_non_null(truth->pair);
    }
    truth->pair[truth->count++] = (struct relay_pair){pair[0], pair[1], *answer};
}

/* Whether the pair is surely farther apart than the margin: no vertex is as far from a body's
 * position as its reach. */
static bool are_far(const struct fmb_placement *a, const struct fmb_placement *b,
                    const struct fmb_scene *scene)
{
    double distance = 0, speed = 0;
    for (int axis = 0; axis < a->body->dim; axis++) {
        distance += pow(a->position[axis] - b->position[axis], 2);
        speed += fabs(a->velocity[axis] - b->velocity[axis]);
    }
    return sqrt(distance) >
           a->body->reach + b->body->reach + scene->duration * speed + scene->margin + 0.001;
}

static bool is_ignored(const struct fmb_scene *scene, unsigned a, unsigned b)
{
    const int64_t group = scene->placements[a].group;
    if (group != 0 && group == scene->placements[b].group)
        return true;
    for (size_t i = 0; i < scene->ignored_count; i++) {
        const unsigned *pair = scene->ignored[i];
        if ((pair[0] == a && pair[1] == b) || (pair[0] == b && pair[1] == a))
            return true;
    }
    return false;
}

static void decide(const struct fmb_scene *scene, const unsigned pair[2], struct relay_truth *out)
{
    const struct fmb_placement *a = &scene->placements[pair[0]], *b = &scene->placements[pair[1]];
    const bool all_gaps = scene->want & FMB_WANT_GAP;
    const unsigned want = (scene->want & (FMB_WANT_BOX | FMB_WANT_POINT)) |
                          (all_gaps || scene->margin > 0 ? FMB_WANT_GAP : 0);
    struct fmb_answer answer = {.verdict = FMB_SEPARATED};
    if (is_ignored(scene, pair[0], pair[1]))
        return;
    if (all_gaps || !are_far(a, b, scene))
        assert_int_equal(fmb_decide(fmb_method_default(), a, b, scene->duration, want, &answer),
                         FMB_OK);
    const bool near = scene->margin > 0 && answer.has_gap && answer.gap.bounds[0] <= scene->margin;
    if (!all_gaps)
        query_remove_far_gap(scene->margin, &answer);
    if (!(scene->want & FMB_WANT_TIMES)) {
        answer.has_contact = false;
        memset(answer.contact, 0, sizeof answer.contact);
    }
    if (scene->which == FMB_PAIRS_LISTED || answer.verdict != FMB_SEPARATED || near)
        add(out, pair, &answer);
}

/* The pairs in their order, counted here by other means than the library's. */
void relay_truth_make(const struct fmb_scene *scene, struct relay_truth *out)
{
    const unsigned n = (unsigned) scene->placement_count, split = (unsigned) scene->split;
    const bool listed = scene->which == FMB_PAIRS_LISTED;
    unsigned long long number = 0;
    *out = (struct relay_truth){.count = 0};
    for (size_t i = scene->first_pair; listed && i < scene->pair_count; i++)
        decide(scene, scene->pairs[i], out);
    for (unsigned a = 0; !listed && a < n; a++)
        for (unsigned b = a + 1; b < n; b++)
            if (scene->which == FMB_PAIRS_ALL || (a < split && b >= split))
                if (number++ >= scene->first_pair)
                    decide(scene, (const unsigned[]){a, b}, out);
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
        print_message("# %u and %u: %s\n", answer->a, answer->b, answer->text);
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
    assert_int_equal(is->has_point, should->has_point);
    assert_memory_equal(is->point, should->point, sizeof is->point);
    assert_int_equal(is->has_gap, should->has_gap);
    assert_true(query_same_gap(&is->gap, &should->gap));
}

void relay_query(struct fmb_client *client, const struct fmb_scene *scene)
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
