#include "hostile.h"

#include "fmb_msgs_body_t.h"
#include "fmb_msgs_definition_query_t.h"
#include "fmb_msgs_definition_t.h"
#include "fmb_msgs_names_t.h"
#include "fmb_msgs_pair_query_t.h"
#include "fmb_msgs_pair_result_t.h"
#include "fmb_msgs_scene_query_t.h"
#include "fmb_msgs_scene_result_t.h"
#include "fmb_msgs_status_t.h"

#include <glib.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Layouts, after the fingerprint: l 8 bytes, i 4 bytes, n a count and its numbers of 8 bytes, h a
 * count and its numbers of 2, m of 4, b a count and its bytes, d a dimension, c as many numbers as
 * the last dimension says, f a count and its placements, o a count and its bodies, s a string, p
 * one that is printable, v a count, as many strings, and as many numbers of 8 bytes; w the same
 * with two such lists of numbers, which come first. */
#define PLACEMENT "llldbmnslcnnn"
#define BODY "lldbmn"
static const struct {
    const char *type, *layout;
} layouts[] = {
    {"pair_query", "llllii" PLACEMENT PLACEMENT},
    {"pair_result", "llllllllllisiinnnnnnhpl"},
    {"scene_query", "lllsliiliiifhh"},
    {"scene_result", "llllisihbibhnnnnnnhl"},
    {"definition_query", "llllb"},
    {"definition", "llllislo"},
    {"status", "llsv"},
    {"names", "lw"},
};

static const char *layout_of(const char *type)
{
    const char *layout = NULL;
    for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++)
        if (strcmp(layouts[i].type, type) == 0)
            layout = layouts[i].layout;
    if (!layout) {
        fprintf(stderr, "hostile: unknown type %s\n", type);
        exit(2);
    }
    return layout;
}

/* A cube at the origin of its body. */
static uint8_t shapes[1] = {FMB_MSGS_PLACEMENT_T_SHAPE_CUBOID};
static double cube[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};

static fmb_msgs_placement_t good_placement(void)
{
    static char name[] = "b\xc3\xb6x";
    static double position[3] = {0.5, -1, 2}, velocity[3] = {1, 0, -0.25}, end[3] = {3, 2, 1};
    return (fmb_msgs_placement_t){.body_id = 7,
                                  .dim = 3,
                                  .num_frames = 1,
                                  .shapes = shapes,
                                  .num_numbers = 12,
                                  .numbers = cube,
                                  .name = name,
                                  .position = position,
                                  .num_velocity = 3,
                                  .velocity = velocity,
                                  .num_end_pose = 0,
                                  .end_pose = end};
}

static size_t good_pair_query(unsigned char *out)
{
    fmb_msgs_placement_t body = good_placement();
    fmb_msgs_pair_query_t query = {
        .utime = 1, .client_id = 2, .sequence_number = 3, .duration = 1, .a = body, .b = body};
    return (size_t) fmb_msgs_pair_query_t_encode(out, 0, HOSTILE_BYTES_MAX, &query);
}

static size_t good_pair_result(unsigned char *out)
{
    char detail[] = "", certificate[] = "touching normal (1 0 0) at 0 a 1 b 0";
    double contact[2] = {0, 0.5}, box[6] = {0, 0, 0, 1, 1, 1}, gap[2] = {0}, direction[3] = {0, 1};
    double point[4] = {0.5, 1, 1, 0};
    fmb_msgs_pair_result_t result = {.client_id = 2,
                                     .detail = detail,
                                     .method = FMB_MSGS_PAIR_QUERY_T_METHOD_EXACT,
                                     .verdict = FMB_MSGS_PAIR_RESULT_T_VERDICT_TOUCHING,
                                     .num_contact = 2,
                                     .contact = contact,
                                     .num_box = 6,
                                     .box = box,
                                     .num_point = 4,
                                     .point = point,
                                     .num_gap = 2,
                                     .gap = gap,
                                     .num_direction = 3,
                                     .direction = direction,
                                     .certificate = certificate};
    return (size_t) fmb_msgs_pair_result_t_encode(out, 0, HOSTILE_BYTES_MAX, &result);
}

