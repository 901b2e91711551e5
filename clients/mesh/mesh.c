#include "mesh.h"

#include "mesh_formats.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static bool begins_with(const struct mesh_source *source, const char *text)
{
    const size_t length = strlen(text);
    return strncasecmp((const char *) source->at, text, length) == 0;
}

static bool ends_with(const char *name, const char *ending)
{
    const size_t length = strlen(name), wanted = strlen(ending);
    return length >= wanted && strcasecmp(name + length - wanted, ending) == 0;
}

/* Text has no byte that is 0; the count of a binary STL file has one, unless there are more than
 * sixteen million facets. */
static bool has_zero(const struct mesh_source *source)
{
    const size_t some = 512, size = mesh_left(source);
    return memchr(source->at, 0, size < some ? size : some) != NULL;
}

/* The first thing that is no comment. */
static const unsigned char *first_statement(const struct mesh_source *source)
{
    const unsigned char *at = mesh_skip_spaces(source->at);
    while (*at == '#') {
        while (*at != '\n' && at < source->end)
            at++;
        at = mesh_skip_spaces(at);
    }
    return at;
}

static bool read_unknown(struct mesh_source *source)
{
    return mesh_refuse_byte(source, source->begin, NULL, 0,
                            "no PLY, STL or OBJ file, by its name nor by its contents");
}

static bool read_any(struct mesh_source *source, const char *name, struct mesh *out)
{
    static const char mark[] = "\xef\xbb\xbf"; /* of UTF-8 */
    if (source->at == source->end)
        return mesh_refuse_byte(source, source->begin, NULL, 0, "the file is empty");
    if (begins_with(source, "ply") && mesh_is_space(source->at[3]))
        return mesh_ply(source, out);
    if (mesh_is_stl_binary(source))
        return mesh_stl_binary(source, out);
    if (begins_with(source, mark))
        source->at += strlen(mark);
    const unsigned char *first = mesh_skip_spaces(source->at);
    if (strncasecmp((const char *) first, "solid", 5) == 0 && mesh_ends_word(source, first + 5) &&
        !has_zero(source))
        return mesh_stl_ascii(source, out);
    if (ends_with(name, ".obj"))
        return mesh_obj(source, out);
    if (ends_with(name, ".stl"))
        return mesh_stl_binary(source, out);
    if (ends_with(name, ".ply"))
        return mesh_ply(source, out);
    return mesh_is_obj_statement(first_statement(source)) ? mesh_obj(source, out)
                                                          : read_unknown(source);
}

bool mesh_parse(const void *bytes, size_t size, const char *name, const struct mesh_watch *watch,
                struct mesh *out, char error[MESH_ERROR_MAX])
{
    struct mesh_source source = {.begin = bytes, .watch = watch, .error = error};
    source.at = source.told = source.begin;
    source.end = source.begin + size;
    error[0] = '\0';
    *out = (struct mesh){0};
    if (read_any(&source, name, out))
        return true;
    mesh_free(out);
    return false;
}

void mesh_free(struct mesh *mesh)
{
    free(mesh->vertex);
    free(mesh->face);
    *mesh = (struct mesh){0};
}
