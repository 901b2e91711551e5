/* One parser for each file format. Each reads from the beginning of the source to its end into an
 * empty mesh. Returns true; or false, with the error in the source and a partial mesh that the
 * caller frees. */
#ifndef MESH_FORMATS_H
#define MESH_FORMATS_H

#include "mesh_source.h"

bool mesh_ply(struct mesh_source *source, struct mesh *out);
bool mesh_stl_ascii(struct mesh_source *source, struct mesh *out);
bool mesh_stl_binary(struct mesh_source *source, struct mesh *out);
bool mesh_obj(struct mesh_source *source, struct mesh *out);

/* Whether the file has the size that its facet count requires as binary STL. */
bool mesh_is_stl_binary(const struct mesh_source *source);

/* Whether the word at this position is one of the common keywords of OBJ. */
bool mesh_is_obj_statement(const unsigned char *at);

#endif
