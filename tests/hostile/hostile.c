#include "hostile.h"

#include "fmb_msgs_pair_query_t.h"
#include "fmb_msgs_pair_result_t.h"
#include "fmb_msgs_status_t.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Layouts, after the fingerprint: l 8 bytes, i 4 bytes, n a count and its numbers of 8 bytes,
 * s a string, p one that is printable. */
#define FRAME "llinnn"
static const struct {
    const char *type, *layout;
} layouts[] = {
    {"pair_query", "llllii" FRAME FRAME},
    {"pair_result", "llllllllisiinnpl"},
    {"status", "llslllllllnlllllllllllln"},
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

static size_t good_pair_query(unsigned char *out)
{
    double origin[3] = {0.5, -1, 2}, velocity[3] = {1, 0, -0.25};
    double cube[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    fmb_msgs_frame_t frame = {.body_id = 7,
                              .shape = FMB_MSGS_FRAME_T_SHAPE_CUBOID,
                              .dim = 3,
                              .origin = origin,
                              .num_components = 9,
                              .components = cube,
                              .num_velocity = 3,
                              .velocity = velocity};
    fmb_msgs_pair_query_t query = {
        .utime = 1, .client_id = 2, .sequence_number = 3, .duration = 1, .a = frame, .b = frame};
    return (size_t) fmb_msgs_pair_query_t_encode(out, 0, HOSTILE_BYTES_MAX, &query);
}

static size_t good_pair_result(unsigned char *out)
{
    char detail[] = "", certificate[] = "touching + a0 at 0 (1 0 1/2)";
    double contact[2] = {0, 0.5}, box[6] = {0, 0, 0, 1, 1, 1};
    fmb_msgs_pair_result_t result = {.client_id = 2,
                                     .detail = detail,
                                     .method = FMB_MSGS_PAIR_QUERY_T_METHOD_EXACT,
                                     .verdict = FMB_MSGS_PAIR_RESULT_T_VERDICT_TOUCHING,
                                     .num_contact = 2,
                                     .contact = contact,
                                     .num_box = 6,
                                     .box = box,
                                     .certificate = certificate};
    return (size_t) fmb_msgs_pair_result_t_encode(out, 0, HOSTILE_BYTES_MAX, &result);
}

static size_t good_status(unsigned char *out)
{
    char version[] = "1.2.3";
    int64_t results[14] = {5, 1};
    fmb_msgs_status_t status = {
        .utime = 1, .version = version, .num_results = 14, .results = results};
    return (size_t) fmb_msgs_status_t_encode(out, 0, HOSTILE_BYTES_MAX, &status);
}

size_t hostile_good(const char *type, unsigned char out[HOSTILE_BYTES_MAX])
{
    layout_of(type);
    if (strcmp(type, "pair_query") == 0)
        return good_pair_query(out);
    return strcmp(type, "status") == 0 ? good_status(out) : good_pair_result(out);
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

static void damage_fields(struct damage *damage, const char *layout)
{
    size_t at = 8;
    for (const char *field = layout; *field; field++) {
        bool string = *field == 's' || *field == 'p';
        if (*field == 'n' || string)
            damage_count(damage, at, string);
        if (string)
            damage_string(damage, at);
        if (*field == 'p')
            damage_text(damage, at);
        switch (*field) {
        case 'l': at += 8; break;
        case 'i': at += 4; break;
        case 'n': at += 4 + 8 * (size_t) get_int32(damage->good + at); break;
        case 's':
        case 'p': at += 4 + (size_t) get_int32(damage->good + at); break;
        }
    }
    if (at != damage->size) {
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

size_t hostile_lie(const void *query, size_t size, char *certificate,
                   unsigned char out[HOSTILE_BYTES_MAX])
{
    fmb_msgs_pair_query_t asked;
    char detail[] = "";
    if (fmb_msgs_pair_query_t_decode(query, 0, (int) size, &asked) < 0)
        return 0;
    fmb_msgs_pair_result_t result = {.client_id = asked.client_id,
                                     .sequence_number = asked.sequence_number,
                                     .detail = detail,
                                     .method = FMB_MSGS_PAIR_QUERY_T_METHOD_EXACT,
                                     .verdict = FMB_MSGS_PAIR_RESULT_T_VERDICT_OVERLAPPING,
                                     .certificate = certificate};
    fmb_msgs_pair_query_t_decode_cleanup(&asked);
    int written = fmb_msgs_pair_result_t_encode(out, 0, HOSTILE_BYTES_MAX, &result);
    return written < 0 ? 0 : (size_t) written;
}
