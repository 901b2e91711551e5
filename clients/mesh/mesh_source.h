/* The bytes of a mesh file during parsing, and functions for errors and progress. */
#ifndef MESH_SOURCE_H
#define MESH_SOURCE_H

#include "mesh.h"

struct mesh_source {
    const unsigned char *begin, *end;  /* *end is readable, and 0 */
    const unsigned char *at;           /* position of the parser */
    const unsigned char *reported;     /* position at the last progress report */
    const struct mesh_progress *watch; /* may be NULL */
    char *error;                       /* capacity: MESH_ERROR_MAX */
};

/* Largest number of vertices or faces; not an index. */
#define MESH_COUNT_MAX (UINT32_MAX - 1u)

/* A mesh under construction, for formats that do not state its size in advance. */
struct mesh_build {
    struct mesh_source *source;
    struct mesh *mesh;
    size_t vertex_capacity, face_capacity;
};

/* Append an element. Return false, with the error, if there are too many. Exit with status 1 if
 * memory is exhausted. */
bool mesh_add_vertex(struct mesh_build *build, const double position[3]);
bool mesh_add_face(struct mesh_build *build, const unsigned corner[3]);

/* Releases unused capacity. Call it at the end. */
void mesh_fit(struct mesh_build *build);

/* Set the error: for the line that contains `where`, or for the byte at `where`; format: as of
 * printf(). within: kind of element that contains the byte, for example "face", and its index;
 * NULL: none. Both return false. */
bool mesh_refuse_line(struct mesh_source *source, const unsigned char *where, const char *format,
                      ...) __attribute__((format(printf, 3, 4)));
bool mesh_refuse_byte(struct mesh_source *source, const unsigned char *where, const char *within,
                      uint64_t index, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

/* Sets the error for exhausted memory. Returns false. */
bool mesh_refuse_memory(struct mesh_source *source, uint64_t count, const char *what);

/* Copies the word at this position for an error text, shortened and with other bytes than printable
 * ASCII replaced. Returns text. */
enum { MESH_WORD_MAX = 32 };
const char *mesh_word(const struct mesh_source *source, const unsigned char *at,
                      char text[MESH_WORD_MAX]);

/* Allocates count elements. Returns NULL if memory is exhausted. The caller frees it. */
void *mesh_allocate(size_t count, size_t size);

/* Advances to the end of the line, which is not consumed, or to the end of the file. */
void mesh_skip_line(struct mesh_source *source);

void mesh_report_progress_now(struct mesh_source *source);

/* Reports progress about once a megabyte. Call it every few bytes. */
static inline void mesh_report_progress(struct mesh_source *source)
{
    enum { STEP = 1 << 20 };
    if (source->at - source->reported >= STEP)
        mesh_report_progress_now(source);
}

/* ---- Text. Inline: called for each character ---- */

static inline size_t mesh_left(const struct mesh_source *source)
{
    return (size_t) (source->end - source->at);
}

/* White space within a line. */
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

/* Whether a word ends here: at white space, or at the end of the file. */
static inline bool mesh_ends_word(const struct mesh_source *source, const unsigned char *at)
{
    return mesh_is_space(*at) || at == source->end;
}

#endif
