#include "mesh_ply.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

bool ply_refuse(struct ply *ply, const unsigned char *where, const char *format, ...)
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

const unsigned char *ply_place(const struct ply *ply)
{
    return ply->format == PLY_ASCII ? mesh_skip_blanks(ply->source->at) : ply->source->at;
}

/* ---- Text ------------------------------------------------------------------------------------ */

/* In: the position of a number, and the position after it, or NULL if it cannot be parsed. */
static bool is_number(struct ply *ply, const unsigned char *begin, const unsigned char *end)
{
    char text[MESH_WORD_MAX];
    if (end && mesh_ends_word(ply->source, end)) {
        ply->source->at = end;
        return true;
    }
    if (begin == ply->source->end)
        return ply_refuse(ply, begin, "the file ends within %s %zu", ply->within->name, ply->index);
    if (*begin == '\n')
        return ply_refuse(ply, begin, "the line ends before all numbers of %s %zu",
                          ply->within->name, ply->index);
    return ply_refuse(ply, begin, "'%s' is no number", mesh_word(ply->source, begin, text));
}

static bool text_value(struct ply *ply, double *value)
{
    const unsigned char *begin = mesh_skip_blanks(ply->source->at);
    return is_number(ply, begin, mesh_number(begin, value));
}

bool ply_begin_record(struct ply *ply)
{
    struct mesh_source *source = ply->source;
    if (ply->format != PLY_ASCII)
        return true;
    source->at = mesh_skip_spaces(source->at);
    if (source->at < source->end)
        return true;
    return ply_refuse(ply, source->at, "the file ends before %s %zu of %zu", ply->within->name,
                      ply->index, ply->within->count);
}

bool ply_end_record(struct ply *ply)
{
    struct mesh_source *source = ply->source;
    char text[MESH_WORD_MAX];
    if (ply->format != PLY_ASCII)
        return true;
    source->at = mesh_skip_blanks(source->at);
    if (*source->at == '\n' || source->at == source->end)
        return true;
    return ply_refuse(ply, source->at, "'%s' behind the last number of %s %zu",
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
        return ply_refuse(ply, ply->source->end, "the file ends here");
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

bool ply_value(struct ply *ply, enum ply_type type, double *value)
{
    return ply->format == PLY_ASCII ? text_value(ply, value) : binary_value(ply, type, value);
}

bool ply_skip(struct ply *ply, enum ply_type type)
{
    double value;
    return ply->format == PLY_ASCII ? text_value(ply, &value) : binary_skip(ply, ply_size(type));
}
