/* Reports of an intersection of meshes: text and JSON. On output: ferror(out) is set if
 * writing failed; the caller also checks fclose(). */
#ifndef MESH_REPORT_H
#define MESH_REPORT_H

#include "mesh_intersect.h"

#include <stdio.h>

struct mesh_report {
    const struct mesh_query *query; /* not owned, as all members */
    const struct mesh *mesh[2];
    const char *name[2];
    const struct mesh_intersection *intersection;
};

/* Prints the counts as text. */
void mesh_report_text(FILE *out, const struct mesh_report *report);

/* Prints one line with one JSON object:
 *
 *     {"overlapping": N, "touching": N, "faces_a": N, "faces_b": N,
 *      "pairs": [[i, j, "overlapping"], ...]}
 *
 * If a mesh moves, the interval of contact follows the verdict. */
void mesh_report_json(FILE *out, const struct mesh_report *report);

#endif
