/* Queries and results as plain structs. wire.h encodes and decodes them, so that the code that
 * answers queries needs no LCM. Fields have the meaning, unit and axis order that the message types
 * (*.lcm) state. No function has shared state. */
#ifndef QUERY_H
#define QUERY_H

#include "fmb.h"
#include "handle.h"
#include "ignored.h"
#include "utf8.h"

#include <assert.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* The largest id and sequence number: doubles represent integers exactly up to here, and some LCM
 * languages have no other numbers. */
#define QUERY_ID_MAX ((INT64_C(1) << 53) - 1)

static inline bool query_id_ok(int64_t id)
{
    return id >= 0 && id <= QUERY_ID_MAX;
}

/* Most bytes of a query or result: one datagram, which LCM's Java sends unfragmented. */
enum { QUERY_BYTES_MAX = 63900 };

/* Most bytes of a detail text, final 0 included. */
enum { QUERY_TEXT_MAX = 160 };

enum { QUERY_ORIENTATION_MAX = 4, QUERY_NAME_MAX = 64 /* bytes */ };

/* Whether a name or label is legal: at most QUERY_NAME_MAX bytes of UTF-8 without control
 * characters; may be empty. */
static inline bool query_name_ok(const char *name)
{
    return strlen(name) <= QUERY_NAME_MAX && utf8_is_text(name);
}

/* Fields that every query begins with. */
struct query_header {
    int64_t utime; /* microseconds since 1970 */
    int64_t client_id, sequence_number;
};

/* Declares these fields in a struct, both by their names and as one struct `header`. */
#define QUERY_HEADER                                   \
    union {                                            \
        struct query_header header;                    \
        struct {                                       \
            int64_t utime, client_id, sequence_number; \
        };                                             \
    }

/* A body as messages define it: by its frames in body coordinates, encoded, or by its handle alone.
 * Counts are those of the message, 0 or more and not checked. Two bodies are the same if and only
 * if these bytes are (so -0 differs from 0); the handle is their hash. */
struct body_view {
    struct handle handle; /* all 0: none, or not computed */
    int32_t dim;          /* 0 or more; not checked */
    int32_t frame_count;  /* 0: by its handle */
    int32_t count_count;  /* frames by vertices */
    int32_t number_count; /* of all frames */
    /* The fields dim to numbers (geometry.h reads them). Not owned: in the message that was read,
     * or in memory of the writer. */
    const unsigned char *bytes;
    size_t size;
};

enum {
    /* Bytes of a body without frames: dim, counts of frames, of counts, and of numbers. */
    GEOMETRY_NONE_BYTES = 16,
    /* Most bytes of a body of one frame that is no hull. */
    GEOMETRY_FRAME_BYTES_MAX = GEOMETRY_NONE_BYTES + 1 + 4 + 8 * (1 + FMB_FRAME_NUMBERS_MAX),
    /* Least bytes of a frame, a hull of one vertex in 2D; and hence most frames of a message. */
    GEOMETRY_FRAME_BYTES_MIN = 1 + 4 + 8 * 2,
    QUERY_FRAMES_MAX = QUERY_BYTES_MAX / GEOMETRY_FRAME_BYTES_MIN
};

/* A placement, and the body that it places. If there are more numbers than an array holds, the
 * first are stored; the counts of orientation, velocity and end are copied from the message; they
 * are at least 0, and otherwise not checked. */
struct query_placement {
    /* Its body is NULL: the code that decides the pair sets it in a copy. The name, any bytes, is
     * in the message or in memory of the writer; NULL is the same as "". */
    struct fmb_placement placed;
    struct body_view body;
    int32_t velocity_count; /* 0: at rest */
};

/* Whether the body is given by its handle alone. */
static inline bool query_by_handle(const struct query_placement *placement)
{
    const struct body_view *body = &placement->body;
    return body->frame_count == 0 && body->count_count == 0 && body->number_count == 0 &&
           !handle_is_none(&body->handle);
}

/* Fields of every result. A definition sends them up to detail; the others are 0. */
#define RESULT_FIELDS                                                                 \
    QUERY_HEADER; /* of the query */                                                  \
    int64_t server_id;                                                                \
    int32_t status;              /* enum fmb_status */                                \
    char detail[QUERY_TEXT_MAX]; /* "" if OK */                                       \
    int32_t method;              /* 0 if not OK */                                    \
    int32_t dim;                 /* of boxes and gaps, 2 or 3; 0 if there are none */ \
    bool names_frames;           /* there are gaps, and a body has several frames */  \
    int64_t compute_ns
struct result_head {
    RESULT_FIELDS;
};

