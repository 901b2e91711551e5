#define _FILE_OFFSET_BITS 64
#include "mesh.h"

#include "mesh_source.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

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

static bool read_any(struct mesh_source *source, const char *name, struct mesh *out)
{
    static const char mark[] = "\xef\xbb\xbf"; /* UTF-8 byte order mark */
    if (source->at == source->end)
        return mesh_refuse(source, source->begin, "the file is empty");
    if (begins_with(source, "version https://git-lfs."))
        return mesh_refuse(source, source->begin,
                           "a Git LFS pointer, not the mesh: run 'git lfs pull'");
    if (begins_with(source, "ply") && mesh_is_space(source->at[3]))
        return mesh_ply(source, out);
    if (mesh_is_stl_binary(source))
        return mesh_stl_binary(source, out);
    if (begins_with(source, mark))
        source->at += strlen(mark);
    const unsigned char *first = mesh_skip_spaces(source->at);
    if (*first == '<' || ends_with(name, ".dae"))
        return mesh_dae(source, out);
    if (strncasecmp((const char *) first, "solid", 5) == 0 && mesh_ends_word(source, first + 5) &&
        !has_zero(source))
        return mesh_stl_ascii(source, out);
    if (ends_with(name, ".obj"))
        return mesh_obj(source, out);
    if (ends_with(name, ".stl"))
        return mesh_stl_binary(source, out);
    if (ends_with(name, ".ply"))
        return mesh_ply(source, out);
    return mesh_is_obj_statement(source, first_statement(source)) ? mesh_obj(source, out)
                                                                  : read_unknown(source);
}

bool mesh_parse(const void *bytes, size_t size, const char *name, enum mesh_faces faces,
                struct mesh *out, char error[MESH_ERROR_MAX])
{
    struct mesh_source source = {.begin = bytes, .faces = faces, .error = error};
    source.at = source.begin;
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
    free(mesh->object);
    *mesh = (struct mesh){0};
}

/* ---- Files ----------------------------------------------------------------------------------- */

/* Returns the bytes of an open file, which the caller frees; or NULL, and the error. */
static unsigned char *read_open(int fd, size_t size, char error[MESH_ERROR_MAX])
{
    size_t done = 0;
    ssize_t got = 1;
    unsigned char *bytes = malloc(size + 1);
    while (bytes && done < size && (got > 0 || (got < 0 && errno == EINTR))) {
        got = read(fd, bytes + done, size - done);
        done += got > 0 ? (size_t) got : 0;
    }
    if (!bytes)
        snprintf(error, MESH_ERROR_MAX, "there is no memory for its %zu bytes", size);
    else if (got < 0)
        snprintf(error, MESH_ERROR_MAX, "%s", strerror(errno));
    else if (done < size)
        snprintf(error, MESH_ERROR_MAX, "byte %zu: the file became shorter while it was read",
                 done);
    else
        bytes[size] = '\0';
    if (bytes && done == size)
        return bytes;
    free(bytes);
    return NULL;
}

/* O_NONBLOCK: a pipe is an error, and does not block. */
static unsigned char *read_file(const char *path, size_t *size, char error[MESH_ERROR_MAX])
{
    struct stat about;
    unsigned char *bytes = NULL;
    const char *why = NULL;
    const int fd = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    if (fd < 0 || fstat(fd, &about) != 0)
        why = strerror(errno);
    else if (S_ISDIR(about.st_mode))
        why = "a folder, not a file";
    else if (!S_ISREG(about.st_mode))
        why = "no regular file: write what it gives into one first";
    else if ((uintmax_t) about.st_size >= PTRDIFF_MAX)
        why = "larger than memory can be";
    else
        bytes = read_open(fd, *size = (size_t) about.st_size, error);
    if (why)
        snprintf(error, MESH_ERROR_MAX, "%s", why);
    if (fd >= 0)
        close(fd);
    return bytes;
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
