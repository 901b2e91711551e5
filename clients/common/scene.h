/* A scene of a user or of a log together with the memory that it points to, and its pairs.
 * Independent of JSON and of the bus. */
#ifndef SCENE_H
#define SCENE_H

#include "fmb.h"
#include "ignored.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct owned_scene {
    struct fmb_scene scene; /* ids are unique */
    struct ignored ignored; /* its ignored pairs */
    int dim;                /* 2 or 3, of all bodies */
    const char **links;     /* [placement_count], the link that carries a body; NULL: none does */
    double outside;         /* how far hulls extend beyond the cylinders that they enclose */
    void **memory;          /* owned, [memory_count]: what the scene points to */
    size_t memory_count, memory_capacity;
};

/* Returns memory, all 0, that scene_clear() frees. Exits with status 1 if memory is exhausted. */
void *scene_alloc(struct owned_scene *scene, size_t count, size_t size);

/* Returns a copy of a text; NULL for "" and NULL. */
const char *scene_text(struct owned_scene *scene, const char *text);

/* A frame as it is given: what fmb_frame_make(), fmb_frame_make_vertices() or fmb_frame_make_hull()
 * takes, and fmb_frame_inflate(). */
struct given_frame {
    int shape; /* enum fmb_shape */
    bool by_vertices;
    size_t count;
    const double *numbers; /* [count] */
    double radius;         /* 0: none */
};

/* Returns an upper bound of the bytes of a body of these frames in a message: 1 for a shape, 4 for
 * a count of vertices, 8 for a number; repeated vertices of hulls are not sent. At most
 * FMB_CLIENT_BODY_BYTES_MAX can be queried. */
size_t scene_body_bytes(const struct given_frame *given, size_t count);

/* Makes a body of count frames. On output: FMB_OK and *out; or the status of the engine, and *bad
 * is the first frame that it refuses, or count. given is not used after the call. */
enum fmb_status scene_make_body(struct owned_scene *scene, const struct given_frame *given,
                                size_t count, const struct fmb_body **out, size_t *bad);

/* Prints how far the hulls of a file extend beyond its cylinders at most. outside: that length, or
 * 0 if there are no cylinders. */
void scene_report_outside(const char *file, double outside);

/* Makes ids unique: each placement whose id an earlier placement has gets the lowest free id.
 * anonymous: so do placements without an id. Returns the number of changed ids. */
size_t scene_free_ids(struct fmb_placement *placements, size_t count, bool anonymous);

/* Frees what the scene owns, and sets it to {0}, an empty scene. */
void scene_clear(struct owned_scene *scene);

/* Sets ignored from the placements and the ignored pairs of the scene. json_next() and
 * scene_of_query() call it; the functions below need it. They write to ignored, so a scene may be
 * used by one thread at a time. */
void scene_begin_ignored(struct owned_scene *scene);

/* Whether a pair is ignored, in either order, or within a group. */
bool scene_leaves_out(struct owned_scene *scene, unsigned a, unsigned b);

/* As pair_next(), of this scene. */
bool scene_next_pair(struct owned_scene *scene, struct pair_cursor *cursor, unsigned out[2]);

/* As scene_next_pair(), but also returns false at the pair `until`; the next call continues after
 * it. until: any pair of the scene, or NULL. */
bool scene_next_pair_before(struct owned_scene *scene, struct pair_cursor *cursor,
                            const unsigned until[2], unsigned out[2]);

/* Returns the number of these pairs. Cost: O(placements^2) with ALL. */
uint64_t scene_count_pairs(struct owned_scene *scene);

#endif
