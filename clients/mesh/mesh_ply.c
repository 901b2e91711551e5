/* Reads the body of a PLY file: the elements of each kind, one kind after the other, each with its
 * values in the order of its properties. */
#include "mesh_ply.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool read_coordinate(struct ply *ply, const struct ply_property *property, double *out)
{
    const unsigned char *where = ply_place(ply);
    if (!ply_value(ply, property->type, out))
        return false;
    return isfinite(*out) || ply_refuse(ply, where, "%c is not finite", "xyz"[property->role]);
}

/* Reads the length of a list. */
static bool read_length(struct ply *ply, const struct ply_property *property, uint32_t *out)
{
    const unsigned char *where = ply_place(ply);
    double value;
    if (!ply_value(ply, property->count, &value))
        return false;
    *out = value >= 0 && value <= UINT32_MAX ? (uint32_t) value : 0;
    return *out == value || ply_refuse(ply, where, "a list of %.10g values", value);
}

static bool read_index(struct ply *ply, const struct ply_property *property, unsigned *out)
{
    const unsigned char *where = ply_place(ply);
    double value;
    if (!ply_value(ply, property->type, &value))
        return false;
    *out = value >= 0 && value <= UINT32_MAX ? (unsigned) value : 0;
    if (*out == value && *out < ply->vertex_count)
        return true;
    return ply_refuse(ply, where, "index %.10g is no vertex: there are %zu, counted from 0", value,
                      ply->vertex_count);
}

static bool read_triangle(struct ply *ply, const struct ply_property *property, unsigned out[3])
{
    const unsigned char *where = ply_place(ply);
    uint32_t length;
    if (!read_length(ply, property, &length))
        return false;
    if (length != 3)
        return ply_refuse(ply, where, "a face of %u vertices: %s", (unsigned) length,
                          length > 3 ? "triangulate it first" : "remove it first");
    for (int corner = 0; corner < 3; corner++)
        if (!read_index(ply, property, &out[corner]))
            return false;
    return true;
}

/* Each value takes at least a byte, so a false length ends with the file. */
static bool skip_list(struct ply *ply, const struct ply_property *property)
{
    uint32_t length;
    if (!read_length(ply, property, &length))
        return false;
    while (length-- > 0)
        if (!ply_skip(ply, property->type))
            return false;
    return true;
}

static bool read_property(struct ply *ply, const struct ply_property *property, struct mesh *out)
{
    if (property->role == PLY_INDICES)
        return read_triangle(ply, property, out->face[ply->index]);
    if (property->role != PLY_UNUSED)
        return read_coordinate(ply, property, &out->vertex[ply->index][property->role]);
    if (property->count != PLY_NONE)
        return skip_list(ply, property);
    return ply_skip(ply, property->type);
}

static bool read_record(struct ply *ply, struct mesh *out)
{
    const struct ply_property *property = &ply->property[ply->within->first];
    if (!ply_begin_record(ply))
        return false;
    for (size_t i = 0; i < ply->within->property_count; i++)
        if (!read_property(ply, &property[i], out))
            return false;
    return ply_end_record(ply);
}

/* Elements without properties take no bytes, whatever their count. */
static bool read_element(struct ply *ply, const struct ply_element *element, struct mesh *out)
{
    ply->within = element;
    for (ply->index = 0; element->property_count > 0 && ply->index < element->count; ply->index++) {
        if (!read_record(ply, out))
            return false;
        mesh_report_progress(ply->source);
    }
    return true;
}

static bool allocate_element(struct ply *ply, const struct ply_element *element, struct mesh *out)
{
    if (element->kind == PLY_OTHERS || element->count == 0)
        return true;
    if (element->kind == PLY_VERTICES) {
        out->vertex = calloc(element->count, sizeof *out->vertex);
        out->vertex_count = element->count;
    } else {
        out->face = calloc(element->count, sizeof *out->face);
        out->face_count = element->count;
    }
    if (element->kind == PLY_VERTICES ? !!out->vertex : !!out->face)
        return true;
    return mesh_refuse_memory(ply->source, element->count,
                              element->kind == PLY_VERTICES ? "vertices" : "faces");
}

static bool read_end(struct ply *ply)
{
    struct mesh_source *source = ply->source;
    const unsigned char *at = mesh_skip_spaces(source->at);
    char text[MESH_WORD_MAX];
    if (at == source->end)
        return true;
    if (ply->format == PLY_ASCII)
        return mesh_refuse_line(source, at,
                                "'%s' behind the last element: a count is wrong, or "
                                "something was added",
                                mesh_word(source, at, text));
    return mesh_refuse_byte(source, source->at, NULL, 0,
                            "%zu bytes behind the last element: a count is wrong, or something was "
                            "added",
                            mesh_left(source));
}

bool mesh_ply(struct mesh_source *source, struct mesh *out)
{
    struct ply ply = {.source = source};
    if (!ply_header(&ply))
        return false;
    for (size_t i = 0; i < ply.element_count; i++)
        if (!allocate_element(&ply, &ply.element[i], out))
            return false;
    for (size_t i = 0; i < ply.element_count; i++)
        if (!read_element(&ply, &ply.element[i], out))
            return false;
    return read_end(&ply);
}
