/* Converts messages between bytes and plain structs, and checks untrusted bytes.
 *
 * LCM's encoding is big-endian without padding: 8 bytes of fingerprint, then the fields in order.
 * An array is encoded as its elements; a string as its length with the final 0 (int32_t), then its
 * bytes. The readers compute sizes in 64 bits and write into memory of the caller: whatever a count
 * says, they never read beyond the message and never allocate. They accept exactly what lcm-gen's
 * encoders write: the fingerprint of the type, counts from 0, strings whose only 0 is the last
 * byte, and no bytes more or less. Results must also be consistent:
 *
 * - A verdict is present if and only if the status is OK; an interval, if and only if the bodies
 *   touch or overlap. A box or a point is present only if they do. Intervals and boxes are ordered.
 *   A certificate is present only with a verdict, is printable ASCII and shorter than
 *   FMB_CERTIFICATE_MAX.
 * - The bounds of a gap are ordered, and 0 for bodies that touch; its direction is finite. Witness
 *   points are present if the bodies are separated, absent if they touch, and either if they
 *   overlap. A NaN, where the message types have one, has the bits 7ff8000000000000 (Java's NaN).
 *   Indices of frames are not negative, and 0 where a gap is NaN.
 * - A scene has as many named pairs, times, boxes, points and gaps as its verdicts require. Named
 *   pairs are in order; separated pairs have a gap. Unknown bodies are present if and only
 *   if the status is UNKNOWN_BODY. If the status is not OK, there are no answers.
 * - The bodies of a definition have frames, and match their handle. The frames are not checked.
 *
 * No function has shared state. */
#ifndef WIRE_H
#define WIRE_H

#include "fmb_counters.h"
#include "geometry.h"
#include "query.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* Channel names, without a prefix (bus_channel()). */
#define WIRE_PAIR_QUERY "FMB_PAIR_QUERY"
#define WIRE_PAIR_RESULT "FMB_PAIR_RESULT"
#define WIRE_SCENE_QUERY "FMB_SCENE_QUERY"
#define WIRE_SCENE_RESULT "FMB_SCENE_RESULT"
#define WIRE_DEFINITION_QUERY "FMB_DEFINITION_QUERY"
#define WIRE_DEFINITION "FMB_DEFINITION"
#define WIRE_STATUS "FMB_STATUS"
#define WIRE_NAMES "FMB_NAMES"

/* Most bytes of a heartbeat. */
enum { WIRE_STATUS_BYTES_MAX = 2000 };

/* The heartbeat (status_t.lcm). */
struct wire_status {
    int64_t utime, server_id;
    char version[32];
#define X(name) int64_t name;
    FMB_COUNTERS(X)
#undef X
    int64_t results[FMB_STATUS_COUNT]; /* [status] */
};

/* The counters of a heartbeat: the list in fmb_counters.h, and one of results for each status. */
enum {
#define X(...) +1
    WIRE_COUNTERS = FMB_COUNTERS(X) FMB_STATUS_MAP(X)
#undef X
};

/* Returns the name of counter i, static, and its value. On input: 0 <= i < WIRE_COUNTERS. */
const char *wire_status_counter(const struct wire_status *status, int i, int64_t *value);

/* Readers. On input: size bytes of payload.
 * On output: NULL and *out; or a static text of what is wrong, and *out unspecified. Texts longer
 * than the struct holds are truncated; counts of statuses from FMB_STATUS_COUNT on are ignored; if
 * a query has more placements, pairs or handles than the struct holds, the first are stored, and
 * the count is that of the message. Bodies, texts and the certificate of *out point into bytes. */
const char *wire_read_pair_query(const void *bytes, uint32_t size, struct pair_query *out);
const char *wire_read_pair_result(const void *bytes, uint32_t size, struct pair_result *out);
const char *wire_read_scene_query(const void *bytes, uint32_t size, struct scene_query *out);
const char *wire_read_scene_result(const void *bytes, uint32_t size, struct scene_result *out);
const char *wire_read_definition_query(const void *bytes, uint32_t size,
                                       struct definition_query *out);
