/* Scenes as JSON text, in the form that json.h reads. */
#ifndef SCENE_JSON_H
#define SCENE_JSON_H

#include "json_write.h"
#include "scene.h"

#include <stdio.h>

/* Writes a scene with finite numbers so that it reads back as the same bits: one object on one
 * line. Check ferror(out) for write errors. */
void scene_json_write(FILE *out, struct owned_scene *scene);

/* Write members of a body: "frames"; "orientation", "velocity" and "end", where it has them. */
void scene_json_frames(struct json_writer *json, const struct fmb_body *body);
void scene_json_motion(struct json_writer *json, const struct fmb_placement *placement, int dim);

#endif
