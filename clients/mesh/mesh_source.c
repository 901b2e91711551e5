#include "mesh_source.h"

#include "allocate.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Counted only for an error, not while parsing. */
static uint64_t line_of(const struct mesh_source *source, const unsigned char *where)
{
    uint64_t line = 1;
    const unsigned char *at = source->begin;
    while ((at = memchr(at, '\n', (size_t) (where - at)))) {
        line++;
        at++;
    }
    return line;
}

bool mesh_refuse(struct mesh_source *source, const unsigned char *where, const char *format, ...)
{
    va_list arguments;
    char place[80] = "";
    if (source->text)
        snprintf(place, sizeof place, "line %" PRIu64, line_of(source, where));
    else if (source->within)
        snprintf(place, sizeof place, "byte %td (%s %zu)", where - source->begin, source->within,
                 source->index);
    else
        snprintf(place, sizeof place, "byte %td", where - source->begin);
    const int length = snprintf(source->error, MESH_ERROR_MAX, "%s: ", place);
    va_start(arguments, format);
    vsnprintf(source->error + length, (size_t) (MESH_ERROR_MAX - length), format, arguments);
    va_end(arguments);
    return false;
}

const char *mesh_word(const struct mesh_source *source, const unsigned char *at,
                      char text[MESH_WORD_MAX])
{
    size_t length = 0;
    while (!mesh_ends_word(source, at) && length < MESH_WORD_MAX - 1) {
        text[length++] = *at > ' ' && *at < 0x7f ? (char) *at : '?';
        at++;
    }
    text[length] = '\0';
    if (!mesh_ends_word(source, at))
        memcpy(text + MESH_WORD_MAX - 4, "...", 4);
    return text;
}

void mesh_skip_line(struct mesh_source *source)
{
    const unsigned char *end = memchr(source->at, '\n', mesh_left(source));
    source->at = end ? end : source->end;
}

/* strtod() also accepts hexadecimal numbers and nan(...). Here a number ends before the x and
 * before the parenthesis. */
const unsigned char *mesh_number(const unsigned char *at, double *value)
{
    const unsigned char *first = at + (*at == '-' || *at == '+');
    char *end;
    *value = strtod((const char *) at, &end);
    if (end == (const char *) at || mesh_is_space(*at))
        return NULL;
    if (isnan(*value))
        return first + strlen("nan");
    if (first[0] != '0' || (first[1] != 'x' && first[1] != 'X'))
        return (const unsigned char *) end;
    *value = *at == '-' ? -0.0 : 0;
    return first + 1;
}

/* ---- Vertices and faces ---------------------------------------------------------------------- */

static bool has_count(struct mesh_source *source, size_t count, const char *what)
{
    return count < MESH_COUNT_MAX ||
           mesh_refuse(source, source->at, "more than %u %s", MESH_COUNT_MAX, what);
}

bool mesh_add_vertex(struct mesh_source *source, const double position[3])
{
    struct mesh *mesh = &source->mesh;
    if (!has_count(source, mesh->vertex_count, "vertices"))
        return false;
    mesh->vertex = allocate_grow(mesh->vertex, &source->vertex_capacity, mesh->vertex_count + 1,
                                 sizeof *mesh->vertex);
    memcpy(mesh->vertex[mesh->vertex_count++], position, sizeof *mesh->vertex);
    return true;
}

bool mesh_add_face(struct mesh_source *source, const unsigned corner[3])
{
    struct mesh *mesh = &source->mesh;
    if (!has_count(source, mesh->face_count, "faces"))
        return false;
    mesh->face =
        allocate_grow(mesh->face, &source->face_capacity, mesh->face_count + 1, sizeof *mesh->face);
    memcpy(mesh->face[mesh->face_count++], corner, sizeof *mesh->face);
    return true;
}

bool mesh_add_corner(struct mesh_source *source, size_t n, unsigned vertex)
{
    unsigned *corner = source->corner;
    if (n >= 3)
        corner[1] = corner[2];
    corner[n < 3 ? n : 2] = vertex;
    return n < 2 || mesh_add_face(source, corner);
}

bool mesh_check_face(struct mesh_source *source, const unsigned char *where, size_t count)
{
    return count == 3 || (count > 3 && source->faces == MESH_POLYGONS) ||
           mesh_refuse(source, where, "a face of %zu vertices: %s", count,
                       count > 3 ? "triangulate it first" : "remove it first");
}
