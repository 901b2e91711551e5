/* Writes what fuzzing begins with into FOLDER/TARGET/: good messages of every type, each with
 * something in it that the others lack, short talks with the service, logs, and meshes. Texts of
 * scenes there are enough in the tree. */
#include "answer.h"
#include "definition.h"
#include "fuzz.h"
#include "hostile.h"
#include "log_draft.h"
#include "wire.h"

#include "fmb_msgs_pair_query_t.h"
#include "fmb_msgs_status_t.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char *folder;

static void write_seed(const char *target, const char *name, const unsigned char *bytes,
                       size_t size)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, target);
    mkdir(path, 0777); /* it may be there */
    snprintf(path, sizeof path, "%s/%s/%s", folder, target, name);
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0) {
        perror(path);
        exit(1);
    }
}

/* ---- Frames ---- */

/* [dim] */
static const double edges[][FMB_COMPONENTS_MAX] = {
    [2] = {1, 0, 0, 1},
    [3] = {1, 0, 0, 0, 1, 0, 0, 0, 1},
};

/* At x = y = z = at; moves along x where speed is not 0. */
static struct query_frame frame(int64_t id, int shape, int dim, double at, double speed)
{
    struct query_frame out = {.body_id = id, .shape = shape, .dim = dim};
    out.origin.count = dim;
    out.components.count = fmb_component_count(dim, shape) * dim;
    out.velocity.count = speed != 0 ? dim : 0;
    memcpy(out.components.number, edges[dim], (size_t) out.components.count * sizeof(double));
    for (int axis = 0; axis < dim; axis++)
        out.origin.number[axis] = at;
    out.velocity.number[0] = speed;
    return out;
}

static struct query_frame by_key(struct query_frame frame, int64_t key)
{
    frame.key = key;
    frame.components = (struct query_numbers){0};
    return frame;
}

/* ---- Pair queries ---- */

static struct pair_query pair(struct query_frame a, struct query_frame b, int32_t method,
                              int32_t want)
{
    static int64_t asked;
    return (struct pair_query){.utime = 1,
                               .client_id = 2,
                               .sequence_number = ++asked,
                               .duration = 1,
                               .method = method,
                               .want = want,
                               .frame = {a, b}};
}

enum { BOX = QUERY_WANT_BOX, CERTIFICATE = QUERY_WANT_CERTIFICATE, TIMES = QUERY_WANT_TIMES };

static const struct {
    const char *name;
    int shape[2], dim;
    double at, speed;
    int32_t method, want;
} pairs[] = {
    {"cubes", {FMB_CUBOID, FMB_CUBOID}, 3, 0.5, 0, 0, 0},
    {"touching", {FMB_CUBOID, FMB_TETRAHEDRON}, 3, 1, 0, 0, BOX},
    {"moving", {FMB_TETRAHEDRON, FMB_TETRAHEDRON}, 3, 0.25, -2, 4, BOX | CERTIFICATE},
    {"faces", {FMB_FACE, FMB_FACE}, 3, 0, 0, 1, BOX | CERTIFICATE},
    {"plate", {FMB_FACE, FMB_CUBOID}, 3, -0.5, 3, 0, BOX},
    {"apart", {FMB_CUBOID, FMB_CUBOID}, 3, 5, 0, 2, BOX},
    {"squares", {FMB_CUBOID, FMB_CUBOID}, 2, 0.5, 1, 3, 0},
    {"triangles", {FMB_TETRAHEDRON, FMB_TETRAHEDRON}, 2, 0.5, 0, 0, BOX | CERTIFICATE},
};
enum { PAIR_COUNT = sizeof pairs / sizeof *pairs };

static struct pair_query pair_number(size_t i)
{
    return pair(frame(1, pairs[i].shape[0], pairs[i].dim, 0, 0),
                frame(2, pairs[i].shape[1], pairs[i].dim, pairs[i].at, pairs[i].speed),
                pairs[i].method, pairs[i].want);
}

