#include "check.h"

#include <math.h>
#include <stdio.h>

bool check_refuse(struct checking *checking, enum fmb_status status, const char *field,
                  const char *reason)
{
    char place[24] = "";
    if (checking->part && checking->index >= 0)
        snprintf(place, sizeof place, "%s[%d].", checking->part, (int) checking->index);
    else if (checking->part)
        snprintf(place, sizeof place, "%s.", checking->part);
    *checking->status = (int32_t) status;
    snprintf(checking->detail, QUERY_TEXT_MAX, "%s%s: %s", place, field,
             reason ? reason : fmb_status_text(status));
    return false;
}

static bool check_id(struct checking *checking, const char *field, int64_t id)
{
    return query_id_ok(id) || check_refuse(checking, FMB_BAD_ID, field, "not from 0 to 2^53 - 1");
}

static bool refuse_count(struct checking *checking, const char *field, int expected, int found)
{
    char reason[64];
    snprintf(reason, sizeof reason, "expected %d numbers, found %d", expected, found);
    return check_refuse(checking, FMB_WRONG_COUNT, field, reason);
}

static bool check_count(struct checking *checking, const char *field, int expected,
                        const struct query_numbers *numbers)
{
    return numbers->count == expected || refuse_count(checking, field, expected, numbers->count);
}

static bool refuse_not_finite(struct checking *checking, const char *field,
                              const struct query_numbers *numbers)
{
    for (int i = 0; i < numbers->count; i++)
        if (!isfinite(numbers->number[i])) {
            char place[32];
            snprintf(place, sizeof place, "%s[%d]", field, i);
            return check_refuse(checking, FMB_NOT_FINITE, place, NULL);
        }
    return true;
}

/* 0 times a number that is not finite is not 0. On input: a count that was checked. */
static inline double nothing_of(const struct query_numbers *numbers)
{
    double nothing = 0;
    for (int i = 0; i < numbers->count; i++)
        nothing += 0 * numbers->number[i];
    return nothing;
}

static bool check_finite(struct checking *checking, const struct query_frame *frame)
{
    return nothing_of(&frame->origin) + nothing_of(&frame->components) +
                   nothing_of(&frame->velocity) ==
               0 ||
           (refuse_not_finite(checking, "origin", &frame->origin) &&
            refuse_not_finite(checking, "components", &frame->components) &&
            refuse_not_finite(checking, "velocity", &frame->velocity));
}

static bool refuse_shape(struct checking *checking, const struct query_frame *frame)
{
    if (!fmb_shape_name(frame->shape))
        return check_refuse(checking, FMB_UNKNOWN_SHAPE, "shape", NULL);
    return check_refuse(checking, FMB_WRONG_DIMENSION, "dim",
                        frame->dim == 2 ? "a face is in 3D" : "neither 2 nor 3");
}

bool check_frame(struct checking *checking, const struct query_frame *frame)
{
    if (!check_id(checking, "body_id", frame->body_id) || !check_id(checking, "key", frame->key))
        return false;
    const int vectors = fmb_component_count(frame->dim, frame->shape);
    if (vectors == 0)
        return refuse_shape(checking, frame);
    return check_count(checking, "origin", frame->dim, &frame->origin) &&
           (check_by_key(frame) ||
            check_count(checking, "components", vectors * frame->dim, &frame->components)) &&
           (frame->velocity.count == 0 ||
            check_count(checking, "velocity", frame->dim, &frame->velocity)) &&
           check_finite(checking, frame);
}

bool check_ids(struct checking *checking, int64_t client_id, int64_t sequence_number)
{
    return check_id(checking, "client_id", client_id) &&
           check_id(checking, "sequence_number", sequence_number);
}

bool check_question(struct checking *checking, double duration, int32_t method, int32_t want,
                    int32_t wants)
{
    if (!(duration >= 0 && isfinite(duration)))
        return check_refuse(checking, FMB_BAD_DURATION, "duration", "negative or not finite");
    if (!fmb_method_by_number(method))
        return check_refuse(checking, FMB_UNKNOWN_METHOD, "method", NULL);
    return (want & ~wants) == 0 || check_refuse(checking, FMB_UNKNOWN_WANT, "want", NULL);
}