/* Declares these fields in a struct, both by their names and as one struct `head`. */
#define RESULT_HEAD              \
    union {                      \
        struct result_head head; \
        struct {                 \
            RESULT_FIELDS;       \
        };                       \
    }

struct pair_query {
    QUERY_HEADER;
    double duration; /* seconds; also 0 for a struct fmb_scene with instant set */
    int32_t method;  /* 0: the default */
    int32_t want;
    struct query_placement placement[2];
};

struct pair_result {
    RESULT_HEAD;
    int64_t body_id[2];
    struct handle handle[2];  /* of bodies sent with frames and an id; else all 0 */
    struct fmb_answer answer; /* all 0 if not OK */
    const char *certificate;  /* NULL: none. Points into the answerer or the message */
};

/* ---- Scenes ---- */

/* Most valid placements, and most pairs listed, of a query of QUERY_BYTES_MAX: a placement takes 81
 * bytes (2D, by handle, at rest) or more, a pair 4. */
enum {
    QUERY_PLACEMENT_BYTES_MIN = 81,
    QUERY_PLACEMENTS_MAX = QUERY_BYTES_MAX / QUERY_PLACEMENT_BYTES_MIN,
    QUERY_PAIRS_MAX = QUERY_BYTES_MAX / 4
};

struct scene_query {
    QUERY_HEADER;
    const char *label; /* any bytes; in memory as the name of a placement */
    double duration;
    int32_t method, want;
    double margin;
    int32_t which; /* enum fmb_pairs, not checked */
    int32_t split, first_pair;
    /* Counts of the message; if they exceed the arrays, the first elements are stored. */
    int32_t placement_count, index_count, ignored_count;
    struct query_placement placement[QUERY_PLACEMENTS_MAX];
    /* [pair][a, b], not checked. A negative index is stored as a number above 2^31. */
    unsigned pair[QUERY_PAIRS_MAX][2];
    unsigned ignored[QUERY_PAIRS_MAX][2];
};

/* The number of placements in the struct. */
int32_t query_stored_placements(const struct scene_query *query);

/* The number of pairs, those that are not decided included. On input: split is 0 to the number of
 * placements, as in the functions below. */
int64_t query_pair_count(const struct scene_query *query);

/* Whether (a, b), in this order, is among all pairs, or among those across; and its number. */
bool query_has_pair(const struct scene_query *query, unsigned a, unsigned b);
int64_t query_pair_number(const struct scene_query *query, unsigned a, unsigned b);

/* The ignored pairs. On input: indices below the number of placements. */
enum { QUERY_IGNORED_CAPACITY = 2 * QUERY_PLACEMENTS_MAX + QUERY_PAIRS_MAX };
void query_ignored(const struct scene_query *query, unsigned memory[QUERY_IGNORED_CAPACITY],
                   struct ignored *out);

/* The number of pairs from first_pair on and before end_pair that are decided: neither ignored nor
 * within a group. No listed pair is. All of a query whose split or ignored pairs are out of range.
 */
int64_t query_pairs_decided(const struct scene_query *query, int32_t end_pair,
                            unsigned memory[QUERY_IGNORED_CAPACITY]);

/* Capacity of a result: a named pair takes at least five bytes, a number eight. */
enum {
    QUERY_VERDICTS_MAX = QUERY_PAIRS_MAX,
    QUERY_NAMED_MAX = QUERY_BYTES_MAX / 5,
    QUERY_NUMBERS_MAX = QUERY_BYTES_MAX / 8,
    QUERY_GAPS_MAX = QUERY_NUMBERS_MAX / 9 /* in 2D */
};

struct scene_result {
    RESULT_HEAD;
    int32_t end_pair;
    int32_t unknown_count; /* placements whose handles are not held */
    int32_t handle_count;  /* placements sent with frames and an id */
    int32_t verdict_count; /* number of named pairs, or of answered pairs from first_pair on */
    int32_t contact_count; /* verdicts that touch or overlap */
    bool names_pairs, has_times, has_boxes, has_points, has_gaps;
    unsigned unknown[QUERY_PLACEMENTS_MAX];     /* [unknown_count] indices, ascending */
    struct handle handle[QUERY_PLACEMENTS_MAX]; /* [handle_count], in the order of placements */
    unsigned char verdict[QUERY_VERDICTS_MAX];
    unsigned pair[QUERY_NAMED_MAX][2]; /* [verdict_count][a, b], if names_pairs */
    double times[QUERY_NUMBERS_MAX];   /* [contact][first, last], seconds, if has_times */
    double boxes[QUERY_NUMBERS_MAX];   /* [contact][lower, upper][dim], if has_boxes */
    double points[QUERY_NUMBERS_MAX];  /* [contact][time, coordinates], if has_points */
    /* [verdict_count], if has_gaps. A separated pair may have no gap: bounds NaN, the rest 0. */
    struct fmb_gap gap[QUERY_GAPS_MAX];
};