/* Lists that no frame has. */
static void write_long_lists(void)
{
    static double many[40];
    unsigned char bytes[HOSTILE_BYTES_MAX];
    fmb_msgs_frame_t a = {.dim = 12,
                          .origin = many,
                          .num_components = 9,
                          .components = many,
                          .num_velocity = 9,
                          .velocity = many};
    fmb_msgs_pair_query_t message = {.a = a};
    const int size = fmb_msgs_pair_query_t_encode(bytes, 0, sizeof bytes, &message);
    write_seed("pair_query", "long-lists", bytes, (size_t) size);
}

static void write_pair_queries(void)
{
    unsigned char bytes[HOSTILE_BYTES_MAX];
    write_seed("pair_query", "good", bytes, hostile_good("pair_query", bytes));
    write_long_lists();
    for (size_t i = 0; i < PAIR_COUNT; i++) {
        const struct pair_query query = pair_number(i);
        write_seed("pair_query", pairs[i].name, bytes, wire_write_pair_query(&query, bytes));
    }
}

/* ---- Pair results ---- */

static void write_pair_result(const char *name, const struct pair_result *result)
{
    static unsigned char bytes[WIRE_RESULT_BYTES_MAX];
    write_seed("pair_result", name, bytes, wire_write_pair_result(result, bytes));
}

static void write_pair_results(void)
{
    unsigned char bytes[HOSTILE_BYTES_MAX];
    write_seed("pair_result", "good", bytes, hostile_good("pair_result", bytes));
    struct pair_result result = {.utime = 1, .client_id = 2, .method = 4, .dim = 2};
    result.answer.verdict = FMB_OVERLAPPING;
    result.answer.has_box = result.answer.has_contact = true;
    result.answer.contact[1] = 0.5;
    result.answer.box[1][0] = HUGE_VAL;
    write_pair_result("box-2d", &result);
    result.answer.has_contact = false;
    result.certificate = "overlapping at 0 (1/2 1/3)";
    write_pair_result("certificate", &result);
    result = (struct pair_result){.status = FMB_BAD_ID, .detail = "client_id: not from 0"};
    write_pair_result("refused", &result);
    memset(result.detail, 'a', sizeof result.detail - 1);
    result.detail[7] = '\n';
    write_pair_result("long-detail", &result);
}

/* ---- Scene queries ---- */

static const struct scene_query *scene(int frames, int32_t which, int32_t want)
{
    static struct scene_query query;
    static int64_t asked = 100;
    const int dim = frames % 2 ? 2 : 3;
    memset(&query, 0, sizeof query);
    query.client_id = 2;
    query.sequence_number = ++asked;
    query.duration = 1;
    query.which = which;
    query.want = want;
    query.frame_count = frames;
    query.split = which == QUERY_PAIRS_ACROSS ? frames / 2 : 0;
    for (int i = 0; i < frames; i++)
        query.frame[i] = frame(i, 1 + i % dim, dim, i * 0.5, i % 3 == 2);
    query.index_count = which == QUERY_PAIRS_LISTED && frames > 0 ? 2 * (frames - 1) : 0;
    for (int i = 0; i < query.index_count / 2; i++) {
        query.pair[i][0] = (unsigned) i;
        query.pair[i][1] = (unsigned) i + 1;
    }
    return &query;
}

static void write_scene_query(const char *name, const struct scene_query *query)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    write_seed("scene_query", name, bytes, wire_write_scene_query(query, bytes));
}

static void write_scene_queries(void)
{
    write_scene_query("empty", scene(0, QUERY_PAIRS_ALL, 0));
    write_scene_query("listed", scene(4, QUERY_PAIRS_LISTED, BOX | TIMES));
    write_scene_query("all", scene(5, QUERY_PAIRS_ALL, BOX));
    write_scene_query("across", scene(6, QUERY_PAIRS_ACROSS, TIMES));
    struct scene_query *query = fuzz_room(sizeof *query);
    *query = *scene(1351, QUERY_PAIRS_ALL, 0);
    for (int i = 0; i < query->frame_count; i++)
        query->frame[i] = by_key(frame(i, FMB_CUBOID, 2, 0, 0), i + 1);
    write_scene_query("many-frames", query);
    query->which = QUERY_PAIRS_LISTED;
    query->frame_count = 2;
    query->index_count = 2000;
    for (int i = 0; i < query->index_count; i++)
        query->pair[i / 2][i % 2] = (unsigned) -i;
    write_scene_query("many-pairs", query);
    free(query);
}

