/* Makes bodies from their geometries, with all frames in one block of memory. No shared state. */
#ifndef BODY_H
#define BODY_H

#include "query.h"

#include <stddef.h>

/* Bytes of a body of so many frames, 1 or more. The first frame is at body.one. */
#define BODY_BYTES(frames) (offsetof(struct fmb_body, one) + (frames) * sizeof(struct fmb_frame))

/* Frames of a geometry. */
int32_t body_frame_count(const struct geometry *geometry);

/* Makes a body. On input: a geometry whose frames fmb_frame_make() accepts; memory of BODY_BYTES()
 * of its frames, aligned as a struct fmb_body. Returns the body, which is at `memory` and must not
 * be copied. The geometry is not used afterwards. */
const struct fmb_body *body_make(const struct geometry *geometry, void *memory);

/* Memory for the bodies of one query that are not in the cache. It suffices for all bodies that one
 * message can define: a placement with n frames takes at least 60 + 33 n bytes of the message, and
 * BODY_BYTES(n) is less than (60 + 33 n) / 33 times the size of a frame. */
struct query_bodies {
    size_t used; /* bytes of memory; 0: no bodies */
    _Alignas(64) unsigned char memory[(QUERY_FRAMES_MAX + 1) * sizeof(struct fmb_frame)];
};

/* Adds a body. On input: a checked geometry of the query. The body is valid until used is set to 0.
 */
const struct fmb_body *query_bodies_add(struct query_bodies *bodies,
                                        const struct geometry *geometry);

#endif
