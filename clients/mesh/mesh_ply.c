/* Reads the body of a PLY file: the elements of each kind, one kind after the other, each with its
 * values in the order of its properties. */
#include "mesh_ply.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

/* Sets the error at a value. Returns false. */
static bool __attribute__((format(printf, 3, 4)))
refuse(struct ply *ply, const unsigned char *where, const char *format, ...)
{
    char text[MESH_ERROR_MAX];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (ply->format == PLY_ASCII)
        return mesh_refuse_line(ply->source, where, "%s", text);
    return mesh_refuse_byte(ply->source, where, ply->within->name, ply->index, "%s", text);
}

/* Position of the next value. In ASCII files there may be none. */
static const unsigned char *place_of_next(const struct ply *ply)
{
    return ply->format == PLY_ASCII ? mesh_skip_blanks(ply->source->at) : ply->source->at;
}

/* ---- Text ------------------------------------------------------------------------------------ */

static bool text_value(struct ply *ply, double *value)
{
    const unsigned char *begin = mesh_skip_blanks(ply->source->at);
    const unsigned char *end = mesh_number(begin, value);
    char text[MESH_WORD_MAX];
    if (end && mesh_ends_word(ply->source, end)) {
        ply->source->at = end;
        return true;
    }
    if (begin == ply->source->end)
        return refuse(ply, begin, "the file ends within %s %zu", ply->within->name, ply->index);
    if (*begin == '\n')
        return refuse(ply, begin, "the line ends before all numbers of %s %zu", ply->within->name,
                      ply->index);
    return refuse(ply, begin, "'%s' is no number", mesh_word(ply->source, begin, text));
}

/* To be called before and after the values of each record: a vertex, a face or another element. In
 * ASCII files a record is a line. */
static bool begin_record(struct ply *ply)
{
    struct mesh_source *source = ply->source;
    if (ply->format != PLY_ASCII)
        return true;
    source->at = mesh_skip_spaces(source->at);
    if (source->at < source->end)
        return true;
    return refuse(ply, source->at, "the file ends before %s %zu of %zu", ply->within->name,
                  ply->index, ply->within->count);
}

static bool end_record(struct ply *ply)
{
    struct mesh_source *source = ply->source;
    char text[MESH_WORD_MAX];
    if (ply->format != PLY_ASCII)
        return true;
    source->at = mesh_skip_blanks(source->at);
    if (*source->at == '\n' || source->at == source->end)
        return true;
    return refuse(ply, source->at, "'%s' behind the last number of %s %zu",
                  mesh_word(source, source->at, text), ply->within->name, ply->index);
}

/* ---- Binary ---------------------------------------------------------------------------------- */

/* Every value of each type is a double. */
static double value_of(uint64_t bits, enum ply_type type)
{
    switch (type) {
    case PLY_INT8: return (int8_t) bits;
    case PLY_INT16: return (int16_t) bits;
    case PLY_INT32: return (int32_t) bits;
    case PLY_FLOAT32: return mesh_float((uint32_t) bits);
    case PLY_FLOAT64: return mesh_double(bits);
    default: return (double) bits;
    }
}

static bool binary_skip(struct ply *ply, size_t size)
{
    if (mesh_left(ply->source) < size)
        return refuse(ply, ply->source->end, "the file ends here");
    ply->source->at += size;
    return true;
}

static bool binary_value(struct ply *ply, enum ply_type type, double *value)
{
    const unsigned char *bytes = ply->source->at;
    const size_t size = ply_size(type);
    if (!binary_skip(ply, size))
        return false;
    *value = value_of(mesh_bits(bytes, size, ply->format == PLY_BIG_ENDIAN), type);
    return true;
}

/* ---- Both ------------------------------------------------------------------------------------ */

/* Reads the next value; skip_value() accepts any number, NaN included. Return false on error. */
static bool read_value(struct ply *ply, enum ply_type type, double *value)
{
    return ply->format == PLY_ASCII ? text_value(ply, value) : binary_value(ply, type, value);
}

static bool skip_value(struct ply *ply, enum ply_type type)
{
    double value;
    return ply->format == PLY_ASCII ? text_value(ply, &value) : binary_skip(ply, ply_size(type));
}

/* ---- Elements ------------------------------------------------------------------------------- */

static bool read_coordinate(struct ply *ply, const struct ply_property *property, double *out)
{
    const unsigned char *where = place_of_next(ply);
    if (!read_value(ply, property->type, out))
        return false;
    return isfinite(*out) || refuse(ply, where, "%c is not finite", "xyz"[property->role]);
}

/* Reads the length of a list. */
static bool read_length(struct ply *ply, const struct ply_property *property, uint32_t *out)
{
    const unsigned char *where = place_of_next(ply);
    double value;
    if (!read_value(ply, property->count, &value))
        return false;
    *out = value >= 0 && value <= UINT32_MAX ? (uint32_t) value : 0;
    return *out == value || refuse(ply, where, "a list of %.10g values", value);
}

static bool read_index(struct ply *ply, const struct ply_property *property, unsigned *out)
{
    const unsigned char *where = place_of_next(ply);
    double value;
    if (!read_value(ply, property->type, &value))
        return false;
    *out = value >= 0 && value <= UINT32_MAX ? (unsigned) value : 0;
    if (*out == value && *out < ply->vertex_count)
        return true;
    return refuse(ply, where, "index %.10g is no vertex: there are %zu, counted from 0", value,
                  ply->vertex_count);
}

static bool read_triangle(struct ply *ply, const struct ply_property *property, unsigned out[3])
{
    const unsigned char *where = place_of_next(ply);
    uint32_t length;
    if (!read_length(ply, property, &length))
        return false;
    if (length != 3)
        return refuse(ply, where, "a face of %u vertices: %s", (unsigned) length,
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
        if (!skip_value(ply, property->type))
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
    return skip_value(ply, property->type);
}

static bool read_record(struct ply *ply, struct mesh *out)
{
    const struct ply_property *property = &ply->property[ply->within->first];
    if (!begin_record(ply))
        return false;
    for (size_t i = 0; i < ply->within->property_count; i++)
        if (!read_property(ply, &property[i], out))
            return false;
    return end_record(ply);
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
    const bool vertices = element->kind == PLY_VERTICES;
    if (element->kind == PLY_OTHERS || element->count == 0)
        return true;
    void *memory = calloc(element->count, vertices ? sizeof *out->vertex : sizeof *out->face);
    if (!memory) {
        snprintf(ply->source->error, MESH_ERROR_MAX, "there is no memory for %zu %s",
                 element->count, vertices ? "vertices" : "faces");
        return false;
    }
    if (vertices) {
        out->vertex = memory;
        out->vertex_count = element->count;
    } else {
        out->face = memory;
        out->face_count = element->count;
    }
    return true;
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
