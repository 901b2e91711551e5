#include "service.h"

#include "clock.h"
#include "geometry_write.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

struct service service;

/* ---- What is published ---- */

static int64_t cost_of(const struct service_result *result)
{
    if (result->status == FMB_BUSY)
        return service.refusal_ns;
    const int64_t odd_ns = service.odd_cost_ns[result->client_id];
    return result->sequence_number % 2 && odd_ns ? odd_ns : service.cost_ns[result->client_id];
}

static void add(struct service_result result)
{
    assert_true(service.count < SERVICE_RESULTS_MAX);
    if (result.client_id < SERVICE_CLIENTS) {
        service.now_ns += cost_of(&result);
        service.answers[result.client_id]++;
    }
    result.published_ns = service.now_ns;
    service.result[service.count++] = result;
}

static void take_pair(const unsigned char *bytes, uint32_t size)
{
    assert_null(wire_read_pair_result(bytes, size, &service.pair));
    strcpy(service.certificate, service.pair.certificate ? service.pair.certificate : "");
    service.pair.certificate = service.certificate;
    add((struct service_result){.kind = SERVER_PAIRS,
                                .client_id = service.pair.client_id,
                                .sequence_number = service.pair.sequence_number,
                                .status = service.pair.status});
}

static void take_scene(const unsigned char *bytes, uint32_t size)
{
    static struct scene_result result;
    assert_null(wire_read_scene_result(bytes, size, &result));
    service.scene_compute_ns = result.compute_ns;
    add((struct service_result){.kind = SERVER_SCENES,
                                .client_id = result.client_id,
                                .sequence_number = result.sequence_number,
                                .status = result.status,
                                .end_pair = result.end_pair});
}

static void take_definition(const unsigned char *bytes, uint32_t size)
{
    static struct definition result;
    assert_null(wire_read_definition(bytes, size, &result));
    service.definition_bodies = result.body_count;
    add((struct service_result){.kind = SERVER_DEFINITIONS,
                                .client_id = result.client_id,
                                .sequence_number = result.sequence_number,
                                .status = result.status});
}

static bool on_publish(void *user, const char *channel, const unsigned char *bytes, size_t size)
{
    const uint32_t length = (uint32_t) size;
    (void) user;
    if (service.refuses)
        return false;
    if (strcmp(channel, "T_" WIRE_PAIR_RESULT) == 0)
        take_pair(bytes, length);
    else if (strcmp(channel, "T_" WIRE_SCENE_RESULT) == 0)
        take_scene(bytes, length);
    else if (strcmp(channel, "T_" WIRE_DEFINITION) == 0)
        take_definition(bytes, length);
    else
        assert_null(wire_read_status(bytes, length, &service.status));
    return true;
}

/* ---- The server ---- */

static int64_t clock_now(void)
{
    service.now_ns += service.tick_ns;
    return service.now_ns;
}

int service_open(void **state)
{
    const struct server_options options = {.prefix = "T_",
                                           .frames = 2000,
                                           .server_id = 11,
                                           .secret = {5, 6, 7},
                                           .publish = on_publish,
                                           .clock_ns = clock_now};
    (void) state;
    memset(&service, 0, sizeof service);
    service.now_ns = 1;
    service.opened_ns = clock_ns();
    service.server = server_create(&options);
    return service.server ? 0 : -1;
}

int service_close(void **state)
{
    (void) state;
    server_destroy(service.server);
    return 0;
}

void service_receive(enum server_kind kind, const unsigned char *bytes, size_t size)
{
    server_receive(service.server, kind, bytes, size);
    service.now_ns += service.batch_ns;
    server_end_batch(service.server, 1);
}

void service_settle(void)
{
    enum server_state state;
    while ((state = server_work(service.server)) != SERVER_IDLE) {
        if (state != SERVER_ANTICIPATING)
            continue;
        service.now_ns += 1000;
        server_resume(service.server);
    }
}

