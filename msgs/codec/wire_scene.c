/* Scene queries and scene results. */
#include "wire.h"

#include "wire_placement.h"

#include "fmb_msgs_scene_query_t.h"
#include "fmb_msgs_scene_result_t.h"

#include <assert.h>
#include <float.h>
#include <string.h>

static_assert((int) FMB_PAIRS_LISTED == FMB_MSGS_SCENE_QUERY_T_PAIRS_LISTED &&
                  (int) FMB_PAIRS_ALL == FMB_MSGS_SCENE_QUERY_T_PAIRS_ALL &&
                  (int) FMB_PAIRS_ACROSS == FMB_MSGS_SCENE_QUERY_T_PAIRS_ACROSS,
              "which pairs");

/* Least bytes of a placement: one of dimension 0, which is read but not valid. */
enum { PLACEMENT_BYTES_LEAST = 65 };

/* ---- Queries ---- */

const char *wire_read_scene_header(const void *bytes, uint32_t size, struct query_header *out)
{
    return wire_read_header(bytes, size, __fmb_msgs_scene_query_t_get_hash(), out);
}

/* Reads placements. Those beyond the capacity of out are decoded and dropped. Returns the count of
 * the message. */
static int32_t read_placements(struct cursor *cursor, struct query_placement *out)
{
    const int32_t count = cursor_count(cursor, PLACEMENT_BYTES_LEAST);
    struct query_placement beyond;
    for (int32_t i = 0; i < count && !cursor->error; i++)
        wire_read_placement(cursor, i < QUERY_PLACEMENTS_MAX ? &out[i] : &beyond);
    return count;
}

const char *wire_read_scene_result_header(const void *bytes, uint32_t size,
                                          struct query_header *out)
{
    return wire_read_header(bytes, size, __fmb_msgs_scene_result_t_get_hash(), out);
}

const char *wire_read_scene_query(const void *bytes, uint32_t size, struct scene_query *out)
{
    struct cursor cursor = cursor_begin(bytes, size, __fmb_msgs_scene_query_t_get_hash());
    wire_read_ids(&cursor, &out->header);
    out->label = cursor_take_string(&cursor);
    out->duration = cursor_double(&cursor);
    out->method = cursor_int32(&cursor);
    out->want = cursor_int32(&cursor);
    out->margin = cursor_double(&cursor);
    out->which = cursor_int32(&cursor);
    out->split = cursor_int32(&cursor);
    out->first_pair = cursor_int32(&cursor);
    out->placement_count = read_placements(&cursor, out->placement);
    out->index_count = cursor_indices(&cursor, out->pair[0], 2 * QUERY_PAIRS_MAX);
    out->ignored_count = cursor_indices(&cursor, out->ignored[0], 2 * QUERY_PAIRS_MAX);
    return cursor_end(&cursor);
}

size_t wire_write_scene_query(const struct scene_query *query, unsigned char out[QUERY_BYTES_MAX])
{
    struct writer writer = writer_begin(out, QUERY_BYTES_MAX, __fmb_msgs_scene_query_t_get_hash());
    wire_write_ids(&writer, &query->header);
    wire_write_text(&writer, query->label);
    writer_double(&writer, query->duration);
    writer_int32(&writer, query->method);
    writer_int32(&writer, query->want);
    writer_double(&writer, query->margin);
    writer_int32(&writer, query->which);
    writer_int32(&writer, query->split);
    writer_int32(&writer, query->first_pair);
    writer_int32(&writer, query->placement_count);
    for (int32_t i = 0; i < query->placement_count; i++)
        wire_write_placement(&writer, &query->placement[i]);
    writer_indices(&writer, query->pair[0], query->index_count);
    writer_indices(&writer, query->ignored[0], query->ignored_count);
    return writer_end(&writer, out);
}

/* ---- Results ---- */

/* Reads the indices of placements whose handles are not held: ascending, and present if and only if
 * the status is UNKNOWN_BODY. */
static void read_unknown(struct cursor *cursor, struct scene_result *out)
{
    const int32_t count = cursor_indices(cursor, out->unknown, QUERY_PLACEMENTS_MAX);
    if ((count > 0) != (out->status == FMB_UNKNOWN_BODY) || count > QUERY_PLACEMENTS_MAX)
        cursor_fail(cursor, "unknown bodies and status do not go together");
    for (int32_t i = 0; i < count && !cursor->error; i++)
        if (out->unknown[i] >= QUERY_PLACEMENTS_MAX ||
            (i > 0 && out->unknown[i] <= out->unknown[i - 1]))
            cursor_fail(cursor, "unknown bodies out of order");
    out->unknown_count = count;
}