/* The last body comes by its handle. */
static size_t good_scene_query(unsigned char *out)
{
    char label[] = "shelf", none[] = "";
    int16_t index[4] = {0, 1, 2, 1};
    fmb_msgs_placement_t placements[3] = {good_placement(), good_placement(), good_placement()};
    memset(placements[2].handle, 0xa5, sizeof placements[2].handle);
    placements[2].name = none;
    placements[2].num_frames = placements[2].num_numbers = placements[2].num_velocity = 0;
    placements[2].num_end_pose = 3;
    fmb_msgs_scene_query_t query = {.client_id = 2,
                                    .sequence_number = 3,
                                    .label = label,
                                    .duration = 1,
                                    .want = FMB_MSGS_PAIR_QUERY_T_WANT_BOX,
                                    .which = FMB_MSGS_SCENE_QUERY_T_PAIRS_LISTED,
                                    .margin = 0.25,
                                    .num_placements = 3,
                                    .placements = placements,
                                    .num_indices = 4,
                                    .indices = index};
    return (size_t) fmb_msgs_scene_query_t_encode(out, 0, HOSTILE_BYTES_MAX, &query);
}

static size_t good_scene_result(unsigned char *out)
{
    char detail[] = "";
    uint8_t handles[32] = {1, 2, 3};
    uint8_t verdicts[3] = {FMB_MSGS_PAIR_RESULT_T_VERDICT_TOUCHING,
                           FMB_MSGS_PAIR_RESULT_T_VERDICT_OVERLAPPING,
                           FMB_MSGS_PAIR_RESULT_T_VERDICT_SEPARATED};
    int16_t indices[6] = {0, 1, 0, 2, 1, 2};
    double gaps[6] = {0, 0, -0.5, -0.25, 1, 1}, directions[9] = {1, 0, 0, 0, -1, 0, 1, 0, 0};
    double witnesses[21];
    int16_t frames[6] = {0, 1, 2, 0, 1, 1};
    for (int i = 0; i < 21; i++)
        witnesses[i] = i < 14 ? NAN : i - 14;
    double times[4] = {0, 0.5, 0.25, 0.25}, boxes[12] = {0, 0, 0, 1, 1, 1, -1, 2, 0, 1, 2, 3};
    double points[8] = {0, 1, 1, 1, 0.25, -1, 3, 0};
    fmb_msgs_scene_result_t result = {.client_id = 2,
                                      .detail = detail,
                                      .method = FMB_MSGS_PAIR_QUERY_T_METHOD_CERTIFIED,
                                      .num_handle_bytes = 32,
                                      .handles = handles,
                                      .end_pair = 3,
                                      .num_verdicts = 3,
                                      .verdicts = verdicts,
                                      .num_indices = 6,
                                      .indices = indices,
                                      .num_times = 4,
                                      .times = times,
                                      .num_boxes = 12,
                                      .boxes = boxes,
                                      .num_points = 8,
                                      .points = points,
                                      .num_gaps = 6,
                                      .gaps = gaps,
                                      .num_directions = 9,
                                      .directions = directions,
                                      .num_witnesses = 21,
                                      .witnesses = witnesses,
                                      .num_gap_frames = 6,
                                      .gap_frames = frames};
    return (size_t) fmb_msgs_scene_result_t_encode(out, 0, HOSTILE_BYTES_MAX, &result);
}

static size_t good_definition_query(unsigned char *out)
{
    uint8_t handles[32] = {1, 2, 3};
    fmb_msgs_definition_query_t query = {
        .client_id = 2, .sequence_number = 3, .num_handle_bytes = 32, .handles = handles};
    return (size_t) fmb_msgs_definition_query_t_encode(out, 0, HOSTILE_BYTES_MAX, &query);
}

/* The handle of a body: the SHA-256 of what follows its handle and its fingerprint. */
static void set_handle(fmb_msgs_body_t *body)
{
    unsigned char bytes[512];
    guint8 digest[32];
    gsize length = sizeof digest;
    const int size = fmb_msgs_body_t_encode(bytes, 0, sizeof bytes, body);
    const int fields_at = 8 + (int) sizeof body->handle;
    GChecksum *sha256 = g_checksum_new(G_CHECKSUM_SHA256);
    g_checksum_update(sha256, bytes + fields_at, size - fields_at);
    g_checksum_get_digest(sha256, digest, &length);
    g_checksum_free(sha256);
    memcpy(body->handle, digest, sizeof body->handle);
}