/* Whether the pair has a gap, that is, bounds that are not NaN and ordered. */
static inline bool query_has_gap(const struct fmb_gap *gap)
{
    return gap->bounds[0] <= gap->bounds[1];
}

/* Removes the gap of a separated pair that is farther apart than the margin. */
static inline void query_remove_far_gap(double margin, struct fmb_answer *answer)
{
    if (answer->verdict != FMB_SEPARATED || answer->gap.bounds[0] <= margin)
        return;
    answer->has_gap = false;
    memset(&answer->gap, 0, sizeof answer->gap);
}

/* Whether two gaps are equal bit for bit. The time is compared only if there are witness points:
 * otherwise messages do not contain it. */
static inline bool query_same_gap(const struct fmb_gap *a, const struct fmb_gap *b)
{
    return a->has_witness == b->has_witness &&
           memcmp(a->bounds, b->bounds, sizeof a->bounds) == 0 &&
           memcmp(a->direction, b->direction, sizeof a->direction) == 0 &&
           (!a->has_witness || memcmp(&a->time, &b->time, sizeof a->time) == 0) &&
           memcmp(a->witness, b->witness, sizeof a->witness) == 0 &&
           memcmp(a->frame, b->frame, sizeof a->frame) == 0;
}

/* Returns the parts of two answers that differ, a sum of FMB_WANT_TIMES, BOX, POINT and GAP: one
 * answer lacks the part, or its numbers are not equal bit for bit (0 and -0 differ). */
static inline unsigned query_parts_that_differ(const struct fmb_answer *a,
                                               const struct fmb_answer *b)
{
    /* Flags and padding take 8 bytes in each struct. A new number changes a size. */
    static_assert(
        sizeof *a == 8 + sizeof a->contact + sizeof a->box + sizeof a->point + sizeof a->gap &&
            sizeof a->gap == 8 + sizeof a->gap.bounds + sizeof a->gap.direction +
                                 sizeof a->gap.time + sizeof a->gap.witness + sizeof a->gap.frame,
        "a number that is not compared");
    const bool times = a->has_contact != b->has_contact ||
                       (a->has_contact && memcmp(a->contact, b->contact, sizeof a->contact) != 0);
    const bool box =
        a->has_box != b->has_box || (a->has_box && memcmp(a->box, b->box, sizeof a->box) != 0);
    const bool gap = a->has_gap != b->has_gap || (a->has_gap && !query_same_gap(&a->gap, &b->gap));
    const bool point = a->has_point != b->has_point ||
                       (a->has_point && memcmp(a->point, b->point, sizeof a->point) != 0);
    return (times ? FMB_WANT_TIMES : 0) | (box ? FMB_WANT_BOX : 0) | (gap ? FMB_WANT_GAP : 0) |
           (point ? FMB_WANT_POINT : 0);
}

static inline bool query_same_answer(const struct fmb_answer *a, const struct fmb_answer *b)
{
    return a->verdict == b->verdict && query_parts_that_differ(a, b) == 0;
}

/* ---- Definitions ---- */

enum {
    QUERY_HANDLES_MAX = QUERY_BYTES_MAX / (int) sizeof(struct handle),
    QUERY_BODIES_MAX =
        QUERY_BYTES_MAX / (HANDLE_BYTES + GEOMETRY_NONE_BYTES + GEOMETRY_FRAME_BYTES_MIN)
};

struct definition_query {
    QUERY_HEADER;
    int64_t first;
    int32_t handle_count; /* 0: all bodies held */
    struct handle handle[QUERY_HANDLES_MAX];
};

struct definition {
    RESULT_HEAD;
    int64_t next; /* 0: complete */
    int32_t body_count;
    struct body_view body[QUERY_BODIES_MAX];
};

/* ---- Names ---- */

/* Each takes at least 8 + 8 + 4 + 1 bytes, after 20 of the message. */
enum { QUERY_NAMES_MAX = (QUERY_BYTES_MAX - 20) / 21 };

struct names {
    int64_t utime;
    int32_t count;
    int64_t client_id[QUERY_NAMES_MAX], body_id[QUERY_NAMES_MAX];
    const char *name[QUERY_NAMES_MAX]; /* any bytes; in memory as the name of a placement */
};

#endif