/* ---- Scene results ---- */

static void write_scene_result(const char *name, const struct scene_result *result)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    write_seed("scene_result", name, bytes, wire_write_scene_result(result, bytes));
}

static void write_scene_results(void)
{
    static struct scene_result result = {.client_id = 2, .method = 4, .end_pair = 9};
    write_scene_result("empty", &result);
    result.verdict_count = 4;
    for (int i = 0; i < result.verdict_count; i++)
        result.verdict[i] = (unsigned char) i;
    result.contact_count = 2;
    result.has_times = true;
    result.times[0] = result.times[1] = NAN;
    write_scene_result("listed", &result);
    result.names_pairs = result.has_boxes = true;
    result.dim = 2;
    result.contact_count = result.verdict_count;
    for (int i = 0; i < result.verdict_count; i++) {
        result.verdict[i] = FMB_TOUCHING;
        result.pair[i][0] = (unsigned) i;
        result.pair[i][1] = (unsigned) (QUERY_FRAMES_MAX - result.verdict_count + i);
    }
    write_scene_result("named-2d", &result);
    result.dim = 3;
    result.key_count = 5;
    write_scene_result("named-3d", &result);
    result.verdict_count = 3000;
    memset(result.verdict, 0, sizeof result.verdict);
    result.names_pairs = result.has_boxes = result.has_times = false;
    result.contact_count = 0;
    write_scene_result("many", &result);
    result.verdict_count = 0;
    result.status = FMB_UNKNOWN_BODY;
    strcpy(result.detail, "frames: keys that are not held");
    write_scene_result("refused", &result);
}

/* ---- Heartbeats ---- */

static void write_statuses(void)
{
    unsigned char bytes[HOSTILE_BYTES_MAX];
    write_seed("status", "good", bytes, hostile_good("status", bytes));
    struct wire_status status = {.utime = 1, .server_id = 99, .version = "0.1.0", .waiting = 3};
    write_seed("status", "ours", bytes, wire_write_status(&status, bytes));
    char version[] = "10.20.30-with-a-long-name-that-goes-on\tand-on";
    int64_t many[40] = {3, 2, 1};
    fmb_msgs_status_t message = {
        .version = version, .num_results = 40, .results = many, .num_more = 9, .more = many};
    const int size = fmb_msgs_status_t_encode(bytes, 0, sizeof bytes, &message);
    write_seed("status", "newer", bytes, (size_t) size);
}

/* ---- Talks ---- */

static struct {
    unsigned char bytes[16384];
    size_t size;
} talk;

static void say(const unsigned char *bytes, size_t size)
{
    talk.bytes[talk.size++] = (unsigned char) (size >> 8);
    talk.bytes[talk.size++] = (unsigned char) size;
    memcpy(talk.bytes + talk.size, bytes, size);
    talk.size += size;
}

static void say_pair(struct pair_query query)
{
    unsigned char bytes[WIRE_BYTES_MAX];
    say(bytes, wire_write_pair_query(&query, bytes));
}

static void say_scene(const struct scene_query *query)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    say(bytes, wire_write_scene_query(query, bytes));
}

static void end_talk(const char *name)
{
    write_seed("answer", name, talk.bytes, talk.size);
    talk.size = 0;
}

