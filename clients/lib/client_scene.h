/* A caller's scene: checks it, iterates over its pairs, and converts its placements. */
#ifndef CLIENT_SCENE_H
#define CLIENT_SCENE_H

#include "fmb_client.h"
#include "query.h"

/* Checks a scene. Returns FMB_OK; or a status, and why has the place and the reason. */
int client_scene_check(const struct fmb_client_scene *scene, char why[FMB_CLIENT_WHY_MAX]);

/* Bytes of the encoded frames of a checked placement. */
size_t client_scene_geometry_bytes(const struct fmb_client_placement *placement);

/* On input: a checked placement; as many bytes of geometry. On output: *out with frames, which are
 * encoded in geometry. */
void client_scene_placement(const struct fmb_client_placement *of, unsigned char *geometry,
                            struct placement *out);

/* Replaces the frames by a handle. geometry: as in geometry_write_none(), of the dimension. */
void client_scene_use_handle(struct placement *placement, const struct handle *handle,
                             unsigned char geometry[GEOMETRY_NONE_BYTES]);

/* Iterates over the pairs in order, ignored ones included; all 0 at first. */
struct client_scene_cursor {
    size_t next; /* listed pairs: index of the next one */
    size_t a, b; /* else: the next pair; b is 0 before the first */
};

/* Returns true and the next pair, or false after the last one. */
bool client_scene_next_pair(const struct fmb_client_scene *scene,
                            struct client_scene_cursor *cursor, unsigned out[2]);

#endif
