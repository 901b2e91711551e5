/* Triangle meshes, read from files of four formats:
 *
 *     PLY 1.0  ASCII, and binary of both byte orders; any elements and properties besides those
 *              that are needed, in any order
 *     STL      ASCII and binary
 *     OBJ      v and f; statements that define no surface are skipped
 *     COLLADA  the scene of the file: the triangles and polygons of its nodes, with their
 *              transformations, and its unit of length; its up axis is not applied
 *
 * The format is detected from the contents, in this order: "ply" and the end of a line; a size of
 * 84 + 50 n bytes where binary STL stores its facet count n; "<" of COLLADA; "solid". If none of
 * these apply, the extension of the file name decides, then the first statement.
 *
 * Numbers. A coordinate in text is the double nearest to the decimal number, whatever type a PLY
 * header declares for it: "0.1" of a float is 0.1, not the float nearest to it. A coordinate in a
 * binary file is its exact value; every value of each type is a double. Coordinates that are not
 * finite are an error.
 *
 * Faces are triangles; any other face is an error. A face whose vertices coincide or are collinear
 * is kept, and so is a vertex without a face. A mesh may be empty.
 *
 * Vertices are in the order of the file in PLY and OBJ, and of instances in COLLADA. STL has no
 * indices: vertices with equal coordinates (0 equals -0) become one, in the order of their first
 * appearance. Normals and attributes of STL are ignored.
 *
 * Counts in a file are not trusted: memory grows with the elements that are read. After the last
 * element of a PLY file only white space may follow; a binary STL file holds exactly the bytes of
 * its facets. */
#ifndef MESH_H
#define MESH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct mesh {
    size_t vertex_count, face_count; /* both below 2^32 - 1 */
    double (*vertex)[3];             /* owned; [vertex][x, y, z]; NULL if there are none */
    unsigned (*face)[3]; /* owned; [face][corner], indices of vertices; NULL if there are none */
    /* Owned; [object_count]: the number of faces before each object (o) of an OBJ; NULL: none */
    size_t *object, object_count;
    /* COLLADA: metres per unit of length, by which coordinates were multiplied; 0: the file gives
     * none, or has another format. */
    double unit;
};

/* Most bytes of an error text, final 0 included: one line that states what is wrong and where.
 * "line 17: ..." in text, counted from 1; "byte 1234 (face 17): ..." in binary files. Bytes,
 * vertices and faces count from 0. */
enum { MESH_ERROR_MAX = 256 };

/* What is read besides triangles. */
enum mesh_faces {
    MESH_TRIANGLES, /* nothing: the mesh is refused */
    MESH_POLYGONS   /* faces of more vertices, as a fan of triangles, which has the same hull */
};

/* Reads a mesh from a regular file. The whole file is in memory during the call. Progress
 * is counted in bytes (progress.h). Returns true and a mesh, which the caller passes to
 * mesh_free(); or false, an empty mesh and the error. A path that is not a regular file is an
 * error, and never blocks. */
bool mesh_read(const char *path, enum mesh_faces faces, struct mesh *out,
               char error[MESH_ERROR_MAX]);

/* As mesh_read(), from a file in memory. In: bytes[size] must be readable and 0; name: of the file,
 * may be ""; only its extension is used. */
bool mesh_parse(const void *bytes, size_t size, const char *name, enum mesh_faces faces,
                struct mesh *out, char error[MESH_ERROR_MAX]);

/* Frees the arrays. On output: an empty mesh. */
void mesh_free(struct mesh *mesh);

#endif
