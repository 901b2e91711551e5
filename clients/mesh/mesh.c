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

static bool read_any(struct mesh_source *source, const char *name, struct mesh *out)
{
    if (source->at == source->end)
        return mesh_refuse_byte(source, source->begin, NULL, 0, "the file is empty");
    if (begins_with(source, "ply") && mesh_is_space(source->at[3]))
        return mesh_ply(source, out);
    if (ends_with(name, ".ply"))
        return mesh_ply(source, out);
    return mesh_refuse_byte(source, source->begin, NULL, 0, "no PLY file");
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
