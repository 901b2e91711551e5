#include "seeds.h"

#include "answer_now.h"
#include "fuzz.h"
#include "log_draft.h"
#include "wire.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum {
    BOX = FMB_WANT_BOX,
    CERTIFICATE = FMB_WANT_CERTIFICATE,
    TIMES = FMB_WANT_TIMES,
    GAP = FMB_WANT_GAP
};

static unsigned char bytes[QUERY_BYTES_MAX];

/* ---- Talks: queries one after the other, each with its size in two bytes ---- */

static struct {
    unsigned char bytes[16384];
    size_t size;
} talk;

static void add_query(size_t size)
{
    FUZZ_CHECK(size <= UINT16_MAX && talk.size + 2 + size <= sizeof talk.bytes);
    talk.bytes[talk.size++] = (unsigned char) (size >> 8);
    talk.bytes[talk.size++] = (unsigned char) size;
    memcpy(talk.bytes + talk.size, bytes, size);
    talk.size += size;
}

static void add_pair(struct pair_query query)
{
    add_query(wire_write_pair_query(&query, bytes));
}

static void add_scene(const struct scene_query *query)
{
    add_query(wire_write_scene_query(query, bytes));
}

static void add_definitions(const struct query_placement *placement)
{
    static struct definition_query query = {.client_id = 2, .sequence_number = 300};
    query.sequence_number++;
    query.handle_count = placement ? 1 : 0;
    if (placement)
        query.handle[0] = seeds_handle(placement);
    add_query(wire_write_definition_query(&query, bytes));
}

static void end_talk(const char *name)
{
    seeds_write("answer", name, talk.bytes, talk.size);
    talk.size = 0;
}

static void write_talks_about_handles(void)
{
    const double larger[] = {2, 0, 0, 0, 1, 0, 0, 0, 1}, mirrored[] = {1, 0, 0, 0, 1, 0, 0, 0, -1};
    const double last_bit[] = {1, 0, 0, 0, 1, 0, 0, 0, 1 + 0x1p-52};
    const struct query_placement cube = seeds_placement(1, FMB_CUBOID, 3, 0, 0);
    const struct query_placement other = seeds_placement(2, FMB_TETRAHEDRON, 3, 0.5, 1);
    const struct query_placement by_handle = seeds_by_handle(cube);
    add_pair(seeds_pair(cube, other, 0, BOX));
    add_pair(seeds_pair(by_handle, seeds_by_handle(other), 0, BOX | CERTIFICATE));
    end_talk("handles");
    add_pair(seeds_pair(cube, other, 0, 0));
    add_pair(seeds_pair(seeds_body(1, FMB_CUBOID, 3, larger), other, 0, 0));
    add_pair(seeds_pair(by_handle, other, 0, 0));
    end_talk("two-bodies-of-an-id");
    add_pair(seeds_pair(cube, other, 0, BOX));
    add_pair(seeds_pair(seeds_body(1, FMB_CUBOID, 3, mirrored), other, 0, BOX));
    end_talk("mirrored");
    add_pair(seeds_pair(cube, other, 0, BOX));
    add_pair(seeds_pair(seeds_body(1, FMB_CUBOID, 3, last_bit), other, 0, BOX));
    end_talk("last-bit");
    struct query_placement flat = seeds_by_handle(seeds_placement(5, FMB_CUBOID, 2, 0, 0));
    flat.body.dim = cube.body.dim;
    flat.body = by_handle.body;
    add_pair(seeds_pair(seeds_placement(5, FMB_CUBOID, 2, 0, 0),
                        seeds_placement(6, FMB_CUBOID, 2, 0, 0), 0, 0));
    add_pair(seeds_pair(cube, flat, 0, 0));
    end_talk("handle-of-the-other-dimension");
    add_pair(seeds_pair(cube, other, 0, 0));
    add_pair(seeds_pair(seeds_body(3, FMB_CUBOID, 3, larger), seeds_placement(4, FMB_FACE, 3, 0, 0),
                        0, 0));
    add_pair(seeds_pair(by_handle, seeds_by_handle(other), 0, 0));
    end_talk("evicted");
    add_pair(seeds_pair(cube, other, 0, 0));
    add_definitions(&cube);
    add_definitions(NULL);
    end_talk("definitions");
}