/* The first key is 500. */
static void write_talks_about_keys(void)
{
    const struct query_frame cube = frame(1, FMB_CUBOID, 3, 0, 0);
    const struct query_frame other = frame(2, FMB_TETRAHEDRON, 3, 0.5, 1);
    say_pair(pair(cube, other, 0, BOX));
    say_pair(pair(by_key(cube, 500), by_key(other, 501), 0, BOX | CERTIFICATE));
    end_talk("keys");
    struct query_frame larger = cube;
    larger.components.number[0] = 2;
    say_pair(pair(cube, other, 0, 0));
    say_pair(pair(larger, other, 0, 0));
    say_pair(pair(by_key(cube, 500), other, 0, 0));
    end_talk("replaced");
    struct query_frame mirrored = cube;
    mirrored.components.number[8] = -1;
    say_pair(pair(cube, other, 0, BOX));
    say_pair(pair(mirrored, other, 0, BOX));
    end_talk("mirrored");
    say_pair(pair(cube, other, 0, 0));
    say_pair(pair(frame(3, FMB_CUBOID, 3, 0, 0), frame(4, FMB_FACE, 3, 0, 0), 0, 0));
    say_pair(pair(by_key(cube, 500), by_key(other, 501), 0, 0));
    end_talk("evicted");
}

static void write_talks_about_scenes(void)
{
    static const int32_t which[] = {QUERY_PAIRS_LISTED, QUERY_PAIRS_ALL, QUERY_PAIRS_ACROSS};
    static const char *const names[][2] = {
        {"listed", "listed-2d"}, {"all", "all-2d"}, {"across", "across-2d"}};
    for (int i = 0; i < 3; i++) {
        say_pair(pair_number(0));
        say_scene(scene(4, which[i], BOX | TIMES));
        end_talk(names[i][0]);
        say_scene(scene(5, which[i], TIMES));
        say_pair(pair(by_key(frame(1, FMB_TETRAHEDRON, 2, 0, 0), 500),
                      by_key(frame(2, FMB_CUBOID, 2, 0, 0), 501), 0, 0));
        end_talk(names[i][1]);
    }
    struct scene_query *query = fuzz_room(sizeof *query);
    *query = *scene(4, QUERY_PAIRS_LISTED, BOX);
    say_scene(query);
    query->method = 2;
    query->first_pair = 1;
    for (int i = 1; i < 4; i++)
        query->frame[i] = by_key(query->frame[i], 499 + i);
    say_scene(query);
    end_talk("scene-keys");
    free(query);
}

static void write_talks(void)
{
    for (size_t i = 0; i < PAIR_COUNT; i++) {
        say_pair(pair_number(i));
        end_talk(pairs[i].name);
    }
    write_talks_about_keys();
    write_talks_about_scenes();
}

/* ---- Logs, as large as log_pieces.h makes it worth while ---- */

static struct {
    unsigned char bytes[1024];
    size_t size;
} file;

static void log_bytes(const void *bytes, size_t size)
{
    memcpy(file.bytes + file.size, bytes, size);
    file.size += size;
}

/* Of lengths below 256. */
static void log_header(unsigned char channel, unsigned char data)
{
    const unsigned char header[28] = {
        0xed, 0xa1, 0xda, 0x01, [11] = 1, [19] = 2, [23] = channel, [27] = data};
    log_bytes(header, sizeof header);
}

static void log_event(const char *channel, unsigned char size)
{
    const char data[255] = "data";
    log_header((unsigned char) strlen(channel), size);
    log_bytes(channel, strlen(channel));
    log_bytes(data, size);
}

static void end_log(const char *name)
{
    write_seed("event_log", name, file.bytes, file.size);
    file.size = 0;
}

static void write_broken_logs(void)
{
    log_event("A", 4);
    log_bytes("garbage", 7);
    log_event("B", 5);
    log_bytes("garbage that takes more than what is kept, and another line", 59);
    log_event("C", 6);
    end_log("garbage");
    log_event("A", 4);
    log_header(1, 20); /* within the buffer */
    log_event("B", 0);
    log_header(1, 99);
    log_event("B", 4);
    log_header(0, 4);
    log_event("C", 4);
    log_header(8, 4);
    log_bytes("TOO_LONGdata", 12);
    log_event("C", 4);
    log_header(1, 5);
    file.bytes[file.size - 4] = 0x80; /* a negative size */
    log_event("C", 4);
    log_header(1, 5);
    end_log("lies");
    static const char hole[200];
    log_event("A", 4);
    log_bytes(hole, sizeof hole);
    log_event("B", 4);
    end_log("hole");
}

