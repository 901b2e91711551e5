/* Checks queries field by field. The first field that is wrong ends the check; status and detail of
 * the result name it. No shared state. */
#ifndef CHECK_H
#define CHECK_H

#include "query.h"

#include <stdbool.h>

/* Context of a check: the part of the query that is being checked, and where to report. The name of
 * a field is formatted only if the field is wrong. */
struct check_context {
    struct result_head *result;
    bool is_pair;  /* placements are called a and b */
    int32_t index; /* of the placement that is being checked; -1: the query itself */
};

/* Refuses the query: sets the status and a detail such as "b.numbers[4]: not a finite number". On
 * input: field of the part; reason NULL: the text of the status. Returns false. */
bool check_refuse(struct check_context *context, enum fmb_status status, const char *field,
                  const char *reason);

/* The same for element i of a list of the part. */
bool check_refuse_at(struct check_context *context, enum fmb_status status, const char *list, int i,
                     const char *reason);

/* The functions below return true if the fields are valid; otherwise they refuse the query and
 * return false. */

bool check_ids(struct check_context *context, int64_t client_id, int64_t sequence_number);

/* The fields duration, method and want. On input: wants: all bits that are allowed in want. */
bool check_request(struct check_context *context, double duration, int32_t method, int32_t want,
                   int32_t wants);

/* All fields of a placement. Frames are valid if and only if the engine accepts them all. */
bool check_placement(struct check_context *context, const struct query_placement *placement);

#endif
