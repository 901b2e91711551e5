#include "seeds.h"

#include "fuzz.h"
#include "hostile.h"
#include "wire.h"

#include "fmb_msgs_definition_query_t.h"
#include "fmb_msgs_definition_t.h"
#include "fmb_msgs_pair_query_t.h"
#include "fmb_msgs_status_t.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BOX = FMB_WANT_BOX, TIMES = FMB_WANT_TIMES };

static unsigned char bytes[QUERY_BYTES_MAX];

static void write_good(const char *type)
{
    seeds_write(type, "good", bytes, hostile_good(type, bytes));
}

/* ---- Pairs ---- */

static void write_placement(const char *name, fmb_msgs_placement_t placement)
{
    static char none[] = "";
    placement.name = placement.name ? placement.name : none;
    fmb_msgs_pair_query_t message = {.a = placement, .b.name = none};
    const int size = fmb_msgs_pair_query_t_encode(bytes, 0, sizeof bytes, &message);
    FUZZ_CHECK(size > 0);
    seeds_write("pair_query", name, bytes, (size_t) size);
}

/* Counts and shapes that a reader accepts and the service refuses. */
static void write_other_placements(void)
{
    static double many[40];
    static uint8_t shapes[3] = {FMB_MSGS_PLACEMENT_T_SHAPE_BOX, FMB_MSGS_PLACEMENT_T_SHAPE_FACE, 0};
    static uint8_t vertices[3] = {FMB_MSGS_PLACEMENT_T_SHAPE_TETRAHEDRON_VERTICES,
                                  FMB_MSGS_PLACEMENT_T_SHAPE_HULL,
                                  FMB_MSGS_PLACEMENT_T_SHAPE_FACE_VERTICES};
    static int32_t counts[3] = {4, 2, 3};
    static char name[] = "a\xc3\xa9\n\xff";
    write_placement("vertices", (fmb_msgs_placement_t){.dim = 3,
                                                       .num_frames = 3,
                                                       .shapes = vertices,
                                                       .num_counts = 3,
                                                       .counts = counts,
                                                       .num_numbers = 27,
                                                       .numbers = many,
                                                       .name = name,
                                                       .group = -7,
                                                       .position = many});
    write_placement("long-lists", (fmb_msgs_placement_t){.dim = 12,
                                                         .num_numbers = 9,
                                                         .numbers = many,
                                                         .position = many,
                                                         .num_orientation = 9,
                                                         .orientation = many,
                                                         .num_velocity = 9,
                                                         .velocity = many});
    write_placement("frames", (fmb_msgs_placement_t){.dim = 3,
                                                     .num_frames = 3,
                                                     .shapes = shapes,
                                                     .num_numbers = 21,
                                                     .numbers = many,
                                                     .position = many,
                                                     .num_orientation = 4,
                                                     .orientation = many});
}

static void write_pair_queries(void)
{
    write_good("pair_query");
    write_other_placements();
    for (int i = 0; i < SEEDS_PAIRS; i++) {
        struct pair_query query = seeds_pair_number(i);
        if (i % 4 == 3)
            query.placement[0] = seeds_by_handle(query.placement[0]);
        seeds_write("pair_query", seeds_pair_name(i), bytes, wire_write_pair_query(&query, bytes));
    }
}

static void write_pair_result(const char *name, const struct pair_result *result)
{
    seeds_write("pair_result", name, bytes, wire_write_pair_result(result, bytes));
}

static void write_pair_results(void)
{
    write_good("pair_result");
    struct pair_result result = {.utime = 1, .client_id = 2, .method = 4, .dim = 2};
    result.handle[1].bytes[0] = 7;
    result.answer.verdict = FMB_OVERLAPPING;
    result.answer.has_box = result.answer.has_contact = true;
    result.answer.contact[1] = 0.5;
    result.answer.box[1][0] = HUGE_VAL;
    write_pair_result("box-2d", &result);
    result.answer.has_contact = false;
    result.certificate = "overlapping at 0 a 0 3 b 0:1/2 3:1/2";
    write_pair_result("certificate", &result);
    result = (struct pair_result){.method = 4, .dim = 3};
    result.answer.verdict = FMB_SEPARATED;
    result.answer.has_gap = true;
    result.answer.gap = (struct fmb_gap){.bounds = {1, HUGE_VAL},
                                         .direction = {0, -1, 0},
                                         .has_witness = true,
                                         .time = 0.5,
                                         .witness = {{1, 2, 3}, {-1, -HUGE_VAL, 0}}};
    write_pair_result("gap-apart", &result);
    result.names_frames = true;
    result.answer.gap.frame[1] = 300;
    write_pair_result("gap-frames", &result);
    result = (struct pair_result){.status = FMB_BAD_ID, .detail = "client_id: not from 0"};
    write_pair_result("refused", &result);
    memset(result.detail, 'a', sizeof result.detail - 1);
    result.detail[7] = '\n';
    write_pair_result("long-detail", &result);
}

