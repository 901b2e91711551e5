#define _FILE_OFFSET_BITS 64
#include "mesh.h"

#include "mesh_source.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

/* ---- Formats --------------------------------------------------------------------------------- */

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

/* Text contains no 0 byte. The facet count of a binary STL file does, unless there are more than
 * sixteen million facets. */
static bool has_zero(const struct mesh_source *source)
{
    const size_t some = 512, size = mesh_left(source);
    return memchr(source->at, 0, size < some ? size : some) != NULL;
}

/* Position of the first statement, after comments. */
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
    return mesh_refuse(source, source->begin,
                       "no PLY, STL, OBJ or COLLADA file, by its name nor by its contents");
}

static bool read_any(struct mesh_source *source, const char *name)
{
    static const char mark[] = "\xef\xbb\xbf"; /* UTF-8 byte order mark */
    if (source->at == source->end)
        return mesh_refuse(source, source->begin, "the file is empty");
    if (begins_with(source, "version https://git-lfs."))
        return mesh_refuse(source, source->begin,
                           "a Git LFS pointer, not the mesh: run 'git lfs pull'");
    if (begins_with(source, "ply") && mesh_is_space(source->at[3]))
        return mesh_ply(source);
    if (mesh_is_stl_binary(source))
        return mesh_stl_binary(source);
    if (begins_with(source, mark))
        source->at += strlen(mark);
    const unsigned char *first = mesh_skip_spaces(source->at);
    if (*first == '<' || ends_with(name, ".dae"))
        return mesh_dae(source);
    if (strncasecmp((const char *) first, "solid", 5) == 0 && mesh_ends_word(source, first + 5) &&
        !has_zero(source))
        return mesh_stl_ascii(source);
    if (ends_with(name, ".obj"))
        return mesh_obj(source);
    if (ends_with(name, ".stl"))
        return mesh_stl_binary(source);
    if (ends_with(name, ".ply"))
        return mesh_ply(source);
    return mesh_is_obj_statement(source, first_statement(source)) ? mesh_obj(source)
                                                                  : read_unknown(source);
}

bool mesh_parse(const void *bytes, size_t size, const char *name, enum mesh_faces faces,
                struct mesh *out, char error[MESH_ERROR_MAX])
{
    struct mesh_source source = {.begin = bytes, .faces = faces, .error = error};
    source.at = source.begin;
    source.end = source.begin + size;
    error[0] = '\0';
    const bool good = read_any(&source, name);
    if (!good)
        mesh_free(&source.mesh);
    *out = source.mesh;
    return good;
}

void mesh_free(struct mesh *mesh)
{
    free(mesh->vertex);
    free(mesh->face);
    free(mesh->object);
    *mesh = (struct mesh){0};
}

/* ---- Files ----------------------------------------------------------------------------------- */

/* Returns the bytes of a file, which the caller frees; or NULL, and the error. fopen() of a pipe
 * would block. */
static unsigned char *read_file(const char *path, size_t *size, char error[MESH_ERROR_MAX])
{
    struct stat about = {0};
    FILE *file = NULL;
    unsigned char *bytes = NULL;
    size_t done = 0;
    if (stat(path, &about) != 0 || (S_ISREG(about.st_mode) && !(file = fopen(path, "rbe"))))
        snprintf(error, MESH_ERROR_MAX, "%s", strerror(errno));
    else if (!file)
        snprintf(error, MESH_ERROR_MAX, "%s",
                 S_ISDIR(about.st_mode) ? "a folder, not a file"
                                        : "no regular file: write what it gives into one first");
    *size = (size_t) about.st_size;
    if (file && !(bytes = malloc(*size + 1)))
        snprintf(error, MESH_ERROR_MAX, "there is no memory for its %zu bytes", *size);
    else if (file && (done = fread(bytes, 1, *size, file)) < *size)
        snprintf(error, MESH_ERROR_MAX, "byte %zu: %s", done,
                 ferror(file) ? strerror(errno) : "the file became shorter while it was read");
    if (file)
        fclose(file);
    if (bytes && done == *size) {
        bytes[*size] = '\0';
        return bytes;
    }
    free(bytes);
    return NULL;
}

bool mesh_read(const char *path, enum mesh_faces faces, struct mesh *out,
               char error[MESH_ERROR_MAX])
{
    size_t size = 0;
    *out = (struct mesh){0};
    unsigned char *bytes = read_file(path, &size, error);
    const bool good = bytes && mesh_parse(bytes, size, path, faces, out, error);
    free(bytes);
    return good;
}