/* Reads the verdicts. Returns the number of contacts among them. */
static int32_t read_verdicts(struct cursor *cursor, struct scene_result *out)
{
    const int32_t count = cursor_bytes(cursor, out->verdict, QUERY_VERDICTS_MAX);
    int32_t contacts = 0;
    if (count > QUERY_VERDICTS_MAX)
        cursor_fail(cursor, "more verdicts than a message holds");
    for (int32_t i = 0; i < count && !cursor->error; i++) {
        if (out->verdict[i] > FMB_OVERLAPPING)
            cursor_fail(cursor, "a verdict that is none");
        contacts += out->verdict[i] >= FMB_TOUCHING;
    }
    out->verdict_count = count;
    return contacts;
}

/* Whether pair i has a < b, valid indices, and follows pair i - 1 in the order of (a, b). */
static bool is_next_pair(const unsigned (*pair)[2], int32_t i)
{
    const unsigned a = pair[i][0], b = pair[i][1];
    return a < b && b < QUERY_PLACEMENTS_MAX &&
           (i == 0 || pair[i - 1][0] < a || (pair[i - 1][0] == a && pair[i - 1][1] < b));
}

static void read_pairs(struct cursor *cursor, struct scene_result *out)
{
    const int32_t count = cursor_indices(cursor, out->pair[0], 2 * QUERY_NAMED_MAX);
    if (count != 0 && (count != 2 * out->verdict_count || count > 2 * QUERY_NAMED_MAX))
        cursor_fail(cursor, "as many pairs as verdicts, or none");
    for (int32_t i = 0; i < count / 2 && !cursor->error; i++)
        if (!is_next_pair((const unsigned(*)[2]) out->pair, i))
            cursor_fail(cursor, "a pair out of order");
    out->names_pairs = count > 0;
}

static bool is_interval(const double times[2])
{
    return 0 <= times[0] && times[0] <= times[1] && times[1] <= DBL_MAX;
}

static void read_times(struct cursor *cursor, struct scene_result *out)
{
    const int32_t count = cursor_doubles(cursor, out->times, QUERY_NUMBERS_MAX);
    if (count != 0 && (count != 2 * out->contact_count || count > QUERY_NUMBERS_MAX))
        cursor_fail(cursor, "two times for each contact, or none");
    for (int32_t i = 0; i < count && !cursor->error; i += 2)
        if (!is_interval(&out->times[i]))
            cursor_fail(cursor, "a contact interval that is no interval");
    out->has_times = count > 0;
}

static void read_boxes(struct cursor *cursor, struct scene_result *out)
{
    const int32_t count = cursor_doubles(cursor, out->boxes, QUERY_NUMBERS_MAX);
    out->dim = count == 0 ? 0 : count == 4 * out->contact_count ? 2 : 3;
    if (count != 2 * out->dim * out->contact_count || count > QUERY_NUMBERS_MAX)
        cursor_fail(cursor, "a box of 4 or 6 numbers for each contact, or none");
    for (int32_t i = 0; i < count && !cursor->error; i++) {
        const bool lower = i / out->dim % 2 == 0;
        if (lower && !(out->boxes[i] <= out->boxes[i + out->dim]))
            cursor_fail(cursor, "a box that is no box");
    }
    out->has_boxes = count > 0;
}

static void read_points(struct cursor *cursor, struct scene_result *out)
{
    const int32_t count = cursor_doubles(cursor, out->points, QUERY_NUMBERS_MAX);
    const int dim = count == 0 ? out->dim : count == 3 * out->contact_count ? 2 : 3;
    if ((count != 0 && count != (1 + dim) * out->contact_count) || count > QUERY_NUMBERS_MAX ||
        (out->dim > 0 && dim != out->dim))
        cursor_fail(cursor, "a point of 3 or 4 numbers for each contact, or none");
    for (int32_t i = 0; i < count && !cursor->error; i += 1 + dim)
        if (!wire_is_point(&out->points[i], 1 + dim))
            cursor_fail(cursor, "a point that is no point");
    out->dim = dim;
    out->has_points = count > 0;
}

