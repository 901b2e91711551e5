/* The service's cache of bodies once more, as its contract has it and as simple as can be: a list,
 * the most recently used first. And what msgs/ says of good queries. */
#ifndef MODEL_H
#define MODEL_H

#include "query.h"

enum { MODEL_BODIES_MAX = 8 };

struct model {
    int count, capacity; /* up to MODEL_BODIES_MAX */
    struct hasher *hasher;
    struct model_body {
        struct handle handle;
        size_t size;
        unsigned char bytes[GEOMETRY_FRAME_BYTES_MAX];
    } newest[MODEL_BODIES_MAX];
};

/* Whether a placement and a request are such as msgs/ requires, as far as this version goes. */
bool model_good_placement(const struct placement *placement);
bool model_good_request(int64_t client_id, int64_t sequence_number, double duration, int32_t method,
                        int32_t want, int32_t wants);
bool model_by_handle(const struct placement *placement);

/* On input: placements that are good. Both copy, since the next one may evict the body. */

/* The body of a placement by handle. OK; UNKNOWN_BODY; or WRONG_DIMENSION. */
enum fmb_status model_find(struct model *model, const struct placement *placement,
                           struct fmb_body *out);

/* The body of a placement that comes whole. Returns its handle, or none for an anonymous one. */
struct handle model_keep(struct model *model, const struct placement *placement,
                         struct fmb_body *out);

/* The body with this handle; NULL: it is not held. No use of it. */
const struct model_body *model_peek(const struct model *model, const struct handle *handle);

/* The body at its place. It points to it. */
struct fmb_frame model_frame(const struct placement *placement, const struct fmb_body *body);

/* Number i of all frames of a placement. */
double model_number(const struct placement *placement, int i);

#endif
