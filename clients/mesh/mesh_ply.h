/* PLY: the parsed header, and the values after it. */
#ifndef MESH_PLY_H
#define MESH_PLY_H

#include "mesh_source.h"

enum { PLY_ELEMENTS_MAX = 64, PLY_PROPERTIES_MAX = 256 };

enum ply_format { PLY_ASCII, PLY_LITTLE_ENDIAN, PLY_BIG_ENDIAN };

enum ply_type {
    PLY_NONE,
    PLY_INT8,
    PLY_UINT8,
    PLY_INT16,
    PLY_UINT16,
    PLY_INT32,
    PLY_UINT32,
    PLY_FLOAT32,
    PLY_FLOAT64
};

/* The meaning of a property. X, Y, Z are 0, 1, 2. */
enum ply_role { PLY_X, PLY_Y, PLY_Z, PLY_INDICES, PLY_UNUSED };

struct ply_property {
    enum ply_type type;  /* of the value, or of a list's elements */
    enum ply_type count; /* of a list's length; NONE: not a list */
    enum ply_role role;
};

enum ply_kind { PLY_VERTICES, PLY_FACES, PLY_OTHERS };

struct ply_element {
    enum ply_kind kind;
    const char *name;          /* singular: "vertex", "face", "element" */
    const unsigned char *line; /* its line in the header */
    size_t count;
    size_t first, property_count; /* its range of ply.property */
    unsigned roles;               /* set of enum ply_role, one bit each */
};

struct ply {
    struct mesh_source *source;
    enum ply_format format;
    size_t element_count, property_count;
    struct ply_element element[PLY_ELEMENTS_MAX];
    struct ply_property property[PLY_PROPERTIES_MAX];
    size_t vertex_count;              /* as the header states */
    const struct ply_element *within; /* the element being read and the index in it, for errors */
    size_t index;
};

/* Size of a value, bytes; 0 for NONE. */
size_t ply_size(enum ply_type type);

/* Reads the header, and advances the source past it. On output: each element has the properties
 * that a mesh needs. Returns false on error. */
bool ply_header(struct ply *ply);

#endif