static void read_gaps(struct cursor *cursor, struct scene_result *out)
{
    const int32_t count = out->verdict_count;
    const int dim = wire_read_gaps(cursor, out->verdict, count, true, &out->names_frames, out->gap);
    out->has_gaps = dim > 0;
    if (dim > 0 && out->dim > 0 && dim != out->dim)
        cursor_fail(cursor, "gaps of another dimension than boxes or points");
    out->dim = dim > 0 ? dim : out->dim;
    for (int32_t i = 0; i < count && out->names_pairs && !cursor->error; i++)
        if (out->verdict[i] == FMB_SEPARATED && !(out->has_gaps && query_has_gap(&out->gap[i])))
            cursor_fail(cursor, "a pair that neither meets nor is near");
}

const char *wire_read_scene_result(const void *bytes, uint32_t size, struct scene_result *out)
{
    struct cursor cursor = cursor_begin(bytes, size, __fmb_msgs_scene_result_t_get_hash());
    wire_read_ids(&cursor, &out->header);
    out->server_id = cursor_int64(&cursor);
    out->status = cursor_int32(&cursor);
    cursor_string(&cursor, out->detail, sizeof out->detail);
    out->method = cursor_int32(&cursor);
    read_unknown(&cursor, out);
    out->handle_count = wire_read_handles(&cursor, out->handle, QUERY_PLACEMENTS_MAX);
    if (out->handle_count > QUERY_PLACEMENTS_MAX)
        cursor_fail(&cursor, "more handles than a query has placements");
    out->end_pair = cursor_int32(&cursor);
    if (out->end_pair < 0)
        cursor_fail(&cursor, "an end before the first pair");
    out->contact_count = read_verdicts(&cursor, out);
    if (out->status != FMB_OK && (out->handle_count || out->end_pair || out->verdict_count))
        cursor_fail(&cursor, "answers and status do not go together");
    read_pairs(&cursor, out);
    read_times(&cursor, out);
    read_boxes(&cursor, out);
    read_points(&cursor, out);
    read_gaps(&cursor, out);
    out->compute_ns = cursor_int64(&cursor);
    return cursor_end(&cursor);
}

void wire_scene_answer(const struct scene_result *result, int32_t k, int32_t *contact,
                       struct fmb_answer *out)
{
    const int dim = result->dim;
    *out = (struct fmb_answer){.verdict = (enum fmb_verdict) result->verdict[k]};
    out->has_gap = result->has_gaps && query_has_gap(&result->gap[k]);
    if (out->has_gap)
        out->gap = result->gap[k];
    if (out->verdict < FMB_TOUCHING || *contact >= result->contact_count)
        return;
    const int32_t n = (*contact)++;
    out->has_contact = result->has_times;
    if (result->has_times)
        memcpy(out->contact, &result->times[2 * n], sizeof out->contact);
    out->has_box = result->has_boxes;
    for (int i = 0; i < 2 * dim && result->has_boxes; i++)
        out->box[i / dim][i % dim] = result->boxes[2 * dim * n + i];
    out->has_point = result->has_points;
    if (result->has_points)
        memcpy(out->point, &result->points[(1 + dim) * n], (size_t) (1 + dim) * sizeof *out->point);
}

size_t wire_write_scene_result(const struct scene_result *result,
                               unsigned char out[QUERY_BYTES_MAX])
{
    const int32_t contacts = result->contact_count;
    struct writer writer = writer_begin(out, QUERY_BYTES_MAX, __fmb_msgs_scene_result_t_get_hash());
    wire_write_ids(&writer, &result->header);
    writer_int64(&writer, result->server_id);
    writer_int32(&writer, result->status);
    writer_string(&writer, result->detail);
    writer_int32(&writer, result->method);
    writer_indices(&writer, result->unknown, result->unknown_count);
    wire_write_handles(&writer, result->handle, result->handle_count);
    writer_int32(&writer, result->end_pair);
    writer_bytes(&writer, result->verdict, result->verdict_count);
    writer_indices(&writer, result->pair[0], result->names_pairs ? 2 * result->verdict_count : 0);
    writer_doubles(&writer, result->times, result->has_times ? 2 * contacts : 0);
    writer_doubles(&writer, result->boxes, result->has_boxes ? 2 * result->dim * contacts : 0);
    writer_doubles(&writer, result->points, result->has_points ? (1 + result->dim) * contacts : 0);
    wire_write_gaps(&writer, result->gap, result->verdict_count, true, result->names_frames,
                    result->has_gaps ? result->dim : 0);
    writer_int64(&writer, result->compute_ns);
    return writer_end(&writer, out);
}
