/* Writes a mesh as PLY. */
#ifndef MESH_WRITE_H
#define MESH_WRITE_H

#include "mesh.h"

#include <stdio.h>

/* Writes binary little-endian PLY with double coordinates, so that reading it gives the same bits.
 * face_colour: red, green, blue of each face; NULL: none. On output: ferror(out) is set if writing
 * failed; the caller also checks fclose(). */
void mesh_write_ply(FILE *out, const struct mesh *mesh, const unsigned char (*face_colour)[3]);

#endif