static void write_talks_about_gaps(void)
{
    static const int32_t which[] = {FMB_PAIRS_LISTED, FMB_PAIRS_ALL, FMB_PAIRS_ACROSS};
    struct scene_query *query = fuzz_room(sizeof *query);
    for (int shape = FMB_CUBOID; shape <= FMB_FACE; shape++)
        add_pair(seeds_pair(seeds_placement(1, shape, 3, 0, 0),
                            seeds_placement(2, FMB_CUBOID, 3, shape, shape % 2 ? -0.5 : 0), 0,
                            GAP | (shape % 2 ? BOX : CERTIFICATE)));
    end_talk("gaps");
    for (int i = 0; i < 3; i++) {
        *query = *seeds_scene(4, which[i], i == 0 ? GAP | BOX : TIMES);
        query->margin = 0.75 * i;
        add_scene(query);
    }
    end_talk("margins");
    free(query);
}

static void write_talks_about_scenes(void)
{
    static const int32_t which[] = {FMB_PAIRS_LISTED, FMB_PAIRS_ALL, FMB_PAIRS_ACROSS};
    static const char *const names[][2] = {
        {"listed", "listed-2d"}, {"all", "all-2d"}, {"across", "across-2d"}};
    for (int i = 0; i < 3; i++) {
        add_pair(seeds_pair_number(0));
        add_scene(seeds_scene(4, which[i], BOX | TIMES));
        end_talk(names[i][0]);
        add_scene(seeds_scene(5, which[i], TIMES));
        add_pair(seeds_pair(seeds_by_handle(seeds_placement(1, FMB_TETRAHEDRON, 2, 0, 0)),
                            seeds_by_handle(seeds_placement(2, FMB_CUBOID, 2, 0, 0)), 0, 0));
        end_talk(names[i][1]);
    }
    struct scene_query *query = fuzz_room(sizeof *query);
    *query = *seeds_scene(4, FMB_PAIRS_LISTED, BOX);
    add_scene(query);
    query->method = 2;
    query->first_pair = 1;
    for (int i = 1; i < 4; i++)
        query->placement[i] = seeds_by_handle(query->placement[i]);
    add_scene(query);
    end_talk("scene-handles");
    free(query);
}

void seeds_talks(void)
{
    for (int i = 0; i < SEEDS_PAIRS; i++) {
        add_pair(seeds_pair_number(i));
        end_talk(seeds_pair_name(i));
    }
    write_talks_about_handles();
    write_talks_about_scenes();
    write_talks_about_gaps();
}

/* ---- Logs that are replayed ---- */

static struct log_draft replayed;
static struct answerer *service;

static void begin_service(void)
{
    const struct answerer_options options = {.frames = 8, .server_id = 99};
    service = answerer_create(&options);
    FUZZ_CHECK(service);
}

static void end_replayed(const char *name)
{
    seeds_write("replay_log", name, replayed.bytes, replayed.size);
    log_draft_free(&replayed);
    answerer_destroy(service);
    begin_service();
}

static void log_event(const char *channel, size_t size)
{
    log_draft_event(&replayed, channel, 1000, bytes, size);
}

static void log_pair(struct pair_query query)
{
    log_event(WIRE_PAIR_QUERY, wire_write_pair_query(&query, bytes));
}

static void log_pair_result(struct pair_query query, int32_t status, bool right)
{
    struct pair_result result;
    if (status == FMB_OK)
        answer_pair(service, &query, &result);
    else
        answer_pair_refused(service, &query, (enum fmb_status) status, &result);
    if (!right)
        result.answer.verdict = FMB_TOUCHING;
    log_event(WIRE_PAIR_RESULT, wire_write_pair_result(&result, bytes));
}

static void log_scene(const struct scene_query *query)
{
    struct answer_job *job = answer_job_create();
    FUZZ_CHECK(job);
    const size_t size = wire_write_scene_query(query, bytes);
    log_event(WIRE_SCENE_QUERY, size);
    FUZZ_CHECK(!answer_job_begin(job, ANSWER_SCENE, bytes, size));
    while (!answer_job_step(job, service))
        continue;
    log_event(WIRE_SCENE_RESULT, wire_write_scene_result(answer_job_scene_result(job), bytes));
    answer_job_destroy(job);
}

