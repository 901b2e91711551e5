/* Writing a mesh as PLY. */
#ifndef MESH_WRITE_H
#define MESH_WRITE_H

#include "mesh.h"

#include <stdio.h>

/* Binary, little-endian on every machine; coordinates are doubles, so that reading it gives the
 * same bits. face_colour: red, green and blue of each face, or NULL. Whether all was written is
 * for the caller to ask, with ferror() and what closing says. */
void mesh_write_ply(FILE *out, const struct mesh *mesh, const unsigned char (*face_colour)[3]);

#endif
