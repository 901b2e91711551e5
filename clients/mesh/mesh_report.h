/* What is told of a meeting of meshes. */
#ifndef MESH_REPORT_H
#define MESH_REPORT_H

#include "mesh_meet.h"

#include <stdio.h>

struct mesh_report {
    const struct mesh_question *question; /* what was asked */
    const struct mesh *mesh[2];           /* the same: one with itself */
    const char *name[2];
    const struct mesh_meeting *meeting;
};

/* For people; list: every pair too. */
void mesh_report_text(FILE *out, const struct mesh_report *report, bool list);

/* One line, one object:
 *
 *     {"overlapping": N, "touching": N, "faces_a": N, "faces_b": N, "pairs": [[i, j,
 * "overlapping"],
 *      ...]}
 *
 * with the times of contact behind the verdict where a mesh moves, and with "sharing_edge" and
 * "sharing_vertex" before the pairs of one mesh with itself. */
void mesh_report_json(FILE *out, const struct mesh_report *report);

/* Both meshes as one, in colours. */
void mesh_report_ply(FILE *out, const struct mesh_report *report);

#endif
