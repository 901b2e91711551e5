/* Bytes of the bus <-> plain structs, and every check on bytes that nobody vouches for.
 *
 * LCM's encoding is big-endian and has no padding: 8 bytes of fingerprint, then the fields in
 * order; an array is its numbers, a string its length with the final 0 (int32_t), then its
 * bytes. The readers here walk the bytes themselves, with 64-bit sizes, into memory of the
 * caller: a count may say anything, they never read beyond the datagram and never allocate.
 * They accept exactly what lcm-gen's encoders write: the fingerprint of the type, counts from
 * 0, strings that end where they say, and not one byte more or less; of results only those with
 * a verdict just where the status is OK, with intervals and boxes that are such, and with a
 * certificate only beside a verdict: printable ASCII, shorter than QUERY_CERTIFICATE_MAX; of
 * results of scenes only those with as many names, times and boxes as their verdicts ask for, and
 * with the pairs that are named in their order. */
#ifndef WIRE_H
#define WIRE_H

#include "query.h"

#include <stdbool.h>
#include <stddef.h>

/* Channels; a prefix may stand in front (bus.h). */
#define WIRE_PAIR_QUERY "FMB_PAIR_QUERY"
#define WIRE_PAIR_RESULT "FMB_PAIR_RESULT"
#define WIRE_SCENE_QUERY "FMB_SCENE_QUERY"
#define WIRE_SCENE_RESULT "FMB_SCENE_RESULT"
#define WIRE_STATUS "FMB_STATUS"

/* Every message written here but those of scenes fits into this many bytes, and so into one
 * datagram; a result may take more, by the length of its certificate. */
enum { WIRE_BYTES_MAX = 1400, WIRE_RESULT_BYTES_MAX = WIRE_BYTES_MAX + QUERY_CERTIFICATE_MAX };

/* The counters of the heartbeat, all int64_t, in the order of status_t.lcm: those before its list
 * of results, and those after it. */
#define WIRE_COUNTERS_BEFORE(X) \
    X(uptime_us)                \
    X(restarts)                 \
    X(receive_buffer)           \
    X(received)                 \
    X(answered)                 \
    X(unsent)                   \
    X(pairs)
#define WIRE_COUNTERS_AFTER(X) \
    X(malformed)               \
    X(sequence_gaps)           \
    X(repeated)                \
    X(bodies)                  \
    X(capacity)                \
    X(hits)                    \
    X(misses)                  \
    X(replacements)            \
    X(evictions)               \
    X(compute_p50_ns)          \
    X(compute_p99_ns)          \
    X(compute_max_ns)
/* Those in its list more, in the order of msgs/README.md. */
#define WIRE_COUNTERS_MORE(X) \
    X(scenes)                 \
    X(waiting)                \
    X(most_waiting)

/* The heartbeat (status_t.lcm). */
struct wire_status {
    int64_t utime, server_id;
    char version[32];
#define X(name) int64_t name;
    WIRE_COUNTERS_BEFORE(X)
    int64_t results[FMB_STATUS_COUNT]; /* [status] */
    WIRE_COUNTERS_AFTER(X)
    WIRE_COUNTERS_MORE(X)
#undef X
};

/* Readers. On input: size bytes as LCM gives them (size is unsigned there, and can be a
 * negative number of ints: that is refused). On output: NULL and *out; or a static text of
 * what is wrong, and *out unspecified. Texts longer than the struct holds are cut; statuses
 * beyond FMB_STATUS_COUNT are left out; of more frames or pairs than there is room for, the first
 * are kept. The certificate of a result stays where it is, in bytes. */
const char *wire_read_pair_query(const void *bytes, uint32_t size, struct pair_query *out);
const char *wire_read_pair_result(const void *bytes, uint32_t size, struct pair_result *out);
const char *wire_read_scene_query(const void *bytes, uint32_t size, struct scene_query *out);
const char *wire_read_scene_result(const void *bytes, uint32_t size, struct scene_result *out);
const char *wire_read_status(const void *bytes, uint32_t size, struct wire_status *out);

/* The header alone of what says that it is a query, or a result, of the type; the rest is not
 * looked at. */
const char *wire_read_pair_header(const void *bytes, uint32_t size, struct query_header *out);
const char *wire_read_scene_header(const void *bytes, uint32_t size, struct query_header *out);
const char *wire_read_pair_result_header(const void *bytes, uint32_t size,
                                         struct query_header *out);
const char *wire_read_scene_result_header(const void *bytes, uint32_t size,
                                          struct query_header *out);

/* Writers: return how many bytes of out were used. */
size_t wire_write_pair_query(const struct pair_query *query, unsigned char out[WIRE_BYTES_MAX]);
size_t wire_write_pair_result(const struct pair_result *result,
                              unsigned char out[WIRE_RESULT_BYTES_MAX]);
size_t wire_write_status(const struct wire_status *status, unsigned char out[WIRE_BYTES_MAX]);

/* What a scene query takes: this much, for each frame what wire_frame_bytes() says, and for each
 * pair listed WIRE_PAIR_BYTES. One that takes more than QUERY_BYTES_MAX cannot be written. */
enum { WIRE_SCENE_QUERY_BYTES = 68, WIRE_PAIR_BYTES = 4 };
size_t wire_frame_bytes(const struct query_frame *frame);
size_t wire_write_scene_query(const struct scene_query *query, unsigned char out[QUERY_BYTES_MAX]);

/* What a scene result takes: this much with the longest detail, and eight bytes a key, one a
 * verdict, four a pair that is named, and eight a number of times and boxes. */
enum { WIRE_SCENE_RESULT_BYTES = 96 + QUERY_TEXT_MAX };
size_t wire_write_scene_result(const struct scene_result *result,
                               unsigned char out[QUERY_BYTES_MAX]);

#endif
