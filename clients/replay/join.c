#include "join.h"

#include "scene_pairs.h"
#include "wire.h"

#include <string.h>

static bool is_contact(unsigned char verdict)
{
    return verdict == FMB_TOUCHING || verdict == FMB_OVERLAPPING;
}

/* ---- Room ----
 *
 * As the service counts it. */

static size_t verdict_bytes(const struct scene_result *result)
{
    return result->names_pairs ? 1 + WIRE_PAIR_BYTES : 1;
}

static size_t numbers_of(const struct scene_result *result)
{
    return (result->has_times ? 2 : 0) + (result->has_boxes ? 2 * (size_t) result->dim : 0);
}

static size_t bytes_of(const struct scene_result *result)
{
    return WIRE_SCENE_RESULT_BYTES + sizeof(int64_t) * (size_t) result->key_count +
           (size_t) result->verdict_count * verdict_bytes(result) +
           (size_t) result->contact_count * numbers_of(result) * sizeof(double);
}

static bool has_room_for(const struct scene_result *result, bool contact)
{
    const size_t numbers = contact ? numbers_of(result) * sizeof(double) : 0;
    return bytes_of(result) + verdict_bytes(result) + numbers <= QUERY_BYTES_MAX;
}

bool join_has_room(const struct scene_result *result)
{
    return has_room_for(result, true);
}

/* ---- Joining ---- */

/* Whether both have the same of each contact, so that there is place for what has room. */
static bool fits(const struct scene_result *result, const struct scene_result *next)
{
    return result->contact_count == 0 || next->contact_count == 0 ||
           (result->has_times == next->has_times && result->dim == next->dim);
}

/* A result without contacts does not tell what it would have of them. */
static void take_form(struct scene_result *result, const struct scene_result *next)
{
    result->names_pairs = result->names_pairs || next->names_pairs;
    if (result->contact_count > 0)
        return;
    result->has_times = next->has_times;
    result->has_boxes = next->has_boxes;
    result->dim = next->dim;
}

static void append(struct scene_result *result, const struct scene_result *next, int32_t k,
                   int32_t contact)
{
    const size_t box = 2 * (size_t) result->dim;
    const int32_t n = result->verdict_count++;
    result->verdict[n] = next->verdict[k];
    if (result->names_pairs)
        memcpy(result->pair[n], next->pair[k], sizeof result->pair[n]);
    if (!is_contact(next->verdict[k]))
        return;
    const size_t c = (size_t) result->contact_count++, from = (size_t) contact;
    if (result->has_times)
        memcpy(&result->times[2 * c], &next->times[2 * from], 2 * sizeof(double));
    if (result->has_boxes)
        memcpy(&result->boxes[box * c], &next->boxes[box * from], box * sizeof(double));
}

/* The number of pair k of a result among all that are asked. */
static int32_t number_of(const struct scene_query *query, const struct scene_result *next,
                         int32_t first, int32_t k)
{
    return next->names_pairs ? scene_pairs_number(query, next->pair, (size_t) k) : first + k;
}

bool join(struct scene_result *result, const struct scene_result *next,
          const struct scene_query *query)
{
    const int32_t first = result->end_pair;
    int32_t contact = 0;
    if (!fits(result, next))
        return false;
    take_form(result, next);
    result->compute_ns += next->compute_ns;
    result->end_pair = next->end_pair;
    for (int32_t k = 0; k < next->verdict_count; k++) {
        if (!has_room_for(result, is_contact(next->verdict[k]))) {
            result->end_pair = number_of(query, next, first, k);
            break;
        }
        append(result, next, k, contact);
        contact += is_contact(next->verdict[k]);
    }
    return true;
}
