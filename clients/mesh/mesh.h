/* Meshes of triangles, and reading them from files of three kinds:
 *
 *     PLY 1.0  ASCII, and binary of both byte orders; any elements and properties besides those
 *              that are needed, in any order
 *     STL      ASCII and binary
 *     OBJ      v and f; what defines no surface is passed over
 *
 * Of which kind a file is, is told by its contents: "ply" and the end of a line; a size of 84 + 50
 * n bytes where binary STL has its number n of facets; "solid"; and else by the end of its name, or
 * by its first statement.
 *
 * Numbers. Of text each coordinate is the double that is nearest to what is written, whatever type
 * a PLY header declares for it: "0.1" of a float is 0.1, not the float nearest to it. Of binary
 * files it is what is there, which every double can be. Coordinates are finite; what is not is
 * refused.
 *
 * Faces are triangles: another face is refused. One whose vertices coincide or lie on a line is
 * kept, so is a vertex of no face. A mesh may be empty.
 *
 * Vertices have the order of the file in PLY and OBJ. STL has no indices: there, vertices of equal
 * coordinates are one, 0 and -0 being equal, in the order of their first appearance; normals and
 * attributes are passed over.
 *
 * Nothing that a file promises is believed: what has no room in the bytes that are there is refused
 * before memory is asked for. Behind the last element of a PLY file white space may follow, and
 * nothing else; a binary STL file has just the bytes of its facets. */
#ifndef MESH_H
#define MESH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct mesh {
    size_t vertex_count, face_count; /* both below 2^32 - 1 */
    double (*vertex)[3];             /* owned; [vertex][x, y, z]; NULL where there are none */
    unsigned (*face)[3];             /* owned; [face][corner], indices of vertices; likewise */
};

/* Room for one line that says what is wrong, and where: "line 17: ...", from 1, of text; "byte 1234
 * (face 17): ..." of what is binary. Bytes, vertices and faces count from 0. */
enum { MESH_ERROR_MAX = 256 };

/* Who wants to know how far it is: called now and then with how many bytes are done, of all that
 * the file has. */
struct mesh_watch {
    void (*told)(void *context, uint64_t done, uint64_t total);
    void *context;
};

/* On output: true and a mesh, which the caller gives to mesh_free(); or false, an empty mesh, and
 * what is wrong. The file is in memory while it is read, and no longer; what is no regular file is
 * refused, and never waited for. watch: may be NULL. */
bool mesh_read(const char *path, const struct mesh_watch *watch, struct mesh *out,
               char error[MESH_ERROR_MAX]);

/* Likewise of bytes that are in memory, of a file of that name, which may be "". A 0 stands behind
 * them, at bytes[size]. */
bool mesh_parse(const void *bytes, size_t size, const char *name, const struct mesh_watch *watch,
                struct mesh *out, char error[MESH_ERROR_MAX]);

/* Leaves an empty mesh. */
void mesh_free(struct mesh *mesh);

#endif
