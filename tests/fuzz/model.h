/* The bodies that the service holds once more, as simple as can be: a list. And what msgs/ says of
 * good queries. Nothing is ever evicted: the service's capacity is beyond what an input can send.
 */
#ifndef MODEL_H
#define MODEL_H

#include "geometry.h"

enum {
    MODEL_BODIES_MAX = 24,
    MODEL_FRAMES_MAX = 32, /* of a body */
    MODEL_NUMBERS_MAX = MODEL_FRAMES_MAX * FMB_FRAME_NUMBERS_MAX,
    MODEL_BYTES_MAX = GEOMETRY_NONE_BYTES + MODEL_FRAMES_MAX * (1 + 4) + 8 * MODEL_NUMBERS_MAX,
    MODEL_DOUBLES_MAX = 9 * MODEL_NUMBERS_MAX /* a hull of one vertex in 2D takes 17 */
};

struct model {
    int count;
    struct model_body {
        struct body_view view;
        unsigned char bytes[MODEL_BYTES_MAX];
    } body[MODEL_BODIES_MAX];
};

/* A body as the engine has it; must not be copied. */
struct model_made {
    struct fmb_body body;
    struct fmb_frame frame[MODEL_FRAMES_MAX];
    double vertices[MODEL_DOUBLES_MAX]; /* of its hulls */
};

/* Whether a placement and a request are such as msgs/ requires. */
bool model_good_placement(const struct query_placement *placement, double duration);
bool model_good_request(int64_t client_id, int64_t sequence_number, double duration, int32_t method,
                        int32_t want, int32_t wants);
bool model_by_handle(const struct query_placement *placement);

/* On input: placements that are good, with at most MODEL_FRAMES_MAX frames and
 * MODEL_NUMBERS_MAX numbers. */

/* The body of a placement by handle. OK; UNKNOWN_BODY; or WRONG_DIMENSION. */
enum fmb_status model_find(const struct model *model, const struct query_placement *placement,
                           struct model_made *out);

/* The body of a placement that comes whole. Returns its handle, or none for an anonymous one. */
struct handle model_keep(struct model *model, const struct query_placement *placement,
                         struct model_made *out);

/* The body with this handle; NULL: it is not held. */
const struct model_body *model_peek(const struct model *model, const struct handle *handle);

/* The body at its place. It points to it. */
struct fmb_placement model_place(const struct query_placement *placement,
                                 const struct model_made *made);

/* Number i of all frames of a placement. */
double model_number(const struct query_placement *placement, int i);

#endif