const struct wire_status *service_status(void)
{
    const struct bus_counts counts = {
        .foreign = 3, .malformed = 4, .dropped = 5, .receive_buffer = 6};
    server_heartbeat(service.server, &counts);
    return &service.status;
}

/* ---- Queries ---- */

static unsigned char geometries[2][GEOMETRY_FRAME_BYTES_MAX];
static unsigned char bytes[QUERY_BYTES_MAX];

struct pair_query service_pair(int64_t client_id, int64_t sequence_number)
{
    const struct plain_frame frame = {.shape = FMB_CUBOID, .components = {1, 0, 0, 1}};
    struct pair_query query = {
        .client_id = client_id, .sequence_number = sequence_number, .duration = 1};
    for (int i = 0; i < 2; i++) {
        query.placement[i] = (struct query_placement){.body.dim = 2,
                                                      .body.frame_count = 1,
                                                      .body.number_count = 6,
                                                      .placed.position = {i, 0}};
        query.placement[i].body = geometry_write(2, &frame, geometries[i]);
    }
    return query;
}

void service_send_pair(const struct pair_query *query)
{
    service_receive(SERVER_PAIRS, bytes, wire_write_pair_query(query, bytes));
}

void service_query_pair(int64_t client_id, int64_t sequence_number)
{
    const struct pair_query query = service_pair(client_id, sequence_number);
    service_send_pair(&query);
}

static struct query_placement grating(int frames)
{
    static struct plain_frame frame[900];
    static unsigned char geometry[900 * GEOMETRY_FRAME_BYTES_MAX];
    for (int i = 0; i < frames; i++)
        frame[i] =
            (struct plain_frame){.shape = FMB_BOX, .origin = {0.0001 * i}, .components = {1, 1}};
    return (struct query_placement){.body = geometry_write_frames(2, frame, frames, geometry)};
}

void service_query_frames(int64_t client_id, int64_t sequence_number, int frames)
{
    const struct query_placement placement = grating(frames);
    const struct pair_query query = {.client_id = client_id,
                                     .sequence_number = sequence_number,
                                     .duration = 1,
                                     .placement = {placement, placement}};
    service_send_pair(&query);
}

void service_query_frames_scene(int64_t client_id, int64_t sequence_number, int frames)
{
    static struct scene_query query;
    query = (struct scene_query){.client_id = client_id,
                                 .sequence_number = sequence_number,
                                 .duration = 1,
                                 .want = FMB_WANT_TIMES,
                                 .which = FMB_PAIRS_ALL,
                                 .placement_count = 2};
    query.placement[0] = query.placement[1] = grating(frames);
    service_receive(SERVER_SCENES, bytes, wire_write_scene_query(&query, bytes));
}

void service_query_scene(int64_t client_id, int64_t sequence_number, int32_t bodies)
{
    const struct plain_frame strip = {.shape = FMB_TETRAHEDRON, .components = {3000, 3000, 0, 0.5}};
    static struct scene_query query;
    query = (struct scene_query){.client_id = client_id,
                                 .sequence_number = sequence_number,
                                 .duration = 1,
                                 .method = fmb_method_by_name("exact")->number,
                                 .which = FMB_PAIRS_ALL,
                                 .placement_count = bodies};
    const struct body_view geometry = geometry_write(2, &strip, geometries[0]);
    for (int32_t i = 0; i < bodies; i++)
        query.placement[i] = (struct query_placement){.body = geometry, .placed.position = {0, i}};
    service_receive(SERVER_SCENES, bytes, wire_write_scene_query(&query, bytes));
}

void service_query_definitions(int64_t client_id, int64_t sequence_number)
{
    static struct definition_query query;
    query = (struct definition_query){.client_id = client_id, .sequence_number = sequence_number};
    service_receive(SERVER_DEFINITIONS, bytes, wire_write_definition_query(&query, bytes));
}
