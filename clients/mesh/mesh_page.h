/* Writes an intersection as an HTML page: a picture of both meshes that can be rotated, with
 * overlapping and touching faces in colours, and a list of the pairs. The page contains all its
 * data and fetches nothing. The coordinates of the picture are rounded to single precision,
 * relative to the centre. */
#ifndef MESH_PAGE_H
#define MESH_PAGE_H

#include "mesh_report.h"

#include <stdio.h>

/* Limit on the pairs that a page lists. All faces are included, some 26 bytes each. */
enum { MESH_PAGE_PAIRS_MAX = 20000 };

/* On output: ferror(out) is set if writing failed. */
void mesh_page_write(FILE *out, const struct mesh_report *report);

#endif