static void write_logs(void)
{
    end_log("empty");
    log_event("A", 0);
    log_event("LONGEST", 16);
    log_event("KEPT", 17);
    log_event("MORE", 100);
    log_event("LAST", 1);
    end_log("good");
    for (unsigned char size = 0; size < 17; size++) /* at all places of the buffer */
        log_event(&"CHANNEL"[size % 7], size);
    end_log("sizes");
    for (unsigned char size = 0; size < 17; size++) {
        log_event(&"CHANNEL"[size % 7], size);
        log_bytes("garbage that goes on", 1 + 3 * size % 20);
    }
    end_log("damages");
    log_header(1, 1 + 2 * 33);
    log_bytes("A", 1);
    log_event("B", 4);
    log_event("C", 4);
    log_bytes("x", 1);
    log_event("D", 4);
    end_log("nested");
    write_broken_logs();
}

/* ---- Meshes: a triangle or two, in all that is written differently -------------------------- */

static void mesh_bytes(const char *text)
{
    log_bytes(text, strlen(text));
}

static void end_mesh(const char *name)
{
    write_seed("mesh", name, file.bytes, file.size);
    file.size = 0;
}

static void mesh_number(uint64_t bits, int size, bool big_endian)
{
    for (int i = 0; i < size; i++) {
        const unsigned char byte = (unsigned char) (bits >> 8 * (big_endian ? size - 1 - i : i));
        log_bytes(&byte, 1);
    }
}

static void mesh_float(float value, bool big_endian)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    mesh_number(bits, sizeof bits, big_endian);
}

static void write_ply_texts(void)
{
    mesh_bytes(
        "ply\nformat ascii 1.0\ncomment of a few\nelement vertex 4\nproperty float x\n"
        "property float y\nproperty float z\nproperty float confidence\nelement face 2\n"
        "property list uchar int vertex_indices\nend_header\n0 0 0 1\n1e308 -1e308 1e-3 nan\n"
        "0 1 0 0.5 \n+.5 0. 12345678901234567890 inf\n3 0 1 2\n3 3 2 1\n");
    end_mesh("ply-ascii");
    mesh_bytes(
        "ply\r\nformat ascii 1.0\r\nobj_info x\r\nelement face 1\r\nproperty uchar red\r\n"
        "property list uint8 uint32 vertex_index\r\nproperty list int8 float64 texcoord\r\n"
        "element vertex 3\r\nproperty int16 z\r\nproperty float32 x\r\nproperty double y\r\n"
        "element edge 2\r\nproperty int a\r\nelement empty 1000000\r\nend_header\r\n"
        "255 3 0 1 2 2 0.5 1\r\n3 1 2\r\n-3 1e308 1e-22\r\n0 9007199254740993 4.9e-324\r\n"
        "1\r\n2\r\n");
    end_mesh("ply-order");
    mesh_bytes("ply\nformat ascii 1.0\nelement vertex 0\nend_header\n");
    end_mesh("ply-empty");
}

static void write_ply_binaries(bool big_endian)
{
    mesh_bytes("ply\nformat ");
    mesh_bytes(big_endian ? "binary_big_endian" : "binary_little_endian");
    mesh_bytes(
        " 1.0\nelement other 2\nproperty list ushort short a\nproperty char b\n"
        "element vertex 3\nproperty float x\nproperty int y\nproperty ushort z\n"
        "element face 2\nproperty list uchar uchar vertex_indices\n"
        "property list int float texcoord\nend_header\n");
    for (int i = 0; i < 2; i++) {
        mesh_number((uint64_t) i, 2, big_endian);
        mesh_number(0xfffe, 2 * i, big_endian);
        mesh_number(0x80, 1, big_endian);
    }
    for (int i = 0; i < 3; i++) {
        mesh_float((float) i / 3, big_endian);
        mesh_number((uint64_t) -i, 4, big_endian);
        mesh_number(60000, 2, big_endian);
    }
    for (int i = 0; i < 2; i++) {
        mesh_number(0x03000102, 4, true);
        mesh_number((uint64_t) i, 4, big_endian);
        mesh_number(0x7fc00000, 4 * i, big_endian);
    }
    end_mesh(big_endian ? "ply-be" : "ply-le");
}

