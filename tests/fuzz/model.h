/* The service's cache of bodies once more, as its contract has it and as simple as can be: a list,
 * the one used last first. It tells which keys there must be, and what they stand for. */
#ifndef MODEL_H
#define MODEL_H

#include "query.h"

enum { MODEL_BODIES_MAX = 8 };

struct model {
    int count, capacity; /* up to MODEL_BODIES_MAX */
    int64_t next_key;
    struct model_body {
        int64_t id, key;
        struct fmb_body body;
        double number[FMB_COMPONENTS_MAX];
    } newest[MODEL_BODIES_MAX];
};

/* On input: frames that are good. Both copy, since the next one may make it go. */

/* The body of a frame that comes by key; false: it is not held. */
bool model_find(struct model *model, const struct query_frame *frame, struct fmb_body *out);

/* The body of a frame that comes whole. Returns its key, or 0. */
int64_t model_keep(struct model *model, const struct query_frame *frame, struct fmb_body *out);

/* Whether a frame and a question are such as msgs/ asks for. */
bool model_good_frame(const struct query_frame *frame);
bool model_good_question(int64_t client_id, int64_t sequence_number, double duration,
                         int32_t method, int32_t want, int32_t wants);
bool model_by_key(const struct query_frame *frame);

/* The frame with this body. It points to it. */
struct fmb_frame model_frame(const struct query_frame *frame, const struct fmb_body *body);

#endif