/* All that the service holds, as a recorder writes it. */
static void log_definitions(void)
{
    static const struct definition_query query = {.client_id = 3, .sequence_number = 1};
    static struct definition definition;
    answer_definition(service, &query, &definition);
    log_event(WIRE_DEFINITION, wire_write_definition(&definition, bytes));
}

/* More than a small replay has memory for. */
enum { APART = 6 };

static void write_replays_of_order(void)
{
    const struct pair_query one = seeds_pair_number(1), two = seeds_pair_number(2),
                            three = seeds_pair_number(6);
    log_pair(one);
    log_pair_result(one, FMB_OK, true);
    log_pair(two);
    log_pair_result(two, FMB_OK, false);
    end_replayed("pairs");
    log_pair(one);
    log_pair(two);
    log_pair_result(three, FMB_OK, true);
    log_pair_result(two, FMB_OK, true);
    log_pair(three);
    log_pair_result(one, FMB_OK, true);
    end_replayed("out-of-order");
    struct pair_query many[APART];
    for (int i = 0; i < APART; i++)
        log_pair(many[i] = seeds_pair_number(i));
    for (int i = 0; i < APART; i++)
        log_pair_result(many[i], FMB_OK, i != 1);
    end_replayed("apart");
    log_pair(one);
    log_pair(one);
    log_pair_result(one, FMB_BUSY, true);
    log_pair_result(one, FMB_OK, true);
    log_pair_result(one, FMB_OK, false);
    end_replayed("again");
}

static void write_replays_of_handles(void)
{
    const struct query_placement cube = seeds_placement(1, FMB_CUBOID, 3, 0, 0);
    const struct query_placement other = seeds_placement(2, FMB_TETRAHEDRON, 3, 0.5, 0);
    const struct pair_query whole = seeds_pair(cube, other, 0, 0);
    const struct pair_query handles =
        seeds_pair(seeds_by_handle(cube), seeds_by_handle(other), 0, BOX);
    log_pair(whole);
    log_pair_result(whole, FMB_OK, true);
    log_pair(handles);
    log_pair_result(handles, FMB_OK, true);
    end_replayed("handles");
    log_pair(handles);
    log_pair(whole);
    log_pair_result(whole, FMB_OK, true);
    log_pair_result(handles, FMB_OK, true);
    end_replayed("handles-before");
    log_pair(handles);
    log_pair_result(handles, FMB_OK, true);
    end_replayed("handles-unknown");
    struct pair_result result;
    answer_pair(service, &whole, &result);
    log_definitions();
    log_pair(handles);
    log_pair_result(handles, FMB_OK, true);
    end_replayed("handles-defined");
}

static void write_replays_of_scenes(void)
{
    static const int32_t which[] = {FMB_PAIRS_LISTED, FMB_PAIRS_ALL, FMB_PAIRS_ACROSS};
    static const char *const names[] = {"scenes-listed", "scenes-all", "scenes-across"};
    for (int i = 0; i < 3; i++) {
        log_scene(seeds_scene(4, which[i], BOX | TIMES));
        log_scene(seeds_scene(5, which[i], i == 1 ? GAP : 0));
        end_replayed(names[i]);
    }
}

static void write_replays_of_damage(void)
{
    const struct pair_query one = seeds_pair_number(1);
    unsigned char begin[100];
    log_pair(one);
    memcpy(begin, replayed.bytes, sizeof begin);
    log_draft_raw(&replayed, "any bytes", 9);
    log_pair_result(one, FMB_OK, true);
    log_draft_event(&replayed, WIRE_STATUS, 1000, "any bytes", 9);
    log_draft_event(&replayed, WIRE_PAIR_QUERY, INT64_MIN, "any bytes", 9);
    log_draft_event(&replayed, "POSE", INT64_MAX, begin, sizeof begin);
    log_pair(one);
    replayed.size -= 7;
    end_replayed("damage");
}

void seeds_replays(void)
{
    begin_service();
    write_replays_of_order();
    write_replays_of_handles();
    write_replays_of_scenes();
    write_replays_of_damage();
    answerer_destroy(service);
}