static size_t good_definition(unsigned char *out)
{
    char detail[] = "";
    fmb_msgs_body_t bodies[2] = {
        {.dim = 3, .num_frames = 1, .shapes = shapes, .num_numbers = 12, .numbers = cube},
        {.dim = 2, .num_frames = 1, .shapes = shapes, .num_numbers = 6, .numbers = cube}};
    for (int i = 0; i < 2; i++)
        set_handle(&bodies[i]);
    fmb_msgs_definition_t definition = {
        .client_id = 2, .detail = detail, .next = 5, .num_bodies = 2, .bodies = bodies};
    return (size_t) fmb_msgs_definition_t_encode(out, 0, HOSTILE_BYTES_MAX, &definition);
}

static size_t good_status(unsigned char *out)
{
    char version[] = "1.2.3";
    char received[] = "received", result[] = "result_OK";
    char *names[2] = {received, result};
    int64_t values[2] = {5, 1};
    fmb_msgs_status_t status = {
        .utime = 1, .version = version, .num_counters = 2, .names = names, .values = values};
    return (size_t) fmb_msgs_status_t_encode(out, 0, HOSTILE_BYTES_MAX, &status);
}

static size_t good_names(unsigned char *out)
{
    char table[] = "table", none[] = "";
    char *names[2] = {table, none};
    int64_t ids[2] = {5, 1};
    fmb_msgs_names_t message = {
        .utime = 1, .num_names = 2, .client_ids = ids, .body_ids = ids, .names = names};
    return (size_t) fmb_msgs_names_t_encode(out, 0, HOSTILE_BYTES_MAX, &message);
}

static const struct {
    const char *type;
    size_t (*write)(unsigned char *out);
} goods[] = {
    {"pair_query", good_pair_query},
    {"pair_result", good_pair_result},
    {"scene_query", good_scene_query},
    {"scene_result", good_scene_result},
    {"definition_query", good_definition_query},
    {"definition", good_definition},
    {"status", good_status},
    {"names", good_names},
};

size_t hostile_good(const char *type, unsigned char out[HOSTILE_BYTES_MAX])
{
    for (size_t i = 0; i < sizeof goods / sizeof *goods; i++)
        if (strcmp(goods[i].type, type) == 0)
            return goods[i].write(out);
    layout_of(type); /* ends it */
    return 0;
}

struct damage {
    hostile_visit visit;
    void *context;
    size_t count;
    size_t size;
    unsigned char good[HOSTILE_BYTES_MAX];
};

static void emit(struct damage *damage, const char *what, const unsigned char *bytes, size_t size)
{
    damage->visit(damage->context, what, bytes, size);
    damage->count++;
}

static int32_t get_int32(const unsigned char *at)
{
    return (int32_t) ((uint32_t) at[0] << 24 | (uint32_t) at[1] << 16 | (uint32_t) at[2] << 8 |
                      at[3]);
}

static void put_int32(unsigned char *at, int64_t value)
{
    for (int i = 0; i < 4; i++)
        at[i] = (unsigned char) ((uint64_t) value >> (24 - 8 * i));
}

/* The count or length at a place, replaced by numbers that lie. */
static void damage_count(struct damage *damage, size_t at, bool string)
{
    int64_t count = get_int32(damage->good + at);
    const int64_t lies[] = {
        -1,       INT32_MIN, INT32_MIN + 1, INT32_MAX,       50000000,   0x20000000,     0x10000000,
        40000000, count + 1, count - 1,     count + 1000000, 0x1fffffff, string ? 0 : -2};
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        unsigned char bytes[HOSTILE_BYTES_MAX];
        char what[80];
        memcpy(bytes, damage->good, damage->size);
        put_int32(bytes + at, lies[i]);
        snprintf(what, sizeof what, "%s at byte %zu is %lld", string ? "length" : "count", at,
                 (long long) lies[i]);
        emit(damage, what, bytes, damage->size);
    }
}

/* The text at a place, with a byte in it that no text has. */
static void damage_text(struct damage *damage, size_t at)
{
    static const unsigned char none[] = {1, '\t', '\n', 0x1b, 0x1f, 0x7f, 0x80, 0xff};
    size_t length = (size_t) get_int32(damage->good + at) - 1;
    for (size_t i = 0; i < length; i += length - 1)
        for (size_t k = 0; k < sizeof none; k++) {
            unsigned char bytes[HOSTILE_BYTES_MAX];
            char what[80];
            memcpy(bytes, damage->good, damage->size);
            bytes[at + 4 + i] = none[k];
            snprintf(what, sizeof what, "text with byte %d at %zu", none[k], i);
            emit(damage, what, bytes, damage->size);
        }
}