static void write_ply_lists(void)
{
    mesh_bytes(
        "ply\nformat binary_big_endian 1.0\nelement a 9\nproperty list uchar ushort b\n"
        "end_header\n");
    for (int i = 0; i < 9; i++)
        mesh_number(0x012345, 3, true);
    end_mesh("ply-lists");
}

static void write_stls(void)
{
    static const char head[80] = "solid, and yet binary";
    mesh_bytes(
        "solid a name\n facet normal 0 0 nan\n  outer loop\n   vertex 0 0 0\n"
        "   vertex 1 0 0\n   vertex 0 1e308 -0\n  endloop\n endfacet\nFACET NORMAL 0 0 1 "
        "OUTER LOOP VERTEX 1 0 0 VERTEX 0 1 0 VERTEX 1 1 0 ENDLOOP ENDFACET\n"
        "endsolid a name\nsolid\nendsolid\n");
    end_mesh("stl-ascii");
    log_bytes(head, sizeof head);
    mesh_number(3, 4, false);
    for (int facet = 0; facet < 3; facet++) {
        for (int number = 0; number < 12; number++)
            mesh_float((float) (number * facet % 5) / -4, false);
        mesh_number(0x7fff, 2, false);
    }
    end_mesh("stl-binary");
}

static void write_objs(void)
{
    mesh_bytes(
        "# a mesh\nmtllib a.mtl\no a\nv 0 0 0\nv 1 0 0 1\nv 0 1 0 0.5 0.5 0.5\n"
        "v 1 \\\n 1 \\\r\n 0 1 1 1 1 # of seven\nvt 0 0\nvn 0 0 1\ng\ns off\nusemtl b\n"
        "f 1 2 3\nf 4/1 3/1 2/1\nf 1//1 2//1 4//1\nf -4/1/1 -1/1/1 \\\n-2/-1/-1\n"
        "f 5 1 2\nv -1e308 .5 5.\nl 1 2\np 1\ncstype bezier\n");
    end_mesh("obj");
}

static void write_meshes(void)
{
    write_ply_texts();
    write_ply_binaries(false);
    write_ply_binaries(true);
    write_ply_lists();
    write_stls();
    write_objs();
}

/* ---- Logs that are replayed ---- */

static struct log_draft replayed;
static struct answerer service;

static void end_replayed(const char *name)
{
    write_seed("replay_log", name, replayed.bytes, replayed.size);
    log_draft_free(&replayed);
    cache_destroy(service.cache);
    service.cache = cache_create(8, 1);
}

static void ask_pair(struct pair_query query)
{
    unsigned char bytes[WIRE_BYTES_MAX];
    log_draft_event(&replayed, WIRE_PAIR_QUERY, 1000, bytes, wire_write_pair_query(&query, bytes));
}

static void log_pair_result(struct pair_query query, int32_t status, bool right)
{
    static unsigned char bytes[WIRE_RESULT_BYTES_MAX];
    struct pair_result result;
    if (status == FMB_OK)
        answer_pair(&service, &query, &result);
    else
        answer_pair_refused(&service, &query, (enum fmb_status) status, &result);
    if (!right)
        result.answer.verdict = FMB_TOUCHING;
    log_draft_event(&replayed, WIRE_PAIR_RESULT, 1000, bytes,
                    wire_write_pair_result(&result, bytes));
}

static void ask_scene(const struct scene_query *query)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    static struct scene_result result;
    log_draft_event(&replayed, WIRE_SCENE_QUERY, 1000, bytes, wire_write_scene_query(query, bytes));
    answer_scene(&service, query, &result);
    log_draft_event(&replayed, WIRE_SCENE_RESULT, 1000, bytes,
                    wire_write_scene_result(&result, bytes));
}

/* More than there is memory for in a small replay. */
enum { APART = 6 };

