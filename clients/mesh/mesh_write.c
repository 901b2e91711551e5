#include "mesh_write.h"

#include <string.h>

static unsigned char *put(unsigned char *at, uint64_t bits, size_t size)
{
    for (size_t i = 0; i < size; i++)
        *at++ = (unsigned char) (bits >> 8 * i);
    return at;
}

static void write_header(FILE *out, const struct mesh *mesh, bool coloured)
{
    fprintf(out,
            "ply\n"
            "format binary_little_endian 1.0\n"
            "element vertex %zu\n"
            "property double x\n"
            "property double y\n"
            "property double z\n"
            "element face %zu\n"
            "property list uchar uint vertex_indices\n"
            "%s"
            "end_header\n",
            mesh->vertex_count, mesh->face_count,
            coloured ? "property uchar red\nproperty uchar green\nproperty uchar blue\n" : "");
}

static void write_vertex(FILE *out, const double position[3])
{
    unsigned char bytes[3 * sizeof(double)], *at = bytes;
    for (int axis = 0; axis < 3; axis++) {
        uint64_t bits;
        memcpy(&bits, &position[axis], sizeof bits);
        at = put(at, bits, sizeof bits);
    }
    fwrite(bytes, 1, (size_t) (at - bytes), out);
}

/* colour: red, green, blue; may be NULL. */
static void write_face(FILE *out, const unsigned corner[3], const unsigned char *colour)
{
    enum { INDEX_BYTES = 4 };
    unsigned char bytes[1 + 3 * INDEX_BYTES + 3], *at = put(bytes, 3, 1);
    for (int i = 0; i < 3; i++)
        at = put(at, corner[i], INDEX_BYTES);
    for (int i = 0; colour && i < 3; i++)
        at = put(at, colour[i], 1);
    fwrite(bytes, 1, (size_t) (at - bytes), out);
}

void mesh_write_ply(FILE *out, const struct mesh *mesh, const unsigned char (*face_colour)[3])
{
    write_header(out, mesh, face_colour != NULL);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        write_vertex(out, mesh->vertex[i]);
    for (size_t i = 0; i < mesh->face_count; i++)
        write_face(out, mesh->face[i], face_colour ? face_colour[i] : NULL);
}