static void damage_string(struct damage *damage, size_t at)
{
    unsigned char bytes[HOSTILE_BYTES_MAX];
    size_t length = (size_t) get_int32(damage->good + at);
    memcpy(bytes, damage->good, damage->size);
    bytes[at + 4 + length - 1] = 'x';
    emit(damage, "string without a final 0", bytes, damage->size);
    if (length > 1) {
        memcpy(bytes, damage->good, damage->size);
        bytes[at + 4] = 0;
        emit(damage, "string with a 0 inside", bytes, damage->size);
    }
}

/* Returns the end of a layout that begins at an offset. */
static size_t damage_layout(struct damage *damage, const char *layout, size_t at);

/* Each of the fields is a count and as many things. */
static size_t damage_list(struct damage *damage, char field, size_t at)
{
    const bool string = field == 's' || field == 'p';
    const size_t count = (size_t) get_int32(damage->good + at);
    damage_count(damage, at, string);
    if (string)
        damage_string(damage, at);
    if (field == 'p')
        damage_text(damage, at);
    at += 4;
    for (size_t i = 0; (field == 'f' || field == 'o') && i < count; i++)
        at = damage_layout(damage, field == 'f' ? PLACEMENT : BODY, at);
    switch (field) {
    case 'w': at += 2 * 8 * count; /* fall through */
    case 'v':
        for (size_t i = 0; i < count; i++)
            at = damage_list(damage, 's', at);
        return field == 'v' ? at + 8 * count : at;
    case 'n': return at + 8 * count;
    case 'm': return at + 4 * count;
    case 'h': return at + 2 * count;
    case 'f':
    case 'o':
    case 'd': return at;
    default: return at + count;
    }
}

static size_t damage_layout(struct damage *damage, const char *layout, size_t at)
{
    size_t dim = 0;
    for (const char *field = layout; *field; field++) {
        if (*field == 'd')
            dim = (size_t) get_int32(damage->good + at);
        if (*field == 'l' || *field == 'i')
            at += *field == 'l' ? 8 : 4;
        else if (*field == 'c')
            at += 8 * dim;
        else
            at = damage_list(damage, *field, at);
    }
    return at;
}

static void damage_fields(struct damage *damage, const char *layout)
{
    if (damage_layout(damage, layout, 8) != damage->size) {
        fprintf(stderr, "hostile: the layout does not fit the message\n");
        exit(2);
    }
}

static void damage_fingerprint(struct damage *damage)
{
    for (int bit = 0; bit < 64; bit++) {
        unsigned char bytes[HOSTILE_BYTES_MAX];
        memcpy(bytes, damage->good, damage->size);
        bytes[bit / 8] ^= (unsigned char) (1 << bit % 8);
        emit(damage, "one bit of the fingerprint is wrong", bytes, damage->size);
    }
}

static void damage_size(struct damage *damage)
{
    unsigned char bytes[HOSTILE_BYTES_MAX] = {0};
    for (size_t size = 0; size < damage->size; size++)
        emit(damage, "cut off", damage->good, size);
    memcpy(bytes, damage->good, damage->size);
    emit(damage, "one byte more", bytes, damage->size + 1);
    emit(damage, "16 bytes more", bytes, damage->size + 16);
    memset(bytes, 0xff, sizeof bytes);
    emit(damage, "all ones", bytes, sizeof bytes);
    memset(bytes, 0, sizeof bytes);
    emit(damage, "all zeros", bytes, sizeof bytes);
}

size_t hostile_each(const char *type, hostile_visit visit, void *context)
{
    struct damage damage = {.visit = visit, .context = context};
    damage.size = hostile_good(type, damage.good);
    damage_size(&damage);
    damage_fingerprint(&damage);
    damage_fields(&damage, layout_of(type));
    return damage.count;
}

size_t hostile_flood(const char *type, long long client_id, long long sequence_number,
                     unsigned char out[HOSTILE_BYTES_MAX])
{
    char label[] = "";
    int16_t index[400];
    fmb_msgs_placement_t bodies[2] = {good_placement(), good_placement()};
    fmb_msgs_pair_query_t pair = {.client_id = client_id,
                                  .sequence_number = sequence_number,
                                  .duration = 1,
                                  .a = bodies[0],
                                  .b = bodies[1]};
    fmb_msgs_scene_query_t scene = {.client_id = client_id,
                                    .sequence_number = sequence_number,
                                    .label = label,
                                    .duration = 1,
                                    .method = FMB_MSGS_PAIR_QUERY_T_METHOD_EXACT,
                                    .which = FMB_MSGS_SCENE_QUERY_T_PAIRS_LISTED,
                                    .num_placements = 2,
                                    .placements = bodies,
                                    .num_indices = 400,
                                    .indices = index};
    for (int i = 0; i < 400; i++)
        index[i] = (int16_t) (i % 2);
    if (strcmp(type, "scene_query") == 0)
        return (size_t) fmb_msgs_scene_query_t_encode(out, 0, HOSTILE_BYTES_MAX, &scene);
    return (size_t) fmb_msgs_pair_query_t_encode(out, 0, HOSTILE_BYTES_MAX, &pair);
}

