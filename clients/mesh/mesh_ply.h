/* PLY: what a header says, and the values behind it. */
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

/* What a property is to a mesh. X, Y, Z are 0, 1, 2. */
enum ply_role { PLY_X, PLY_Y, PLY_Z, PLY_INDICES, PLY_UNUSED };

struct ply_property {
    enum ply_type type;  /* of the value, or of each of the list */
    enum ply_type count; /* of the list's length; NONE: no list */
    enum ply_role role;
};

enum ply_kind { PLY_VERTICES, PLY_FACES, PLY_OTHERS };

struct ply_element {
    enum ply_kind kind;
    const char *name;          /* of one: "vertex", "face", "element" */
    const unsigned char *line; /* of the header, where it is said */
    size_t count;
    size_t first, property_count; /* of the properties, those that are its own */
    unsigned roles;               /* a bit for each that one of them has */
};

struct ply {
    struct mesh_source *source;
    enum ply_format format;
    size_t element_count, property_count;
    struct ply_element element[PLY_ELEMENTS_MAX];
    struct ply_property property[PLY_PROPERTIES_MAX];
    size_t vertex_count;              /* as promised */
    const struct ply_element *within; /* of what is read, for errors */
    size_t index;
};

/* Bytes; 0 of NONE. */
size_t ply_size(enum ply_type type);

/* Reads the header, behind which the source is then. Each element has what a mesh needs of it. */
bool ply_header(struct ply *ply);

/* Of the value that is there, or was. Returns false. */
bool ply_refuse(struct ply *ply, const unsigned char *where, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The next value. The second one is only looked for, and may be any number, NaN too. */
bool ply_value(struct ply *ply, enum ply_type type, double *value);
bool ply_skip(struct ply *ply, enum ply_type type);

/* Before and behind the values of each vertex, face or other element: of text it is a line. */
bool ply_begin_record(struct ply *ply);
bool ply_end_record(struct ply *ply);

/* Where the next value begins; of text there may be none. */
const unsigned char *ply_place(const struct ply *ply);

#endif
