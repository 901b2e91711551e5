#include "relay.h"

#include "bus.h"
#include "question.h"
#include "wire.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { QUEUE = 10000 };

static bool every(int times, int count)
{
    return times > 0 && count % times == 0;
}

static void settle(struct relay *relay)
{
    while (lcm_handle_timeout(relay->service, 0) > 0 || server_answer(relay->server))
        continue;
}

/* ---- Queries ---- */

static void refuse_busy(struct relay *relay, const lcm_recv_buf_t *buffer)
{
    struct query_header header;
    static const struct scene_result none;
    unsigned char bytes[QUERY_BYTES_MAX];
    if (wire_read_scene_header(buffer->data, buffer->data_size, &header))
        return;
    struct scene_result *result = calloc(1, sizeof *result);
    *result = none;
    result->client_id = header.client_id;
    result->sequence_number = header.sequence_number;
    result->status = FMB_BUSY;
    const size_t size = wire_write_scene_result(result, bytes);
    lcm_publish(relay->client, WIRE_SCENE_RESULT, bytes, (unsigned) size);
    free(result);
}

static void on_query(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct relay *relay = user;
    relay->queries++;
    relay->bytes += buffer->data_size;
    assert_true(buffer->data_size <= QUERY_BYTES_MAX);
    if (relay->before)
        relay->before(relay);
    if (relay->deaf || every(relay->lose_query, relay->queries))
        return;
    if (every(relay->busy, relay->queries)) {
        refuse_busy(relay, buffer);
        return;
    }
    lcm_publish(relay->service, channel, buffer->data, buffer->data_size);
    settle(relay);
}

/* ---- Results ---- */

static void publish_lie(struct relay *relay, const lcm_recv_buf_t *buffer, const char *channel)
{
    unsigned char bytes[QUERY_BYTES_MAX];
    struct scene_result *result = malloc(sizeof *result);
    assert_null(wire_read_scene_result(buffer->data, buffer->data_size, result));
    relay->lie(result, ++relay->turn);
    lcm_publish(relay->client, channel, bytes, (unsigned) wire_write_scene_result(result, bytes));
    free(result);
}

static void on_result(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct relay *relay = user;
    assert_true(buffer->data_size <= QUERY_BYTES_MAX);
    relay->results++;
    if (every(relay->lose_result, relay->results))
        return;
    if (relay->late_size == 0 && every(relay->delay_result, relay->results)) {
        memcpy(relay->late, buffer->data, buffer->data_size);
        relay->late_size = buffer->data_size;
        snprintf(relay->late_channel, sizeof relay->late_channel, "%s", channel);
        return;
    }
    if (relay->lie && strcmp(channel, WIRE_SCENE_RESULT) == 0)
        publish_lie(relay, buffer, channel);
    else
        lcm_publish(relay->client, channel, buffer->data, buffer->data_size);
    if (every(relay->double_result, relay->results))
        lcm_publish(relay->client, channel, buffer->data, buffer->data_size);
    if (relay->late_size > 0)
        lcm_publish(relay->client, relay->late_channel, relay->late, relay->late_size);
    relay->late_size = 0;
}

/* ---- Life ---- */

static struct server *start(struct relay *relay, size_t bodies)
{
    static int64_t id = 100;
    id++;
    const struct server_options options = {
        .prefix = "", .bodies = bodies, .server_id = id, .first_key = 100000 * id, .seed = 7};
    struct server *server = server_create(relay->service, &options);
    assert_non_null(server);
    return server;
}

void relay_open(struct relay *relay, size_t bodies)
{
    relay->service = lcm_create("memq://");
    relay->client = lcm_create("memq://");
    relay->server = start(relay, bodies);
    assert_non_null(bus_subscribe(relay->client, "FMB_.*_QUERY", on_query, relay, QUEUE));
    assert_non_null(bus_subscribe(relay->service, "FMB_.*_RESULT", on_result, relay, QUEUE));
}

void relay_close(struct relay *relay)
{
    server_destroy(relay->server);
    lcm_destroy(relay->service);
    lcm_destroy(relay->client);
}

void relay_restart(struct relay *relay, size_t bodies)
{
    server_destroy(relay->server);
    relay->server = start(relay, bodies);
}

struct fmb_client *relay_client(struct relay *relay, double timeout, int tries)
{
    const struct fmb_client_options options = {
        .lcm = relay->client, .timeout = timeout, .tries = tries};
    char why[FMB_CLIENT_WHY_MAX];
    struct fmb_client *client = fmb_client_open(&options, why, sizeof why);
    assert_non_null(client);
    return client;
}

