#include "formats.h"

#include <string.h>

/* ---- PLY ------------------------------------------------------------------------------------- */

static void write_ply_header(FILE *out, const struct mesh *mesh, const char *format)
{
    fprintf(out,
            "ply\nformat %s 1.0\nelement vertex %zu\n"
            "property double x\nproperty double y\nproperty double z\n"
            "element face %zu\nproperty list uchar int vertex_indices\nend_header\n",
            format, mesh->vertex_count, mesh->face_count);
}

static void write_ply_ascii(FILE *out, const struct mesh *mesh)
{
    write_ply_header(out, mesh, "ascii");
    for (size_t i = 0; i < mesh->vertex_count; i++)
        fprintf(out, "%.6f %.6f %.6f\n", mesh->vertex[i][0], mesh->vertex[i][1],
                mesh->vertex[i][2]);
    for (size_t i = 0; i < mesh->face_count; i++)
        fprintf(out, "3 %u %u %u\n", mesh->face[i][0], mesh->face[i][1], mesh->face[i][2]);
}

static void put(FILE *out, uint64_t bits, int size, bool big_endian)
{
    for (int i = 0; i < size; i++)
        putc((int) (bits >> 8 * (big_endian ? size - 1 - i : i) & 0xff), out);
}

static void put_double(FILE *out, double value, bool big_endian)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(out, bits, sizeof bits, big_endian);
}

static void write_ply_binary(FILE *out, const struct mesh *mesh, bool big_endian)
{
    write_ply_header(out, mesh, big_endian ? "binary_big_endian" : "binary_little_endian");
    for (size_t i = 0; i < mesh->vertex_count; i++)
        for (int axis = 0; axis < 3; axis++)
            put_double(out, mesh->vertex[i][axis], big_endian);
    for (size_t i = 0; i < mesh->face_count; i++) {
        put(out, 3, 1, big_endian);
        for (int corner = 0; corner < 3; corner++)
            put(out, mesh->face[i][corner], 4, big_endian);
    }
}

static void write_ply_le(FILE *out, const struct mesh *mesh)
{
    write_ply_binary(out, mesh, false);
}

static void write_ply_be(FILE *out, const struct mesh *mesh)
{
    write_ply_binary(out, mesh, true);
}

/* ---- STL, with normals of 0, which say that none is given ------------------------------------ */

static void write_stl_ascii(FILE *out, const struct mesh *mesh)
{
    fprintf(out, "solid bumpy\n");
    for (size_t i = 0; i < mesh->face_count; i++) {
        fprintf(out, "  facet normal 0 0 0\n    outer loop\n");
        for (int corner = 0; corner < 3; corner++) {
            const double *at = mesh->vertex[mesh->face[i][corner]];
            fprintf(out, "      vertex %.6f %.6f %.6f\n", at[0], at[1], at[2]);
        }
        fprintf(out, "    endloop\n  endfacet\n");
    }
    fprintf(out, "endsolid bumpy\n");
}

static void put_float(FILE *out, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(out, bits, sizeof bits, false);
}

static void write_stl_binary(FILE *out, const struct mesh *mesh)
{
    fprintf(out, "%-80s", "bumpy");
    put(out, mesh->face_count, 4, false);
    for (size_t i = 0; i < mesh->face_count; i++) {
        for (int axis = 0; axis < 3; axis++)
            put_float(out, 0);
        for (int corner = 0; corner < 3; corner++)
            for (int axis = 0; axis < 3; axis++)
                put_float(out, (float) mesh->vertex[mesh->face[i][corner]][axis]);
        put(out, 0, 2, false);
    }
}

/* ---- OBJ ------------------------------------------------------------------------------------- */

static void write_obj(FILE *out, const struct mesh *mesh)
{
    fprintf(out, "# bumpy\n");
    for (size_t i = 0; i < mesh->vertex_count; i++)
        fprintf(out, "v %.6f %.6f %.6f\n", mesh->vertex[i][0], mesh->vertex[i][1],
                mesh->vertex[i][2]);
    for (size_t i = 0; i < mesh->face_count; i++)
        fprintf(out, "f %u %u %u\n", mesh->face[i][0] + 1, mesh->face[i][1] + 1,
                mesh->face[i][2] + 1);
}

/* ---- COLLADA, in the scene of one node ------------------------------------------------------- */

static void write_dae(FILE *out, const struct mesh *mesh)
{
    fprintf(out,
            "<?xml version=\"1.0\"?>\n<COLLADA version=\"1.4.1\">\n<library_geometries>"
            "<geometry id=\"g\"><mesh>\n<source id=\"p\"><float_array id=\"a\" count=\"%zu\">\n",
            3 * mesh->vertex_count);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        fprintf(out, "%.6f %.6f %.6f\n", mesh->vertex[i][0], mesh->vertex[i][1],
                mesh->vertex[i][2]);
    fprintf(out,
            "</float_array><technique_common><accessor source=\"#a\" count=\"%zu\" stride=\"3\"/>"
            "</technique_common></source>\n<vertices id=\"v\"><input semantic=\"POSITION\" "
            "source=\"#p\"/></vertices>\n<triangles count=\"%zu\"><input semantic=\"VERTEX\" "
            "source=\"#v\" offset=\"0\"/><p>\n",
            mesh->vertex_count, mesh->face_count);
    for (size_t i = 0; i < mesh->face_count; i++)
        fprintf(out, "%u %u %u\n", mesh->face[i][0], mesh->face[i][1], mesh->face[i][2]);
    fprintf(out,
            "</p></triangles></mesh></geometry></library_geometries>\n"
            "<library_visual_scenes><visual_scene id=\"s\"><node>"
            "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes>\n"
            "<scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>\n");
}

/* ---- All of them ----------------------------------------------------------------------------- */

const struct format formats[FORMAT_COUNT] = {
    {"ply-ascii", write_ply_ascii},
    {"ply-le", write_ply_le},
    {"ply-be", write_ply_be},
    {"stl-ascii", write_stl_ascii},
    {"stl-binary", write_stl_binary},
    {"obj", write_obj},
    {"dae", write_dae},
};