/* ---- Scenes ---- */

static void write_scene_query(const char *name, const struct scene_query *query)
{
    seeds_write("scene_query", name, bytes, wire_write_scene_query(query, bytes));
}

static void write_scene_queries(void)
{
    write_good("scene_query");
    write_scene_query("empty", seeds_scene(0, FMB_PAIRS_ALL, 0));
    write_scene_query("listed", seeds_scene(4, FMB_PAIRS_LISTED, BOX | TIMES));
    write_scene_query("all", seeds_scene(5, FMB_PAIRS_ALL, BOX));
    write_scene_query("across", seeds_scene(6, FMB_PAIRS_ACROSS, TIMES));
    struct scene_query *query = fuzz_room(sizeof *query);
    *query = *seeds_scene(5, FMB_PAIRS_ALL, FMB_WANT_GAP);
    query->margin = 0.5;
    write_scene_query("margin", query);
    query->label = "shelf \xe2\x82\xac \xff\n";
    query->placement[1].placed.name = "arm";
    query->placement[1].placed.group = query->placement[2].placed.group = INT64_MAX;
    write_scene_query("groups", query);
    *query = *seeds_scene(0, FMB_PAIRS_ALL, 0);
    const struct query_placement placement =
        seeds_by_handle(seeds_placement(0, FMB_CUBOID, 2, 0, 0));
    query->placement_count = (QUERY_BYTES_MAX - WIRE_SCENE_QUERY_BYTES) / QUERY_PLACEMENT_BYTES_MIN;
    for (int i = 0; i < query->placement_count; i++)
        query->placement[i] = placement;
    write_scene_query("many-placements", query);
    query->which = FMB_PAIRS_LISTED;
    query->placement_count = 2;
    query->index_count = 2000;
    query->ignored_count = 4;
    for (int i = 0; i < query->index_count; i++)
        query->pair[i / 2][i % 2] = (unsigned) -i;
    write_scene_query("many-pairs", query);
    free(query);
}

static void write_scene_result(const char *name, const struct scene_result *result)
{
    seeds_write("scene_result", name, bytes, wire_write_scene_result(result, bytes));
}

static void write_named_results(struct scene_result *result)
{
    result->names_pairs = result->has_boxes = true;
    result->dim = 2;
    result->contact_count = result->verdict_count;
    for (int i = 0; i < result->verdict_count; i++) {
        result->verdict[i] = FMB_TOUCHING;
        result->pair[i][0] = (unsigned) i;
        result->pair[i][1] = (unsigned) (QUERY_PLACEMENTS_MAX - result->verdict_count + i);
    }
    write_scene_result("named-2d", result);
    result->dim = 3;
    result->handle_count = 5;
    write_scene_result("named-3d", result);
}

/* Of listed pairs, one of each verdict and one that is far; and of those that are named. */
static void write_gaps(void)
{
    static const unsigned char verdicts[] = {FMB_OVERLAPPING, FMB_TOUCHING, FMB_SEPARATED,
                                             FMB_SEPARATED};
    static struct scene_result result = {.method = 4, .end_pair = 9, .dim = 3, .has_gaps = true};
    result.verdict_count = 4;
    result.contact_count = 2;
    memcpy(result.verdict, verdicts, sizeof verdicts);
    result.gap[0] = (struct fmb_gap){.bounds = {-0.5, -0.25}, .direction = {1}};
    result.gap[2] = (struct fmb_gap){
        .bounds = {0.5, 1}, .direction = {0, 1}, .has_witness = true, .witness = {{1}, {2}}};
    result.gap[3].bounds[0] = result.gap[3].bounds[1] = NAN;
    write_scene_result("gaps-listed", &result);
    result.names_frames = true;
    result.gap[0].frame[0] = 1;
    result.gap[2].frame[1] = 1000;
    write_scene_result("gaps-frames", &result);
    result.names_frames = false;
    result.names_pairs = true;
    result.verdict_count = 3;
    for (unsigned i = 0; i < 3; i++)
        result.pair[i][1] = i + 1;
    write_scene_result("gaps-named", &result);
}

static void write_scene_results(void)
{
    static struct scene_result result = {.client_id = 2, .method = 4, .end_pair = 9};
    write_good("scene_result");
    write_scene_result("empty", &result);
    result.verdict_count = 4;
    for (int i = 0; i < result.verdict_count; i++)
        result.verdict[i] = (unsigned char) i;
    result.contact_count = 2;
    result.has_times = true;
    result.times[0] = result.times[1] = NAN;
    write_scene_result("listed", &result);
    write_named_results(&result);
    memset(&result, 0, sizeof result);
    result.verdict_count = 3000;
    write_scene_result("many", &result);
    result.verdict_count = 0;
    result.status = FMB_UNKNOWN_BODY;
    strcpy(result.detail, "placements: handles that are not held");
    result.unknown_count = 2;
    result.unknown[1] = QUERY_PLACEMENTS_MAX - 1;
    write_scene_result("unknown", &result);
    result.unknown[1]++;
    write_scene_result("unknown-beyond", &result);
    result = (struct scene_result){.status = FMB_BUSY, .detail = "queue full"};
    write_scene_result("refused", &result);
    write_gaps();
}

