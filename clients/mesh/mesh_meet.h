/* Which faces of two meshes meet, or of one mesh with itself: a tree of boxes for each (fmb.h)
 * finds the pairs that may, and each of these is decided. */
#ifndef MESH_MEET_H
#define MESH_MEET_H

#include "fmb.h"
#include "mesh.h"

/* What a face is. */
enum mesh_as {
    /* The triangle of its vertices, exactly: no edge is rounded. */
    MESH_FACES,
    /* The article's tetrahedron, from its first vertex: the edges c0 and c1 to the other two,
     * rounded, and c2, c1 x c0 divided by its length, or 0 where that is none. */
    MESH_TETRAHEDRA
};

struct mesh_question {
    const struct mesh *a, *b; /* the same: one mesh with itself, as FACES */
    enum mesh_as as;
    const double *velocity[2];       /* [3] of a and of b, finite; or NULL: at rest */
    double duration;                 /* of the window, seconds; not negative, finite */
    const struct fmb_method *method; /* NULL: certified, many at a time */
    /* NULL, or who wants to know how much of the work is done: about how many faces of a. */
    void (*told)(void *context, uint64_t done, uint64_t total);
    void *context;
};

struct mesh_pair {
    unsigned a, b; /* faces; of one mesh a < b */
    enum fmb_verdict verdict;
    double contact[2]; /* seconds; where one of the meshes has a velocity */
};

struct mesh_meeting {
    struct mesh_pair *pair; /* owned; in the order of a, then of b */
    size_t count, room;
    size_t overlapping, touching; /* of them */
    size_t faces[2];              /* of a and of b that are in a pair; of one mesh both the same */
    /* Owned; [face] of a and of b: OVERLAPPING where it overlaps another, else TOUCHING where it
     * touches one, else 0. Of one mesh both the same. */
    unsigned char *worst[2];
    uint64_t candidates; /* pairs that were decided */
    /* Of one mesh: pairs of faces that have an edge in common, or a vertex, and no other point.
     * They are in no other number. */
    uint64_t sharing_edge, sharing_vertex;
    bool moving;
    int64_t build_ns, ask_ns; /* how long it took to make the trees, and the rest */
};

/* On input: meshes of mesh_transform().
 * On output: FMB_OK, and a meeting for mesh_meeting_free(). Or nothing to free, and FMB_NOT_FINITE
 * where the normal of a face is beyond the doubles (TETRAHEDRA), or FMB_CANNOT_DECIDE by this
 * method. Memory is that of allocate.h. */
enum fmb_status mesh_meet(const struct mesh_question *question, struct mesh_meeting *out);
void mesh_meeting_free(struct mesh_meeting *meeting);

#endif
