/* Scenes as JSON text, in the form that json.h reads. */
#ifndef SCENE_JSON_H
#define SCENE_JSON_H

#include "scene.h"

#include <stdio.h>

/* Writes the scene, whose numbers are finite, so that it reads back as the same bits: one object, a
 * line for each body. Where out fails, ferror() tells. */
void scene_json_write(FILE *out, const struct scene *scene);

#endif
