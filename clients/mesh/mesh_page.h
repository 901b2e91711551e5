/* What met, as one page that shows it: both meshes in a picture that can be turned, faces that
 * overlap and touch in colours, a list of the pairs. The page holds all that it shows, and fetches
 * nothing; a picture has rounded coordinates, in single precision, from the middle of what is
 * drawn. */
#ifndef MESH_PAGE_H
#define MESH_PAGE_H

#include "mesh_report.h"

#include <stdio.h>

/* What a page holds at most: so many pairs, the first ones; and so many bytes of faces and their
 * vertices. Beyond them faces are left out evenly (mesh_thin.h), those of the pairs never, which
 * take no more than 3 MB. Names and pairs take another 3 MB at most. */
enum { MESH_PAGE_PAIRS_MAX = 20000, MESH_PAGE_BYTES_MAX = 12 << 20 };

/* Where out fails, ferror() tells. */
void mesh_page_write(FILE *out, const struct mesh_report *report);

#endif
