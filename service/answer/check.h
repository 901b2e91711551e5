/* Checks queries field by field. The first field that is wrong ends the check and is named. */
#ifndef CHECK_H
#define CHECK_H

#include "query.h"

/* A check under way. The place is put into words only where something is wrong. */
struct checking {
    int32_t *status;  /* of the result */
    char *detail;     /* [QUERY_TEXT_MAX] of the result */
    const char *part; /* "a", "placements"; NULL: the query itself */
    int32_t index;    /* of several in the part, from 0; -1: there is one */
};

/* Refuses the query: sets status and detail, "b.numbers[4]: not a finite number". reason NULL: the
 * text of the status. Returns false. */
bool check_refuse(struct checking *checking, enum fmb_status status, const char *field,
                  const char *reason);

/* All return whether the fields are right; if not, they have refused. */

bool check_ids(struct checking *checking, int64_t client_id, int64_t sequence_number);

/* wants: all bits that are allowed. */
bool check_request(struct checking *checking, double duration, int32_t method, int32_t want,
                   int32_t wants);

/* A placement that comes whole is accepted if fmb_frame_make() accepts all its frames. */
bool check_placement(struct checking *checking, const struct placement *placement);

/* The dimension of a placement that names its body by handle. */
bool check_body_dim(struct checking *checking, const struct placement *placement,
                    const struct fmb_body *body);

/* Adds the frames of a body to *total, which counts those of the query. */
bool check_frames(struct checking *checking, int64_t frames, int64_t *total);

#endif