/* ---- Scenes ---- */

static double draw(unsigned *state, double low, double high)
{
    *state = *state * 1664525u + 1013904223u;
    return low + (high - low) * (*state >> 8) / (double) (1 << 24);
}

void relay_draw(struct fmb_client_frame *out, size_t count, int dim, double size, int64_t first_id,
                unsigned seed)
{
    for (size_t i = 0; i < count; i++) {
        struct fmb_client_frame *frame = &out[i];
        memset(frame, 0, sizeof *frame);
        frame->body_id = first_id ? first_id + (int64_t) i : 0;
        frame->dim = dim;
        frame->shape = draw(&seed, 0, 1) < 0.5 ? FMB_CUBOID : FMB_TETRAHEDRON;
        if (dim == 3 && i % 20 == 7) /* few: they are slow to decide */
            frame->shape = FMB_FACE;
        frame->moving = draw(&seed, 0, 1) < 0.5;
        const int numbers = fmb_component_count(dim, frame->shape) * dim;
        for (int k = 0; k < numbers; k++)
            frame->components[k] = draw(&seed, -1, 1);
        for (int k = 0; k < dim; k++) {
            frame->origin[k] = draw(&seed, 0, size);
            frame->velocity[k] = draw(&seed, -1, 1);
        }
        /* Some stand at whole places and touch. */
        for (int k = 0; k < dim && i % 3 == 0; k++)
            frame->origin[k] = floor(frame->origin[k]);
        for (int k = 0; k < numbers && i % 3 == 0; k++)
            frame->components[k] = k / dim == k % dim;
        frame->moving = frame->moving && i % 3 != 0;
    }
}

static void prepare(const struct fmb_client_scene *scene, struct fmb_prepared *out)
{
    for (size_t i = 0; i < scene->frame_count; i++) {
        const struct fmb_client_frame *of = &scene->frames[i];
        struct fmb_body body;
        struct fmb_frame frame = {.body = &body, .moving = of->moving};
        const int count = fmb_component_count(of->dim, of->shape) * of->dim;
        assert_int_equal(fmb_body_make(of->dim, of->shape, of->components, (size_t) count, &body),
                         FMB_OK);
        memcpy(frame.origin, of->origin, sizeof frame.origin);
        memcpy(frame.velocity, of->velocity, sizeof frame.velocity);
        assert_int_equal(fmb_prepare(&frame, &out[i]), FMB_OK);
    }
}

static void add(struct relay_truth *truth, const unsigned pair[2], const struct fmb_answer *answer)
{
    if (truth->count == truth->room) {
        truth->room = 2 * truth->room + 1000;
        truth->pair = realloc(truth->pair, truth->room * sizeof *truth->pair);
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
                                       .frame_count = scene->frame_count,
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
            if (k % FMB_DIM_MAX < scene->frames[0].dim)
                answer.box[k / FMB_DIM_MAX][k % FMB_DIM_MAX] =
                    batch->box[i][k / FMB_DIM_MAX][k % FMB_DIM_MAX];
        add(out, batch->pair[i], &answer);
    }
}

/* The pairs in their order, counted here by other means than the library's. */
void relay_truth_make(const struct fmb_client_scene *scene, struct relay_truth *out)
{
    struct fmb_prepared *frame = calloc(scene->frame_count + 1, sizeof *frame);
    struct batch *batch = malloc(sizeof *batch);
    size_t count = 0;
    const unsigned n = (unsigned) scene->frame_count, split = (unsigned) scene->split;
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
    assert_true(truth->told < truth->count);
    const struct relay_pair *pair = &truth->pair[truth->told++];
    const struct fmb_answer *is = &answer->answer, *should = &pair->answer;
    assert_int_equal(answer->a, pair->a);
    assert_int_equal(answer->b, pair->b);
    assert_int_equal(is->verdict, should->verdict);
    assert_int_equal(is->has_contact, should->has_contact);
    assert_int_equal(is->has_box, should->has_box);
    assert_memory_equal(is->contact, should->contact, sizeof is->contact);
    assert_memory_equal(is->box, should->box, sizeof is->box);
}

void relay_ask(struct fmb_client *client, const struct fmb_client_scene *scene)
{
    struct relay_truth truth;
    relay_truth_make(scene, &truth);
    assert_int_equal(fmb_client_ask(client, scene, relay_check, &truth), FMB_OK);
    assert_int_equal(truth.failed, 0);
    assert_int_equal(truth.told, truth.count);
    relay_truth_clear(&truth);
}

size_t relay_size(size_t size, size_t fast)
{
    return getenv("FMB_FAST") ? fast : size;
}
