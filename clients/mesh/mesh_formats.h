/* The kinds of files that meshes are read from. Each function reads from the beginning of the
 * source to its end into an empty mesh; on output true, or false and the error, and whatever the
 * mesh holds then is for the caller to free. */
#ifndef MESH_FORMATS_H
#define MESH_FORMATS_H

#include "mesh_source.h"

bool mesh_ply(struct mesh_source *source, struct mesh *out);
bool mesh_stl_ascii(struct mesh_source *source, struct mesh *out);
bool mesh_stl_binary(struct mesh_source *source, struct mesh *out);
bool mesh_obj(struct mesh_source *source, struct mesh *out);

/* Whether it is of a size that binary STL has. */
bool mesh_is_stl_binary(const struct mesh_source *source);

/* Whether the word there begins a statement of OBJ. */
bool mesh_is_obj_statement(const unsigned char *at);

#endif
