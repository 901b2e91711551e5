/* What met, as one page that shows it: both meshes in a picture that can be turned, faces that
 * overlap and touch in colours, a list of the pairs. The page holds all that it shows, and fetches
 * nothing; a picture has rounded coordinates, in single precision, from the middle of what is
 * drawn. */
#ifndef MESH_PAGE_H
#define MESH_PAGE_H

#include "mesh_report.h"

#include <stdio.h>

/* Limit on the pairs that a page lists; it has all faces, some 26 bytes each. */
enum { MESH_PAGE_PAIRS_MAX = 20000 };

/* Where out fails, ferror() tells. */
void mesh_page_write(FILE *out, const struct mesh_report *report);

#endif