/* The handle that a true service would give the placement: of a body that came whole with an id. */
static bool lie_handle(const fmb_msgs_placement_t *placement, uint8_t out[16])
{
    fmb_msgs_body_t body = {.dim = placement->dim,
                            .num_frames = placement->num_frames,
                            .shapes = placement->shapes,
                            .num_counts = placement->num_counts,
                            .counts = placement->counts,
                            .num_numbers = placement->num_numbers,
                            .numbers = placement->numbers};
    if (placement->body_id == 0 || placement->num_frames == 0)
        return false;
    set_handle(&body);
    memcpy(out, body.handle, sizeof body.handle);
    return true;
}

size_t hostile_lie(const void *query, size_t size, char *certificate,
                   unsigned char out[HOSTILE_BYTES_MAX])
{
    fmb_msgs_pair_query_t query_read;
    char detail[] = "";
    double contact[2] = {0};
    if (fmb_msgs_pair_query_t_decode(query, 0, (int) size, &query_read) < 0)
        return 0;
    contact[1] = query_read.duration;
    fmb_msgs_pair_result_t result = {.client_id = query_read.client_id,
                                     .sequence_number = query_read.sequence_number,
                                     .detail = detail,
                                     .method = FMB_MSGS_PAIR_QUERY_T_METHOD_EXACT,
                                     .verdict = FMB_MSGS_PAIR_RESULT_T_VERDICT_OVERLAPPING,
                                     .num_contact = 2,
                                     .contact = contact,
                                     .certificate = certificate,
                                     .body_a = query_read.a.body_id,
                                     .body_b = query_read.b.body_id};
    lie_handle(&query_read.a, result.handle_a);
    lie_handle(&query_read.b, result.handle_b);
    fmb_msgs_pair_query_t_decode_cleanup(&query_read);
    int written = fmb_msgs_pair_result_t_encode(out, 0, HOSTILE_BYTES_MAX, &result);
    return written < 0 ? 0 : (size_t) written;
}

size_t hostile_lie_scene(const void *query, size_t size, unsigned char out[HOSTILE_BYTES_MAX])
{
    fmb_msgs_scene_query_t query_read;
    char detail[] = "";
    uint8_t verdict[] = {FMB_MSGS_PAIR_RESULT_T_VERDICT_OVERLAPPING};
    int16_t pair[] = {0, 1};
    double times[2] = {0};
    uint8_t handles[HOSTILE_BYTES_MAX];
    int32_t handle_bytes = 0;
    if (fmb_msgs_scene_query_t_decode(query, 0, (int) size, &query_read) < 0)
        return 0;
    for (int32_t i = 0; i < query_read.num_placements && handle_bytes < HOSTILE_BYTES_MAX; i++)
        if (lie_handle(&query_read.placements[i], handles + handle_bytes))
            handle_bytes += 16;
    times[1] = query_read.duration;
    fmb_msgs_scene_result_t result = {
        .client_id = query_read.client_id,
        .sequence_number = query_read.sequence_number,
        .detail = detail,
        .method = FMB_MSGS_PAIR_QUERY_T_METHOD_EXACT,
        .num_handle_bytes = handle_bytes,
        .handles = handles,
        .end_pair = query_read.num_placements * (query_read.num_placements - 1) / 2,
        .num_verdicts = 1,
        .verdicts = verdict,
        .num_indices = 2,
        .indices = pair,
        .num_times = query_read.want & FMB_MSGS_PAIR_QUERY_T_WANT_TIMES ? 2 : 0,
        .times = times};
    fmb_msgs_scene_query_t_decode_cleanup(&query_read);
    int written = fmb_msgs_scene_result_t_encode(out, 0, HOSTILE_BYTES_MAX, &result);
    return written < 0 ? 0 : (size_t) written;
}