static void write_replays_of_order(void)
{
    const struct pair_query one = pair_number(1), two = pair_number(2), three = pair_number(6);
    ask_pair(one);
    log_pair_result(one, FMB_OK, true);
    ask_pair(two);
    log_pair_result(two, FMB_OK, false);
    end_replayed("pairs");
    ask_pair(one);
    ask_pair(two);
    log_pair_result(three, FMB_OK, true);
    log_pair_result(two, FMB_OK, true);
    ask_pair(three);
    log_pair_result(one, FMB_OK, true);
    end_replayed("out-of-order");
    struct pair_query many[APART];
    for (size_t i = 0; i < APART; i++)
        ask_pair(many[i] = pair_number(i));
    for (size_t i = 0; i < APART; i++)
        log_pair_result(many[i], FMB_OK, i != 1);
    end_replayed("apart");
    ask_pair(one);
    ask_pair(one);
    log_pair_result(one, FMB_BUSY, true);
    log_pair_result(one, FMB_OK, true);
    log_pair_result(one, FMB_OK, false);
    end_replayed("again");
}

/* As the cache of a replay gives them too. */
static void write_replays_of_keys(void)
{
    const struct query_frame cube = frame(1, FMB_CUBOID, 3, 0, 0);
    const struct query_frame other = frame(2, FMB_TETRAHEDRON, 3, 0.5, 0);
    const struct pair_query whole = pair(cube, other, 0, 0);
    struct pair_query keys = pair(by_key(cube, 1), by_key(other, 2), 0, BOX);
    ask_pair(whole);
    log_pair_result(whole, FMB_OK, true);
    ask_pair(keys);
    log_pair_result(keys, FMB_OK, true);
    end_replayed("keys");
    ask_pair(keys);
    ask_pair(whole);
    log_pair_result(whole, FMB_OK, true);
    log_pair_result(keys, FMB_OK, true);
    end_replayed("keys-before");
    ask_pair(keys);
    log_pair_result(keys, FMB_OK, true);
    keys.frame[0].components = cube.components;
    ask_pair(keys);
    end_replayed("keys-unknown");
    struct scene_query *definition = fuzz_room(sizeof *definition);
    definition_begin(definition);
    definition_add(definition, &keys.frame[1], &other.components);
    ask_scene(definition);
    ask_pair(keys);
    keys.frame[1] = other;
    log_pair_result(keys, FMB_OK, true);
    end_replayed("keys-defined");
    free(definition);
}

static void write_replays_of_scenes(void)
{
    static const int32_t which[] = {QUERY_PAIRS_LISTED, QUERY_PAIRS_ALL, QUERY_PAIRS_ACROSS};
    static const char *const names[] = {"scenes-listed", "scenes-all", "scenes-across"};
    for (int i = 0; i < 3; i++) {
        ask_scene(scene(4, which[i], BOX | TIMES));
        ask_scene(scene(5, which[i], 0));
        end_replayed(names[i]);
    }
}

static void write_replays_of_damage(void)
{
    const struct pair_query one = pair_number(1);
    unsigned char begin[100];
    ask_pair(one);
    memcpy(begin, replayed.bytes, sizeof begin);
    log_draft_raw(&replayed, "any bytes", 9);
    log_pair_result(one, FMB_OK, true);
    log_draft_event(&replayed, WIRE_STATUS, 1000, "any bytes", 9);
    log_draft_event(&replayed, WIRE_PAIR_QUERY, INT64_MIN, "any bytes", 9);
    log_draft_event(&replayed, "POSE", INT64_MAX, begin, sizeof begin);
    ask_pair(one);
    replayed.size -= 7;
    end_replayed("damage");
}

static void write_replays(void)
{
    service.cache = cache_create(8, 1);
    if (!service.cache || !answer_prepare(&service)) {
        fprintf(stderr, "out of memory\n");
        exit(1);
    }
    write_replays_of_order();
    write_replays_of_keys();
    write_replays_of_scenes();
    write_replays_of_damage();
    cache_destroy(service.cache);
    answer_release(&service);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
        return 2;
    }
    folder = argv[1];
    write_pair_queries();
    write_pair_results();
    write_scene_queries();
    write_scene_results();
    write_statuses();
    write_talks();
    write_logs();
    write_meshes();
    write_replays();
    return 0;
}
