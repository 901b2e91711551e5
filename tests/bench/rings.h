/* Hulls whose faces are known: points of an ellipsoid in rings about its axis, and its two poles.
 */
#ifndef RINGS_H
#define RINGS_H

#ifdef __cplusplus
extern "C" {
#endif

/* rings * sectors + 2 vertices; a ring has at least 3. */
struct rings {
    int rings, sectors;
};

int rings_vertices(struct rings rings);

/* In: the half axes. Out: vertex: [rings_vertices()][axis], whole multiples of 2^-20. */
void rings_points(struct rings rings, const double axis[3], double (*vertex)[3]);

/* The faces, each as its number of vertices and their indices, anticlockwise from outside; face may
 * be NULL. Returns how many numbers; *faces: how many faces. */
int rings_faces(struct rings rings, int *face, int *faces);

#ifdef __cplusplus
}
#endif

#endif
