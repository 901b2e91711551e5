/* A caller's scene: checks it, and converts its placements. */
#ifndef CLIENT_SCENE_H
#define CLIENT_SCENE_H

#include "fmb_client.h"
#include "geometry.h"

/* Checks a scene. Returns FMB_OK and why is ""; or a status, and why names the place and the
 * reason. */
int client_scene_check(const struct fmb_scene *scene, char why[FMB_CLIENT_WHY_MAX]);

/* Bytes of the encoded frames of a body. */
size_t client_scene_geometry_bytes(const struct fmb_body *body);

/* Converts a checked placement; service/answer/body.h makes a body of the result. handle: of its
 * body; NULL: the frames are sent, in bytes: memory of client_scene_geometry_bytes(), which must
 * outlive *out. */
void client_scene_placement(const struct fmb_placement *of, const struct handle *handle,
                            unsigned char *bytes, struct query_placement *out);

#endif
