/* A caller's scene: checks it, iterates over its pairs, and converts its placements. */
#ifndef CLIENT_SCENE_H
#define CLIENT_SCENE_H

#include "fmb_client.h"
#include "geometry.h"

/* Checks a scene. Returns FMB_OK and why is ""; or a status, and why names the place and the
 * reason.
 */
int client_scene_check(const struct fmb_scene *scene, char why[FMB_CLIENT_WHY_MAX]);

/* Bytes of the encoded frames of a body. */
size_t client_scene_geometry_bytes(const struct fmb_body *body);

/* Converts a checked placement. geometry: memory of client_scene_geometry_bytes(). On output:
 * *out has the frames, encoded in geometry, which must outlive it. */
void client_scene_placement(const struct fmb_placement *of, unsigned char *geometry,
                            struct placement *out);

/* Replaces the frames by a handle. geometry: memory for geometry_write_none(), which must outlive
 * the placement. */
void client_scene_use_handle(struct placement *placement, const struct handle *handle,
                             unsigned char geometry[GEOMETRY_NONE_BYTES]);

/* Iterates over the pairs in order, including ignored ones and those within a group; {0} at first.
 */
struct client_scene_cursor {
    size_t next; /* listed pairs: index of the next one */
    size_t a, b; /* else: the next pair; b is 0 before the first */
};

/* Whether two placements are of one group. */
bool client_scene_is_within_group(const struct fmb_scene *scene, const unsigned pair[2]);

/* Whether the pair comes before first_pair; false for listed pairs, whose cursor begins there. */
bool client_scene_is_before_first(const struct fmb_scene *scene, const unsigned pair[2]);

/* Returns true and the next pair, or false after the last one. */
bool client_scene_next_pair(const struct fmb_scene *scene, struct client_scene_cursor *cursor,
                            unsigned out[2]);

#endif