const char *wire_read_definition(const void *bytes, uint32_t size, struct definition *out);
const char *wire_read_status(const void *bytes, uint32_t size, struct wire_status *out);
const char *wire_read_names(const void *bytes, uint32_t size, struct names *out);

/* Reads answer k of a result. *contact: the number of contacts before it; updated. */
void wire_scene_answer(const struct scene_result *result, int32_t k, int32_t *contact,
                       struct fmb_answer *out);

/* Read the header of a message of the type only. On output: NULL, or what is wrong. The remainder
 * of the message is not checked. */
const char *wire_read_pair_header(const void *bytes, uint32_t size, struct query_header *out);
const char *wire_read_scene_header(const void *bytes, uint32_t size, struct query_header *out);
const char *wire_read_definition_header(const void *bytes, uint32_t size, struct query_header *out);
const char *wire_read_pair_result_header(const void *bytes, uint32_t size,
                                         struct query_header *out);
const char *wire_read_scene_result_header(const void *bytes, uint32_t size,
                                          struct query_header *out);

/* Writers. Return the bytes of out used. On input: a message that fits (sizes below), with counts
 * and dimensions within the arrays of its struct. */
size_t wire_write_pair_query(const struct pair_query *query, unsigned char out[QUERY_BYTES_MAX]);
size_t wire_write_pair_result(const struct pair_result *result, unsigned char out[QUERY_BYTES_MAX]);
size_t wire_write_scene_query(const struct scene_query *query, unsigned char out[QUERY_BYTES_MAX]);
size_t wire_write_scene_result(const struct scene_result *result,
                               unsigned char out[QUERY_BYTES_MAX]);
size_t wire_write_definition_query(const struct definition_query *query,
                                   unsigned char out[QUERY_BYTES_MAX]);
size_t wire_write_definition(const struct definition *definition,
                             unsigned char out[QUERY_BYTES_MAX]);
size_t wire_write_status(const struct wire_status *status,
                         unsigned char out[WIRE_STATUS_BYTES_MAX]);
size_t wire_write_names(const struct names *names, unsigned char out[QUERY_BYTES_MAX]);

/* Sizes of messages without their lists. A pair query adds its placements; a scene query its
 * label, its placements, and WIRE_PAIR_BYTES for each pair listed or ignored. A scene result (size
 * with the longest detail) adds 2 bytes for each unknown body, 16 for each handle, 1 for each
 * verdict, 4 for each named pair, 8 for each number of times, boxes and points, and
 * wire_gap_bytes() for each gap. A definition adds 16 bytes and the encoded body for each; names 21
 * bytes and the name for each body. A pair result always fits. */
enum {
    WIRE_PAIR_QUERY_BYTES = 8 + 3 * 8 + 8 + 2 * 4,
    WIRE_SCENE_QUERY_BYTES = 8 + 3 * 8 + 4 + 1 + 8 + 2 * 4 + 8 + 3 * 4 + 3 * 4,
    WIRE_SCENE_RESULT_BYTES = 8 + 4 * 8 + 4 + 4 + QUERY_TEXT_MAX + 4 + 12 * 4 + 8,
    WIRE_DEFINITION_BYTES = 8 + 4 * 8 + 4 + 4 + QUERY_TEXT_MAX + 8 + 4,
    WIRE_NAMES_BYTES = 8 + 8 + 4,
    WIRE_PAIR_BYTES = 4
};

/* Bytes by which a name or a label lengthens a message. */
static inline size_t wire_text_bytes(const char *text)
{
    return text ? strlen(text) : 0;
}

/* Bytes of an encoded placement. */
size_t wire_placement_bytes(const struct query_placement *placement);

/* Bytes of an encoded gap in a scene: bounds, direction, time and points; frames if they are named.
 */
static inline int32_t wire_gap_bytes(int dim, bool names_frames)
{
    return 8 * (2 + dim + 1 + 2 * dim) + (names_frames ? 2 * 2 : 0);
}

#endif
