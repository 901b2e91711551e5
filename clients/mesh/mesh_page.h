/* A page that shows two meshes and the pairs of faces that meet. */
#ifndef MESH_PAGE_H
#define MESH_PAGE_H

#include "mesh_intersect.h"
#include "output.h"

/* Writes the page, if a file is wanted. Each face in one of the first PAGE_PAIRS_MAX - 1 pairs is a
 * body of its own. The other faces of a mesh are two bodies: one of the faces that meet the other
 * mesh, one of the faces that do not. Returns false after an error, which was reported. */
bool mesh_page_save(const struct mesh_query *query, const struct mesh_intersection *found,
                    const char *title, const struct output_options *options);

#endif
