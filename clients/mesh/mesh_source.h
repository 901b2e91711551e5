/* Parsers of mesh files, one for each format, and what they share: the bytes of the file, errors,
 * progress, and numbers. Private to mesh*.c. */
#ifndef MESH_SOURCE_H
#define MESH_SOURCE_H

#include "mesh.h"
#include "progress.h"

#include <string.h>

struct mesh_source {
    const unsigned char *begin, *end; /* *end is readable, and 0 */
    const unsigned char *at;          /* position of the parser */
    enum mesh_faces faces;
    /* What was read. Arrays grow with the elements that are read. */
    struct mesh mesh;
    size_t vertex_capacity, face_capacity, object_capacity;
    unsigned corner[3]; /* of mesh_add_corner() */
    char *error;        /* capacity: MESH_ERROR_MAX */
    /* How errors name a place: in text by its line, else by its byte and the element that contains
     * it. within: kind of that element, such as "face"; NULL: none. index: of that element. */
    bool text;
    const char *within;
    size_t index;
};

/* Largest number of vertices or faces; not an index. */
#define MESH_COUNT_MAX (UINT32_MAX - 1u)

/* Append an element. Return false, with the error, if there are too many. Exit with status 1 if
 * memory is exhausted. */
bool mesh_add_vertex(struct mesh_source *source, const double position[3]);
bool mesh_add_face(struct mesh_source *source, const unsigned corner[3]);

/* Adds corner n of a polygon, counted from 0: from the third one on, a triangle of a fan. */
bool mesh_add_corner(struct mesh_source *source, size_t n, unsigned vertex);

/* Returns false, with the error, if a face of so many vertices is not read. where: of the error. */
bool mesh_check_face(struct mesh_source *source, const unsigned char *where, size_t count);

/* Sets the error, with the place of `where`. format: as of printf(). Returns false. */
bool mesh_refuse(struct mesh_source *source, const unsigned char *where, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Copies the word at this position for an error text, shortened and with other bytes than printable
 * ASCII replaced. Returns text. */
enum { MESH_WORD_MAX = 32 };
const char *mesh_word(const struct mesh_source *source, const unsigned char *at,
                      char text[MESH_WORD_MAX]);

/* Advances to the end of the line, which is not consumed, or to the end of the file. */
void mesh_skip_line(struct mesh_source *source);

/* Counts progress in bytes. */
static inline void mesh_report_progress(const struct mesh_source *source)
{
    progress_to(source->at - source->begin, source->end - source->begin);
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

/* ---- Formats ---- */

/* Each parser reads from the beginning of the source to its end. Returns false, with the error, if
 * the file is refused. */
bool mesh_ply(struct mesh_source *source);
bool mesh_stl_ascii(struct mesh_source *source);
bool mesh_stl_binary(struct mesh_source *source);
bool mesh_obj(struct mesh_source *source);
bool mesh_dae(struct mesh_source *source);

/* Whether the file has the size that its facet count requires as binary STL. */
bool mesh_is_stl_binary(const struct mesh_source *source);

/* Whether the word at this position is one of the common keywords of OBJ. */
bool mesh_is_obj_statement(const struct mesh_source *source, const unsigned char *at);

/* ---- Numbers ---- */

/* Parses a decimal number to the nearest double, by strtod(). In: text terminated by a 0, without
 * white space before the number. Returns the position after the number, and *value; or NULL if
 * there is no number.
 *
 * A number consists of digits, with an optional sign, decimal point and exponent: "-1.5e-3", ".5",
 * "5."; or it is nan, inf or infinity in any case. Its value is the nearest double (ties to even),
 * or infinity from where the largest double is no longer the nearest. The number of digits is not
 * limited. The caller checks what follows the number.
 *
 * Requires the "C" locale, in which a program starts (number_begin()). */
const unsigned char *mesh_number(const unsigned char *at, double *value);

/* Numbers of binary files, in either byte order. Inline: meshes have millions of them. */

/* An unsigned integer of size bytes, 1 to 8. */
static inline uint64_t mesh_bits(const unsigned char *bytes, size_t size, bool big_endian)
{
    uint64_t bits = 0;
    for (size_t i = 0; i < size; i++)
        bits = bits << 8 | bytes[big_endian ? i : size - 1 - i];
    return bits;
}

/* The IEEE 754 number with these bits. */
static inline float mesh_float(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline double mesh_double(uint64_t bits)
{
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

#endif
