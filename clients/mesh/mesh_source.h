/* The bytes of a file while a mesh is read from them, and what is said of them. */
#ifndef MESH_SOURCE_H
#define MESH_SOURCE_H

#include "mesh.h"

struct mesh_source {
    const unsigned char *begin, *end; /* *end can be read, and is 0 */
    const unsigned char *at;          /* what comes next */
    const unsigned char *told;        /* how far the watch knows */
    const struct mesh_watch *watch;   /* may be NULL */
    char *error;                      /* room for MESH_ERROR_MAX */
};

/* Of most, and no index: vertices or faces. */
#define MESH_COUNT_MAX (UINT32_MAX - 1u)

/* A mesh that grows, of a file that does not say how large it is. */
struct mesh_build {
    struct mesh_source *source;
    struct mesh *mesh;
    size_t vertex_room, face_room;
};

/* Returns false, with the error, if there are too many. Exits with status 1 if memory is exhausted.
 */
bool mesh_add_vertex(struct mesh_build *build, const double position[3]);
bool mesh_add_face(struct mesh_build *build, const unsigned corner[3]);

/* At the end: gives back the memory that nothing lies in. */
void mesh_fit(struct mesh_build *build);

/* What is wrong in the line of that place, or at that byte, in words of printf(). Both return
 * false. within: "face"; NULL where it is within nothing that is counted. */
bool mesh_refuse_line(struct mesh_source *source, const unsigned char *where, const char *format,
                      ...) __attribute__((format(printf, 3, 4)));
bool mesh_refuse_byte(struct mesh_source *source, const unsigned char *where, const char *within,
                      uint64_t index, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

/* No memory. Returns false. */
bool mesh_refuse_room(struct mesh_source *source, uint64_t count, const char *what);

/* What stands there up to white space, as it may be shown: short, and of printable ASCII. Returns
 * text. */
enum { MESH_WORD_MAX = 32 };
const char *mesh_word(const struct mesh_source *source, const unsigned char *at,
                      char text[MESH_WORD_MAX]);

/* Room for count elements, NULL where there is none. The caller frees it. */
void *mesh_room(size_t count, size_t size);

/* To the end of the line, which stays what comes next, or of the file. */
void mesh_skip_line(struct mesh_source *source);

void mesh_tell_now(struct mesh_source *source);

/* To be called for every few bytes. */
static inline void mesh_tell(struct mesh_source *source)
{
    enum { STEP = 1 << 20 };
    if (source->at - source->told >= STEP)
        mesh_tell_now(source);
}

/* ---- Text. Inline: they are called for each character ---- */

static inline size_t mesh_left(const struct mesh_source *source)
{
    return (size_t) (source->end - source->at);
}

/* Within a line. */
static inline bool mesh_is_blank(unsigned char byte)
{
    return byte == ' ' || byte == '\t' || byte == '\r' || byte == '\v' || byte == '\f';
}

static inline bool mesh_is_space(unsigned char byte)
{
    return byte == '\n' || mesh_is_blank(byte);
}

static inline const unsigned char *mesh_skip_blanks(const unsigned char *at)
{
    while (mesh_is_blank(*at))
        at++;
    return at;
}

static inline const unsigned char *mesh_skip_spaces(const unsigned char *at)
{
    while (mesh_is_space(*at))
        at++;
    return at;
}

/* White space, or the end of the file. */
static inline bool mesh_ends_word(const struct mesh_source *source, const unsigned char *at)
{
    return mesh_is_space(*at) || at == source->end;
}

#endif