/* ---- Definitions ---- */

static void write_definition_queries(void)
{
    static struct definition_query query = {.utime = 1, .client_id = 2, .first = 3};
    static uint8_t handles[HANDLE_BYTES * (QUERY_HANDLES_MAX + 1)];
    static uint8_t large[sizeof handles + 100];
    fmb_msgs_definition_query_t message = {.num_handle_bytes = sizeof handles, .handles = handles};
    write_good("definition_query");
    seeds_write("definition_query", "all", bytes, wire_write_definition_query(&query, bytes));
    const int size = fmb_msgs_definition_query_t_encode(large, 0, sizeof large, &message);
    FUZZ_CHECK(size > 0);
    seeds_write("definition_query", "too-many", large, (size_t) size);
}

/* Encoded by lcm-gen. Handles are all 0: the target sets them. */
static void write_bodies(const char *name, fmb_msgs_body_t *bodies, int32_t count)
{
    char detail[] = "";
    fmb_msgs_definition_t message = {.detail = detail, .num_bodies = count, .bodies = bodies};
    const int size = fmb_msgs_definition_t_encode(bytes, 0, sizeof bytes, &message);
    FUZZ_CHECK(size > 0);
    seeds_write("definition", name, bytes, (size_t) size);
}

/* Bodies that no service holds. */
static void write_other_bodies(void)
{
    static double numbers[21];
    static uint8_t shapes[3] = {FMB_MSGS_PLACEMENT_T_SHAPE_BOX, 77, 0};
    static fmb_msgs_body_t bodies[QUERY_BODIES_MAX + 1];
    bodies[0] = (fmb_msgs_body_t){
        .dim = 3, .num_frames = 3, .shapes = shapes, .num_numbers = 21, .numbers = numbers};
    bodies[1] = (fmb_msgs_body_t){.dim = -1, .num_frames = 1, .shapes = shapes};
    write_bodies("other-bodies", bodies, 2);
    write_bodies("no-frames", bodies, 3);
    for (int i = 0; i <= QUERY_BODIES_MAX; i++)
        bodies[i] = bodies[1];
    write_bodies("too-many", bodies, QUERY_BODIES_MAX + 1);
}

static void write_definitions(void)
{
    static struct definition definition = {.utime = 1, .client_id = 2, .server_id = 9, .next = 5};
    write_good("definition");
    write_other_bodies();
    seeds_write("definition", "empty", bytes, wire_write_definition(&definition, bytes));
    for (int i = 0; i < 5; i++) {
        const int dim = i < 3 ? 3 : 2;
        const struct query_placement body = seeds_placement(0, 1 + i % 3, dim, 0, 0);
        definition.body[i] = body.body;
        definition.body[i].handle = seeds_handle(&body);
    }
    definition.body_count = 5;
    seeds_write("definition", "shapes", bytes, wire_write_definition(&definition, bytes));
    definition.body[4].handle.bytes[HANDLE_BYTES - 1] ^= 1;
    seeds_write("definition", "other-handle", bytes, wire_write_definition(&definition, bytes));
    definition = (struct definition){.status = FMB_BUSY, .detail = "queue full\n"};
    seeds_write("definition", "refused", bytes, wire_write_definition(&definition, bytes));
}

/* ---- Heartbeats ---- */

static void write_statuses(void)
{
    write_good("status");
    struct wire_status status = {.utime = 1, .server_id = 99, .version = "0.1.0", .waiting = 3};
    seeds_write("status", "ours", bytes, wire_write_status(&status, bytes));
    char version[] = "10.20.30-with-a-long-name-that-goes-on\tand-on";
    char name[] = "received", unknown[] = "unknown";
    char *names[257] = {name, unknown, name};
    int64_t values[257] = {3, 2, 1};
    for (int i = 3; i < 257; i++)
        names[i] = unknown;
    fmb_msgs_status_t message = {
        .version = version, .num_counters = 3, .names = names, .values = values};
    const int size = fmb_msgs_status_t_encode(bytes, 0, sizeof bytes, &message);
    FUZZ_CHECK(size > 0);
    seeds_write("status", "newer", bytes, (size_t) size);
    message.num_counters = 257;
    const int large = fmb_msgs_status_t_encode(bytes, 0, sizeof bytes, &message);
    FUZZ_CHECK(large > 0);
    seeds_write("status", "many", bytes, (size_t) large);
}

void seeds_messages(void)
{
    write_pair_queries();
    write_pair_results();
    write_scene_queries();
    write_scene_results();
    write_definition_queries();
    write_definitions();
    write_statuses();
}
