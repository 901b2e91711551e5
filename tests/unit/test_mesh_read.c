/* Meshes in every format, good ones and refused ones, with the place. */
#include "unit.h"

#include "mesh.h"
#include "mesh_source.h"

#include "bumpy.h"
#include "formats.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- Bytes that a file has ------------------------------------------------------------------- */

enum { FILE_MAX = 1 << 16 };

struct file {
    size_t size;
    unsigned char bytes[FILE_MAX];
};

static void add(struct file *file, const void *bytes, size_t size)
{
    assert_true(size <= sizeof file->bytes - file->size);
    if (size > 0)
        memcpy(file->bytes + file->size, bytes, size);
    file->size += size;
}

static void add_text(struct file *file, const char *text)
{
    add(file, text, strlen(text));
}

static void add_bits(struct file *file, uint64_t bits, int size, bool big_endian)
{
    for (int i = 0; i < size; i++) {
        const unsigned char byte = (unsigned char) (bits >> 8 * (big_endian ? size - 1 - i : i));
        add(file, &byte, 1);
    }
}

static void add_float(struct file *file, float value, bool big_endian)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    add_bits(file, bits, sizeof bits, big_endian);
}

/* In a block that ends after the 0 that follows the bytes. */
static bool parse(const void *bytes, size_t size, const char *name, struct mesh *out, char *error)
{
    unsigned char *copy = malloc(size + 1);
    assert_non_null(copy);
    if (size > 0)
        memcpy(copy, bytes, size);
    copy[size] = '\0';
    const bool good = mesh_parse(copy, size, name, MESH_TRIANGLES, out, error);
    free(copy);
    return good;
}

static struct mesh read_good(const void *bytes, size_t size, const char *name)
{
    struct mesh mesh;
    char error[MESH_ERROR_MAX];
    if (!parse(bytes, size, name, &mesh, error))
        fail_msg("%s", error);
    assert_string_equal(error, "");
    return mesh;
}

static struct mesh read_text(const char *text)
{
    return read_good(text, strlen(text), "");
}

/* place: with which the error begins, before a colon. */
static void expect_error(const void *bytes, size_t size, const char *name, const char *place)
{
    struct mesh mesh;
    char error[MESH_ERROR_MAX];
    const size_t length = strlen(place);
    if (parse(bytes, size, name, &mesh, error))
        fail_msg("it is read, not refused: %s", place);
    if (strncmp(error, place, length) != 0 || error[length] != ':')
        fail_msg("%s, not %s", error, place);
    assert_true(!mesh.vertex && !mesh.face && mesh.vertex_count == 0 && mesh.face_count == 0);
}

/* head, and rest: most of the texts have the same beginning. */
static void expect_refused(const char *head, const char *rest, const char *place)
{
    struct file *file = calloc(1, sizeof *file);
    assert_non_null(file);
    add_text(file, head);
    add_text(file, rest);
    expect_error(file->bytes, file->size, "", place);
    free(file);
}

/* ---- Meshes that are expected ---------------------------------------------------------------- */

static void expect_mesh(struct mesh mesh, size_t vertices, const double (*vertex)[3], size_t faces,
                        const unsigned (*face)[3])
{
    assert_int_equal(mesh.vertex_count, vertices);
    assert_int_equal(mesh.face_count, faces);
    if (vertices > 0)
        assert_memory_equal(mesh.vertex, vertex, vertices * sizeof *vertex);
    if (faces > 0)
        assert_memory_equal(mesh.face, face, faces * sizeof *face);
    mesh_free(&mesh);
    assert_true(!mesh.vertex && !mesh.face && mesh.vertex_count == 0 && mesh.face_count == 0);
}

static void expect_same(const struct mesh *a, const struct mesh *b)
{
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_int_equal(a->face_count, b->face_count);
    assert_memory_equal(a->vertex, b->vertex, a->vertex_count * sizeof *a->vertex);
    assert_memory_equal(a->face, b->face, a->face_count * sizeof *a->face);
}

static const double square[][3] = {{0, 0, 0}, {1, 0, 0.1}, {0, 1, -1e-3}, {1, 1, 5e22}};
static const unsigned halves[][3] = {{0, 1, 2}, {3, 2, 1}};

/* ---- PLY ------------------------------------------------------------------------------------- */

static const char ply_ascii[] =
    "ply\n"
    "format ascii 1.0\n"
    "comment made by hand\n"
    "element vertex 4\n"
    "property float x\n"
    "property float y\n"
    "property float z\n"
    "property float confidence\n"
    "element face 2\n"
    "property list uchar int vertex_indices\n"
    "end_header\n"
    "0 0 0 0.5\n"
    "1 0 0.1 nan\n"
    "0 1 -1e-3 -inf \n"
    "+1. 1e0 5e22 12345678901234567890.5e+3\n"
    "3 0 1 2\n"
    "3 3 2 1\n";

/* Faces before vertices, coordinates in another order and between others, elements and lists that
 * are not read. */
static const char ply_order[] =
    "ply\r\n"
    "obj_info any\r\n"
    "format ascii 1.0\r\n"
    "element face 2\r\n"
    "property uint8 red\r\n"
    "property list uint8 uint32 vertex_index\r\n"
    "property list int16 float64 texcoord\r\n"
    "element nothing 4000000000\r\n"
    "element vertex 4\r\n"
    "property int8 z\r\n"
    "property int16 a\r\n"
    "property uint16 y\r\n"
    "property int32 x\r\n"
    "element edge 1\r\n"
    "property float32 x\r\n"
    "end_header\r\n"
    "255 3 0 1 2 2 0.5 .5\r\n"
    "0\t3  3 2 1 0 \r\n"
    "\r\n"
    "0 7 0 0\r\n"
    "  0.1 7 0 1\r\n"
    "-1e-3 7 1 0\r\n"
    "5e22 7 1 1\r\n"
    "9\r\n\r\n";

static void ply_of_text_is_read(void **state)
{
    expect_mesh(read_text(ply_ascii), 4, square, 2, halves);
    expect_mesh(read_text(ply_order), 4, square, 2, halves);
    expect_mesh(read_good(ply_ascii, sizeof ply_ascii - 2, ""), 4, square, 2, halves);
}

static const char *const types[][2] = {
    {"char", "int8"}, {"uchar", "uint8"}, {"short", "int16"},   {"ushort", "uint16"},
    {"int", "int32"}, {"uint", "uint32"}, {"float", "float32"}, {"double", "float64"}};
enum { CHAR, UCHAR, SHORT, USHORT, INT, UINT, FLOAT, DOUBLE, TYPE_COUNT };
static const int sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};

static void add_number(struct file *file, int type, double value, bool big_endian)
{
    uint64_t bits;
    if (type == FLOAT) {
        add_float(file, (float) value, big_endian);
        return;
    }
    memcpy(&bits, &value, sizeof bits);
    add_bits(file, type == DOUBLE ? bits : (uint64_t) (int64_t) value, sizes[type], big_endian);
}

/* One triangle with what can be written differently: types of coordinates, of counts and indices;
 * a list before and after, and a value after. */
static void make_binary(struct file *file, int coordinate, int count, int index, int spelling,
                        bool big_endian, const double vertex[3][3])
{
    char header[1024];
    const char *type = types[coordinate][spelling];
    file->size = 0;
    sprintf(header,
            "ply\nformat binary_%s_endian 1.0\nelement vertex 3\nproperty list %s short l\n"
            "property %s x\nproperty %s y\nproperty %s z\nelement face 1\n"
            "property list %s %s vertex_indices\nproperty double quality\nend_header\n",
            big_endian ? "big" : "little", types[count][1 - spelling], type, type, type,
            types[count][spelling], types[index][spelling]);
    add_text(file, header);
    for (int i = 0; i < 3; i++) {
        add_number(file, count, i, big_endian);
        for (int value = 0; value < i; value++)
            add_bits(file, 0xffff, 2, big_endian);
        for (int axis = 0; axis < 3; axis++)
            add_number(file, coordinate, vertex[i][axis], big_endian);
    }
    add_number(file, count, 3, big_endian);
    for (int i = 0; i < 3; i++)
        add_number(file, index, 2 - i, big_endian);
    add_number(file, DOUBLE, NAN, big_endian);
}

static void ply_of_bytes_is_read(void **state)
{
    static const unsigned face[][3] = {{2, 1, 0}};
    static const double extremes[TYPE_COUNT][2] = {{-128, 127},
                                                   {0, 255},
                                                   {-32768, 32767},
                                                   {0, 65535},
                                                   {-2147483648., 2147483647.},
                                                   {0, 4294967295.},
                                                   {-0.1f, 0x1p-149},
                                                   {-0x1.fffffffffffffp1023, 0x1p-1074}};
    struct file *file = malloc(sizeof *file);
    for (int mix = 0; mix < TYPE_COUNT * TYPE_COUNT * TYPE_COUNT * 4; mix++) {
        const int coordinate = mix / 4 % TYPE_COUNT, count = mix / 32 % TYPE_COUNT;
        const int index = mix / 256;
        const double *extreme = extremes[coordinate];
        const double zero = coordinate >= FLOAT ? -0.0 : 0;
        const double vertex[3][3] = {
            {extreme[0], 1, extreme[1]}, {0, extreme[1], 2}, {100, zero, 0}};
        make_binary(file, coordinate, count, index, mix & 1, mix & 2, vertex);
        expect_mesh(read_good(file->bytes, file->size, ""), 3, vertex, 1, face);
    }
    free(file);
}

static void bad_ply_headers_are_refused(void **state)
{
    static const char *const cases[][2] = {
        {"ply \nfoo\n", "line 2"},
        {"ply 1\nformat ascii 1.0\nend_header\n", "line 1"},
        {"ply\rformat ascii 1.0\rend_header\r", "line 1"},
        {"ply\n", "line 2"},
        {"ply\nformat ascii 1.0\nend_header", "line 3"},
        {"ply\nend_header\n", "line 2"},
        {"ply\nformat ascii 1.0\nformat ascii 1.0\nend_header\n", "line 3"},
        {"ply\nformat ascii 1.1\nend_header\n", "line 2"},
        {"ply\nformat text 1.0\nend_header\n", "line 2"},
        {"ply\nformat ascii 1.0\nelement vertex\n", "line 3"},
        {"ply\nformat ascii 1.0\nelement vertex -1\n", "line 3"},
        {"ply\nformat ascii 1.0\nelement face 4294967295\n", "line 3"},
        {"ply\nformat ascii 1.0\nelement face 18446744073709551617\n", "line 3"},
        {"ply\nformat ascii 1.0\nelement face 1.0\n", "line 3"},
        {"ply\nformat ascii 1.0\nelement vertex 0\nelement vertex 0\n", "line 4"},
        {"ply\nformat ascii 1.0\nelement tristrips 1\n", "line 3"},
        {"ply\nformat ascii 1.0\nproperty int x\n", "line 3"},
        {"ply\nformat ascii 1.0\nelement vertex 0\nproperty x\n", "line 4"},
        {"ply\nformat ascii 1.0\nelement vertex 0\nproperty list int x\n", "line 4"},
        {"ply\nformat ascii 1.0\nelement vertex 0\nproperty int64 x\n", "line 4"},
        {"ply\nformat ascii 1.0\nelement vertex 0\nproperty list int list x\n", "line 4"},
        {"ply\nformat ascii 1.0\nelement vertex 0\nproperty int x\nproperty int x\n", "line 5"},
        {"ply\nformat ascii 1.0\nelement face 0\nproperty list int int vertex_index\n"
         "property list int int vertex_indices\n",
         "line 5"},
        {"ply\nformat ascii 1.0\nelement vertex 0\nproperty list int int y\n", "line 4"},
        {"ply\nformat ascii 1.0\nelement face 0\nproperty int vertex_indices\n", "line 4"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int z\nend_header\n0 0",
         "line 3"},
        {"ply\nformat ascii 1.0\nelement face 1\nproperty list int int i\nend_header\n0 0",
         "line 3"},
    };
    for (size_t i = 0; i < COUNT(cases); i++)
        expect_refused(cases[i][0], "", cases[i][1]);
    expect_error("plY", 3, "a.PLY", "line 1");
    expect_error("plyy\n", 5, "a.PLY", "line 1");
}

/* A word of the file in an error is printable and short. */
static void words_in_errors_are_printable_and_short(void **state)
{
    static const char *const cases[][2] = {
        {"ply\n\x01\xff\n", "line 2: '\?\?' is no keyword of a PLY header"},
        {"ply\nabcdefghijklmnopqrstuvwxyz0123456789\n",
         "line 2: 'abcdefghijklmnopqrstuvwxyz01...' is no keyword of a PLY header"}};
    for (size_t i = 0; i < COUNT(cases); i++) {
        struct mesh mesh;
        char error[MESH_ERROR_MAX];
        assert_false(parse(cases[i][0], strlen(cases[i][0]), "", &mesh, error));
        assert_string_equal(error, cases[i][1]);
    }
}

static void too_long_ply_headers_are_refused(void **state)
{
    struct file *file = calloc(1, sizeof *file);
    add_text(file, "ply\n");
    for (int i = 0; i < 65; i++)
        add_text(file, "element e 0\n");
    expect_error(file->bytes, file->size, "", "line 66");
    file->size = 0;
    add_text(file, "ply\nelement e 0\n");
    for (int i = 0; i < 257; i++)
        add_text(file, "property int p\n");
    expect_error(file->bytes, file->size, "", "line 259");
    free(file);
}

#define VERTICES(format, count)                         \
    "ply\nformat " format " 1.0\nelement vertex " count \
    "\nproperty float x\nproperty float y\nproperty float z\n"
#define FACES(count) "element face " count "\nproperty list uchar int vertex_indices\nend_header\n"

static void bad_ply_bodies_are_refused(void **state)
{
    static const char *const cases[][2] = {
        {"", "line 10"},
        {"0 0 0\n0 0 0\n0 0 0\n3 0 1\n", "line 13"},
        {"0 0 0\n0 0 0\n0 0\n3 0 1 2\n3 1", "line 12"},
        {"0 0 0\n0 0 0\n0 0 0\n       \n\t\t", "line 14"},
        {"0 0 0\n0 0 0\n0 0 0\n3 0 1       ", "line 13"},
        {"0 0 0\n0 0 0\n0 0 0 7\n3 0 1 2\n", "line 12"},
        {"0 0 0\n0 0 0\n0 0 0\n3 0 1 2 7\n", "line 13"},
        {"0 0 0\n0 0 0\n0 0 0\n3 0 1 2\n3 0 1 2\n", "line 14"},
        {"0 0 0\n0 zero 0\n0 0 0\n3 0 1 2\n", "line 11"},
        {"0 0 0\n0 1..5 0\n0 0 0\n3 0 1 2\n", "line 11"},
        {"0 0 0\n0 0x1 0\n0 0 0\n3 0 1 2\n", "line 11"},
        {"0 0 0\n0 0,5 0\n0 0 0\n3 0 1 2\n", "line 11"},
        {"0 0 0\n0 1e999 0\n0 0 0\n3 0 1 2\n", "line 11"},
        {"0 0 0\n0 0 nan\n0 0 0\n3 0 1 2\n", "line 11"},
        {"-inf 0 0\n0 0 0\n0 0 0\n3 0 1 2\n", "line 10"},
        {"0 0 0\n0 0 0\n0 0 0\n4 0 1 2 0\n", "line 13"},
        {"0 0 0\n0 0 0\n0 0 0\n2 0 1      \n", "line 13"},
        {"0 0 0\n0 0 0\n0 0 0\n-3 0 1 2\n", "line 13"},
        {"0 0 0\n0 0 0\n0 0 0\n3.5 0 1 2\n", "line 13"},
        {"0 0 0\n0 0 0\n0 0 0\nnan 0 1 2\n", "line 13"},
        {"0 0 0\n0 0 0\n0 0 0\n1e10 0 1 2\n", "line 13"},
        {"0 0 0\n0 0 0\n0 0 0\n3 0 1 3\n", "line 13"},
        {"0 0 0\n0 0 0\n0 0 0\n3 0 -1 2\n", "line 13"},
        {"0 0 0\n0 0 0\n0 0 0\n3 0.5 1 2\n", "line 13"},
        {"0 0 0\n0 0 0\n0 0 0\n3 0 1 1e999\n", "line 13"},
    };
    for (size_t i = 0; i < COUNT(cases); i++)
        expect_refused(VERTICES("ascii", "3") FACES("1"), cases[i][0], cases[i][1]);
    expect_refused(VERTICES("ascii", "0") FACES("1"), "3 0 0 0\n", "line 10");
    expect_refused("ply\nformat ascii 1.0\nelement a 1\nproperty float a\nend_header\n", "1,5",
                   "line 6");
}

static void polygons_are_read(void **state)
{
    static const char *const texts[] = {
        VERTICES("ascii", "4") FACES("2") "0 0 0\n1 0 0.1\n0 1 -1e-3\n1 1 5e22\n4 0 1 3 2\n"
                                          "3 3 2 1\n",
        "v 0 0 0\nv 1 0 0.1\nv 0 1 -1e-3\nv 1 1 5e22\nf 1 2 4 3\nf 4 3 2\n"};
    static const unsigned fans[][3] = {{0, 1, 3}, {0, 3, 2}, {3, 2, 1}};
    char error[MESH_ERROR_MAX];
    struct mesh mesh;
    for (size_t i = 0; i < COUNT(texts); i++) {
        assert_true(mesh_parse(texts[i], strlen(texts[i]), "", MESH_POLYGONS, &mesh, error));
        expect_mesh(mesh, 4, square, 3, fans);
    }
}

static void expect_refused_bytes(const char *header, const char *bytes, size_t size,
                                 const char *place)
{
    struct file *file = calloc(1, sizeof *file);
    add_text(file, header);
    add(file, bytes, size);
    expect_error(file->bytes, file->size, "", place);
    free(file);
}

#define BYTES(bytes) bytes, sizeof bytes - 1

static void bad_ply_bytes_are_refused(void **state)
{
    static const char one[] = VERTICES("binary_little_endian", "1") FACES("1");
    static const char zero[] = VERTICES("binary_big_endian", "0") "element face 1\n"
                                                                  "property list short float "
                                                                  "vertex_indices\nend_header\n";
    static const char lists[] =
        "ply\nformat binary_big_endian 1.0\nelement a 2\n"
        "property list ushort uint b\nend_header\n";
    expect_refused_bytes(one, BYTES("\0\0\0\0\0\0\0\0\0\0\0\0\3\0\0\0\0\0\0\0\0\0\0\0"),
                         "byte 193 (face 0)");
    expect_refused_bytes(one, BYTES("\0\0\0\0\0\0\0\0\0\0\0\0\3\0\0\0\0\0\0\0\0\1\0\0\0"),
                         "byte 190 (face 0)");
    expect_refused_bytes(one, BYTES("\0\0\0\0\0\0\0\0\0\0\0\0\3\0\0\0\0\377\377\377\377\0\0\0\0"),
                         "byte 186 (face 0)");
    expect_refused_bytes(one, BYTES("\0\0\0\0\0\0\200\177\0\0\0\0\3\0\0\0\0\0\0\0\0\0\0\0\0"),
                         "byte 173 (vertex 0)");
    expect_refused_bytes(one, BYTES("\0\0\0\0\0\0\300\377\0\0\0\0\3\0\0\0\0\0\0\0\0\0\0\0\0"),
                         "byte 173 (vertex 0)");
    expect_refused_bytes(one, BYTES("\0\0\0\0\0\0\0\0\0\0\0\0\4\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0"),
                         "byte 181 (face 0)");
    expect_refused_bytes(one, BYTES("\0\0\0\0\0\0\0\0\0\0\0\0\2\0\0\0\0\0\0\0\0\0\0\0\0"),
                         "byte 181 (face 0)");
    expect_refused_bytes(one, BYTES("\0\0\0\0\0\0\0\0\0\0\0\0\3\0\0\0\0\0\0\0\0\0\0\0\0 \r\n.."),
                         "byte 194");
    expect_refused_bytes(zero, BYTES("\0\3\77\0\0\0\0\0\0\0\0\0\0\0"), "byte 170 (face 0)");
    expect_refused_bytes(zero, BYTES("\377\377\0\0\0\0\0\0\0\0\0\0\0\0"), "byte 168 (face 0)");
    expect_refused_bytes(lists, BYTES("\0\1\0\0\0\0\0\1\0\0\0"), "byte 95 (element 1)");
    expect_refused_bytes(lists, BYTES("\377\377\0\0\0\0"), "byte 90 (element 0)");
    expect_refused_bytes(lists, BYTES("\0\1\0\0\0\0\0"), "byte 91 (element 1)");
}

/* White space after the end. */
static void white_space_may_follow_ply(void **state)
{
    static const char one[] = VERTICES("binary_little_endian", "1") "end_header\n"
                                                                    "\0\0\0\0\0\0\0\0\0\0\0\0 \r\n\t";
    static const double origin[][3] = {{0, 0, 0}};
    expect_mesh(read_good(one, sizeof one - 1, ""), 1, origin, 0, NULL);
    expect_mesh(read_text(VERTICES("ascii", "1") "end_header\n0 0 0\n \r\n\t"), 1, origin, 0, NULL);
}

/* Memory grows with what is read: a header that states 2^32 elements allocates nothing. */
static void counts_beyond_the_file_are_refused(void **state)
{
    static const char *const formats_of_ply[] = {"ascii", "binary_little_endian",
                                                 "binary_big_endian"};
    static const char *const promises[] = {
        "element vertex 4294967294\nproperty char x\nproperty char y\nproperty char z\n",
        "element face 4294967294\nproperty list uchar uchar vertex_indices\n",
        "element a 4294967294\nproperty list uchar uchar b\n",
        ("element vertex 1\nproperty double x\nproperty double y\nproperty double z\n"
         "element face 1000000000\nproperty list double double vertex_index\n"),
    };
    for (size_t f = 0; f < 3; f++)
        for (size_t i = 0; i < COUNT(promises); i++) {
            struct mesh mesh;
            char text[512], error[MESH_ERROR_MAX];
            sprintf(text, "ply\nformat %s 1.0\n%send_header\n1 1 1\n1 1 1\n", formats_of_ply[f],
                    promises[i]);
            assert_false(parse(text, strlen(text), "", &mesh, error));
            if (!strstr(error, f == 0 ? "line " : "byte "))
                fail_msg("%s", error);
        }
}

/* ---- STL ------------------------------------------------------------------------------------- */

static const char stl_ascii[] =
    "solid a name of some words\n"
    "  facet normal 0 0 nan\n"
    "    outer loop\n"
    "      vertex 0 0 0\n"
    "      vertex 1 0 0.1\r\n"
    "      vertex 0 1 -1e-3\n"
    "    endloop\n"
    "  endfacet\n"
    "FACET NORMAL 0 0 1 Outer Loop\n"
    "VERTEX 1 1 50000000000000000000000 VERTEX -0 1 -1e-3 VERTEX 1 -0.0 1e-1\n"
    "ENDLOOP ENDFACET\n"
    "endsolid a name of some words\n";

static void stl_of_text_is_read(void **state)
{
    expect_mesh(read_text(stl_ascii), 4, square, 2, halves);
    struct file *file = calloc(1, sizeof *file);
    add_text(file, "\xef\xbb\xbf");
    add_text(file, stl_ascii);
    add_text(file, "solid\nendsolid"); /* another solid, without facets */
    expect_mesh(read_good(file->bytes, file->size, "a.obj"), 4, square, 2, halves);
    free(file);
    expect_mesh(read_text("solid\nendsolid"), 0, NULL, 0, NULL);
}

static void bad_stl_of_text_is_refused(void **state)
{
    static const char *const cases[][2] = {
        {"solid", "line 1"},
        {"solid a\nfacet\n", "line 3"},
        {"solid a\nfacets\n", "line 2"},
        {"solid a\nfacet normal 0 0\nouter loop", "line 3"},
        {"solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 1e999", "line 4"},
        {"solid a\nfacet normal 0 0 0\nouter loop\nvertex nan 0 0", "line 4"},
        {"solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0.5.5 0", "line 4"},
        {"solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 0\nendloop", "line 6"},
        {"solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\n"
         "vertex 0 0 0\n",
         "line 7"},
        {"solid a\nfacet normal 0 0 0\nouter loop\nendloop", "line 4"},
        {"solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\n"
         "endloop\nouter loop",
         "line 8"},
        {"solid a\nendsolid a\nfacet", "line 3"},
    };
    for (size_t i = 0; i < COUNT(cases); i++)
        expect_refused(cases[i][0], "", cases[i][1]);
}

/* The square, in floats. */
static void make_stl(struct file *file, const char *header)
{
    file->size = 0;
    add_text(file, header);
    file->size = 80;
    add_bits(file, 2, 4, false);
    for (int facet = 0; facet < 2; facet++) {
        for (int axis = 0; axis < 3; axis++)
            add_float(file, NAN, false);
        for (int corner = 0; corner < 3; corner++) {
            const double *at = square[halves[facet][corner]];
            for (int axis = 0; axis < 3; axis++)
                add_float(file, at[axis] == 0 && facet ? -0.0f : (float) at[axis], false);
        }
        add_bits(file, 0xffff, 2, false);
    }
}

static void stl_of_bytes_is_read(void **state)
{
    static const char *const headers[] = {"", "binary", "solid, which it is not", "solid\nfacet"};
    double vertex[4][3];
    struct file *file = calloc(1, sizeof *file);
    for (int i = 0; i < 12; i++)
        vertex[i / 3][i % 3] = (float) square[i / 3][i % 3];
    for (size_t i = 0; i < COUNT(headers); i++) {
        make_stl(file, headers[i]);
        expect_mesh(read_good(file->bytes, file->size, "a.obj"), 4, (const double(*)[3]) vertex, 2,
                    halves);
    }
    memset(file->bytes + 80, 0, 4);
    expect_mesh(read_good(file->bytes, 84, ""), 0, NULL, 0, NULL);
    free(file);
}

static void bad_stl_of_bytes_is_refused(void **state)
{
    struct file *file = calloc(1, sizeof *file);
    make_stl(file, "solid");
    expect_error(file->bytes, file->size - 1, "a.stl", "byte 80");
    expect_error(file->bytes, file->size + 1, "A.STL", "byte 80");
    expect_error(file->bytes, 83, "A.STL", "byte 83");
    memset(file->bytes + 80, 0xff, 4);
    expect_error(file->bytes, file->size, "a.stl", "byte 80");
    make_stl(file, "");
    memcpy(file->bytes + 84 + 50 + 12 + 12 + 8, "\0\0\200\377", 4);
    expect_error(file->bytes, file->size, "", "byte 166 (face 1)");
    free(file);
}

/* ---- OBJ ------------------------------------------------------------------------------------- */

static const char obj[] =
    "# a comment that ends in a backslash \\\n"
    "mtllib a b c.mtl\n"
    "o name\n"
    "v 0 0 0\n"
    "v 1 0 0.1 1\n"
    "vt 0.5 0.5\nvn 0 0 1\n\n"
    "  v\t0 1 -1e-3 0.5 0.5 0.5 # with a colour\r\n"
    "f 1 2/7 3/7/7\n"
    "g a b\nusemtl c:\\folder\ns off\nl 1 2 \\\n3\np 1\ncstype bezier\n"
    "f 4//1 \\\n -1//1 \\\r\n -2//1 # what is no number\n"
    "v 1 1\\\n5e22 1 2 3 4";

static void obj_is_read(void **state)
{
    expect_mesh(read_text(obj), 4, square, 2, halves);
    expect_mesh(read_good(obj, sizeof obj - 1, "a.stl.OBJ"), 4, square, 2, halves);
    expect_mesh(read_good("# nothing", 9, "a.obj"), 0, NULL, 0, NULL);
    expect_mesh(read_good("fo 1 1 1\nv 0 0 0", 16, "a.obj"), 1, square, 1,
                (const unsigned[][3]){{0, 0, 0}});
    expect_mesh(read_good("\n \n# no\n \nv 0 0 0", 17, ""), 1, square, 0, NULL);
}

static void bad_obj_is_refused(void **state)
{
    static const char *const cases[][2] = {
        {"foo 1\n", "line 4"},
        {"curv 0 1 1 2\n", "line 4"},
        {"surf 0 1 0 1 1\n", "line 4"},
        {"call a.obj\n", "line 4"},
        {"v 1 2\n", "line 4"},
        {"v 1 2 3 4 5\n", "line 4"},
        {"v 1 2 3x\n", "line 4"},
        {"v 1 2 \\\n\\\n x\n", "line 6"},
        {"v 1 2 1e400\n", "line 4"},
        {"v -nan 2 1\n", "line 4"},
        {"f 1 2 3 1\n", "line 4"},
        {"f 1 2\n", "line 4"},
        {"f\n", "line 4"},
        {"f 1 2 3/\n", "line 4"},
        {"f 1 2 3/1/\n", "line 4"},
        {"f 1 2 3//\n", "line 4"},
        {"f 1 2 3/1/1/1\n", "line 4"},
        {"f 1 2 1.5\n", "line 4"},
        {"f 1 2 x\n", "line 4"},
        {"f 1 2 0\n", "line 4"},
        {"f 1 2 -4\n", "line 4"},
        {"f -99999999999999999999 2 3\n", "line 4"},
        {"f 1 2 6/1\nf 1 5 2\nv 0 0 0\n", "line 4"},
        {"f 1 2 4294967297\n", "line 4"},
        {"f 1 2 18446744073709551617\n", "line 4"},
    };
    for (size_t i = 0; i < COUNT(cases); i++)
        expect_refused("v 0 0 0\nv 1 0 0\nv 0 1 0\n", cases[i][0], cases[i][1]);
    expect_error("v 0 0 0\0 1", 10, "", "line 1");
}

/* ---- COLLADA --------------------------------------------------------------------------------- */

#define DAE_BEGIN \
    "<?xml version='1.0'?>\n<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema'>\n"
#define DAE_SCENE(nodes)                                                                      \
    "<library_visual_scenes><visual_scene id='s'>" nodes                                      \
    "</visual_scene></library_visual_scenes><scene><instance_visual_scene url='#s'/></scene>" \
    "</COLLADA>\n"
#define DAE_SQUARE                                                                    \
    "<source id='p'><float_array id='a' count='12'>0 0 0 1 0 0.1\n0 1 -1e-3 1 1 5e22" \
    "</float_array><technique_common><accessor source='#a' count='4' stride='3'>"     \
    "<param name='X' type='float'/><param name='Y'/><param name='Z'/></accessor>"     \
    "</technique_common></source>"                                                    \
    "<vertices id='v'><input semantic='NORMAL' source='#none'/>"                      \
    "<input semantic='POSITION' source='#p'/></vertices>\n"
#define DAE_GEOMETRY(primitives)                                        \
    "<library_geometries><geometry id='g'><mesh>" DAE_SQUARE primitives \
    "</mesh></geometry></library_geometries>\n"
#define DAE_PLACED DAE_SCENE("<node><instance_geometry url='#g'/></node>")
#define DAE_VERTEX "<input semantic='VERTEX' source='#v' offset='0'/>"
#define DAE_TRIANGLES "<triangles count='2'>" DAE_VERTEX "<p>0 1 2 3 2 1</p></triangles>"

static void collada_is_read(void **state)
{
    static const char *const primitives[] = {
        DAE_TRIANGLES,
        /* What has no surface, empty lists, other inputs, and two lists of the same vertices. */
        "<lines count='1'>" DAE_VERTEX
        "<p>0 9</p></lines><triangles count='0'/>"
        "<triangles material='m' count='1'><input semantic='NORMAL' source='#n' offset='0'/>"
        "<input semantic='VERTEX' source='#v' offset='1'/><input semantic='TEXCOORD' "
        "source='#t' offset='2' set='0'/>\n<p>\n9 0 8 7 1 6\t5 2 4\r\n</p></triangles>"
        "<triangles count='1'>" DAE_VERTEX "<p>3 2 1</p></triangles>",
        "<polylist count='2'>" DAE_VERTEX "<vcount>3 3</vcount><p>0 1 2 3 2 1</p></polylist>",
        "<polygons count='2'>" DAE_VERTEX "<p>0 1 2</p><p>3 2 1</p></polygons>",
    };
    static const char *const polygons[] = {
        "<polylist count='1'>" DAE_VERTEX "<vcount>4</vcount><p>0 1 3 2</p></polylist>",
        "<polygons count='1'>" DAE_VERTEX "<p>0 1 3 2</p></polygons>"};
    static const unsigned fan[][3] = {{0, 1, 3}, {0, 3, 2}};
    struct file *file = malloc(sizeof *file);
    for (size_t i = 0; i < COUNT(primitives) + COUNT(polygons); i++) {
        const size_t k = i - COUNT(primitives);
        struct mesh mesh;
        char error[MESH_ERROR_MAX];
        file->size = 0;
        add_text(file, DAE_BEGIN "<library_geometries><geometry id='g'><mesh>" DAE_SQUARE);
        add_text(file, i < COUNT(primitives) ? primitives[i] : polygons[k]);
        add_text(file, "</mesh></geometry></library_geometries>" DAE_PLACED);
        add_text(file, "");
        file->bytes[file->size] = '\0';
        if (!mesh_parse(file->bytes, file->size, "a.stl", MESH_POLYGONS, &mesh, error))
            fail_msg("%zu: %s", i, error);
        assert_true(mesh.unit == 0);
        expect_mesh(mesh, 4, square, 2, i < COUNT(primitives) ? halves : fan);
        /* Faces of four vertices are refused where triangles are expected. */
        const bool triangles =
            mesh_parse(file->bytes, file->size, "", MESH_TRIANGLES, &mesh, error);
        assert_true(triangles == (i < COUNT(primitives)));
        mesh_free(&mesh);
    }
    free(file);
}

/* Numbers are exact: each transformation has one value. */
static void nodes_of_collada_are_placed(void **state)
{
    static const char text[] = DAE_BEGIN
        "<asset><unit name='inch' meter='0.5'/><up_axis>Y_UP</up_axis></asset>"
        "<library_nodes><node id='n'><rotate>0 0 2 90</rotate><node><scale>2 4 8</scale>"
        "<instance_geometry url='#g'/></node></node></library_nodes>"
        "<library_geometries><geometry id='g'><mesh><source id='p'>"
        "<float_array id='a' count='11'>9 1 2 3 0 4 5 6 0 7 8</float_array><technique_common>"
        "<accessor source='#a' count='2' stride='4' offset='1'/></technique_common></source>"
        "<vertices id='v'><input semantic='POSITION' source='#p'/></vertices>"
        "<triangles count='1'>" DAE_VERTEX
        "<p>0 1 0</p></triangles></mesh></geometry>"
        "</library_geometries>" DAE_SCENE(
            "<node id='s'><translate>10 20 30</translate><rotate>0 0 0 0</rotate>"
            "<instance_node url='#n'/></node>" /* ids are those of a kind */
            "<node><matrix>0 1 0 1 1 0 0 2 0 0 -1 3 0 0 0 1</matrix>"
            "<scale>1 1 2</scale><instance_geometry url='#g'/></node>"
            "<node><instance_node url='#n'/></node>");
    /* (x, y, z) becomes (-4 y, 2 x, 8 z), translated or not; and (y + 1, x + 2, 3 - 2 z). */
    static const double placed[][3] = {{1, 11, 27},  {-5, 14, 39}, {1.5, 1.5, -1.5},
                                       {3, 3, -4.5}, {-4, 1, 12},  {-10, 4, 24}};
    static const unsigned face[][3] = {{0, 1, 0}, {2, 3, 2}, {4, 5, 4}};
    struct mesh mesh = read_text(text);
    assert_true(mesh.unit == 0.5);
    expect_mesh(mesh, 6, placed, 3, face);
}

static void bad_collada_is_refused(void **state)
{
    static const char *const geometries[][2] = {
        /* of line 3, unless a line feed is before it */
        {"<triangles count='3'>" DAE_VERTEX "\n<p>0 1 2 3 2 1</p></triangles>", "line 6"},
        {"<triangles count='1'>" DAE_VERTEX "\n<p>0 1 2 3</p></triangles>", "line 6"},
        {"<triangles count='4000000000'>" DAE_VERTEX "<p>0 1 2</p></triangles>", "line 5"},
        {"<triangles count='2147483647'>" DAE_VERTEX "<p>0 1 2</p></triangles>", "line 5"},
        {"<triangles count='-1'>" DAE_VERTEX "<p>0 1 2</p></triangles>", "line 5"},
        {"<triangles>" DAE_VERTEX "<p>0 1 2</p></triangles>", "line 5"},
        {"<triangles count='1'>" DAE_VERTEX "</triangles>", "line 5"},
        {"<triangles count='1'>" DAE_VERTEX "<p>0 1 2</p><p>0 1 2</p></triangles>", "line 5"},
        {"<triangles count='1'>" DAE_VERTEX "\n<p>0 1\n4</p></triangles>", "line 6"},
        {"<triangles count='1'>" DAE_VERTEX "\n<p>0 1\n-1</p></triangles>", "line 6"},
        {"<triangles count='1'>" DAE_VERTEX "\n<p>0 1\n1.5</p></triangles>", "line 6"},
        {"<triangles count='1'>" DAE_VERTEX "\n<p>0 1\n2x</p></triangles>", "line 7"},
        {"<triangles count='1'>" DAE_VERTEX "\n<p>0 1\n<!-- -->2</p></triangles>", "line 7"},
        {"<triangles count='1'>" DAE_VERTEX "\n<p>0 1\n0x1</p></triangles>", "line 7"},
        {"<triangles count='1'><input semantic='VERTEX' source='#v'/><p>0 1 2</p></triangles>",
         "line 5"},
        {"<triangles count='1'><input semantic='VERTEX' source='#v' offset='3000000000'/>"
         "<p>0 1 2</p></triangles>",
         "line 5"},
        {"<triangles count='1'><input semantic='VERTEX' source='#v' offset='2147483647'/>"
         "<p>0 1 2</p></triangles>",
         "line 5"},
        {"<triangles count='1'>\n<input semantic='VERTEX' source='#p' offset='0'/></triangles>",
         "line 6"},
        {"<triangles count='1'>\n<input semantic='VERTEX' source='#p' offset='0'/><p>0 1 2</p>"
         "</triangles>",
         "line 6"},
        {"<triangles count='1'>\n<input semantic='VERTEX' source='v' offset='0'/><p>0 1 2</p>"
         "</triangles>",
         "line 6"},
        {"<triangles count='1'>\n<input semantic='NORMAL' source='#v' offset='0'/><p>0 1 2</p>"
         "</triangles>",
         "line 5"},
        {"<polylist count='1'>" DAE_VERTEX "<p>0 1 2</p></polylist>", "line 5"},
        {"<polylist count='1'>" DAE_VERTEX "<vcount>3 3</vcount><p>0 1 2</p></polylist>", "line 5"},
        {"<polylist count='1'>" DAE_VERTEX "<vcount>1e99</vcount><p>0 1 2</p></polylist>",
         "line 5"},
        {"<polylist count='1'>" DAE_VERTEX "<vcount>-3</vcount>\n<p>0 1 2</p></polylist>",
         "line 6"},
        {"<polylist count='2'>" DAE_VERTEX "<vcount>3 3</vcount>\n<p>0 1 2 3 2</p></polylist>",
         "line 6"},
        {"<polylist count='2'>" DAE_VERTEX "<vcount>3 0</vcount>\n<p>0 1 2</p></polylist>",
         "line 6"},
        {"<polylist count='1'>" DAE_VERTEX "<vcount>2</vcount>\n<p>0 1</p></polylist>", "line 6"},
        {"<polygons count='1'>" DAE_VERTEX "<p>0 1 2</p>\n<ph/></polygons>", "line 6"},
        {"\n<tristrips count='1'>" DAE_VERTEX "<p>0 1 2 3</p></tristrips>", "line 6"},
        {"<polygons count='2'>" DAE_VERTEX "<p>0 1 2</p></polygons>", "line 5"},
        {"<polygons count='1'>" DAE_VERTEX "<p/></polygons>", "line 5"},
    };
    static const char *const arrays[][2] = {
        /* in line 3 */
        {"<float_array id='a' count='9'>0 0 0 1 0 0 0 1</float_array>|"
         "<accessor source='#a' count='3' stride='3'/>",
         "line 3"},
        {"<float_array id='a' count='8'>0 0 0 1 0 0 0 1 0</float_array>|"
         "<accessor source='#a' count='2' stride='3'/>",
         "line 3"},
        {"<float_array id='a' count='9'>0 0 0 1 0 0 0 1\nnan</float_array>|"
         "<accessor source='#a' count='3' stride='3'/>",
         "line 4"},
        {"<float_array id='a' count='9'>0 0 0 1 0 0 0 1\n1e999</float_array>|"
         "<accessor source='#a' count='3' stride='3'/>",
         "line 4"},
        {"<float_array id='a' count='9'>0 0 0 1 0 0 0 1\n1,5</float_array>|"
         "<accessor source='#a' count='3' stride='3'/>",
         "line 4"},
        {"<float_array id='a' count='9'>0 0 0 1 0 0 0 1 0</float_array>|\n"
         "<accessor source='#a' count='4' stride='3'/>",
         "line 4"},
        {"<float_array id='a' count='9'>0 0 0 1 0 0 0 1 0</float_array>|\n"
         "<accessor source='#a' count='3' stride='3' offset='1'/>",
         "line 4"},
        {"<float_array id='a' count='9'>0 0 0 1 0 0 0 1 0</float_array>|\n"
         "<accessor source='#a' count='2147483647' stride='2147483647' offset='2147483647'/>",
         "line 4"},
        {"<float_array id='a' count='9'>0 0 0 1 0 0 0 1 0</float_array>|\n"
         "<accessor source='#a' count='9'/>",
         "line 4"},
        {"<float_array id='a' count='9'>0 0 0 1 0 0 0 1 0</float_array>|\n"
         "<accessor source='#b' count='3' stride='3'/>",
         "line 4"},
        {"<float_array id='a' count='9'>0 0 0 1 0 0 0 1 0</float_array><float_array id='a'/>|\n"
         "<accessor source='#a' count='3' stride='3'/>",
         "line 4"},
        {"<float_array id='a' count='9'>0 0 0 1 0 0 0 1 0</float_array>|", "line 3"},
    };
    static const char *const nodes[][2] = {
        /* in line 6 */
        {DAE_SCENE("<node><instance_geometry url='#h'/></node>"), "line 6"},
        {DAE_SCENE("<node><instance_geometry url='b.dae#g'/></node>"), "line 6"},
        {DAE_SCENE("<node><instance_geometry url='#s'/></node>"), "line 6"},
        {DAE_SCENE("\n<node id='n'><node><instance_node url='#n'/></node></node>"), "line 7"},
        {DAE_SCENE("<node id='n'/>\n<node id='n'/><node><instance_node url='#n'/></node>"),
         "line 7"},
        {DAE_SCENE("<node><instance_controller url='#n'/></node>"), "line 6"},
        {DAE_SCENE("<node>\n<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2</matrix></node>"), "line 7"},
        {DAE_SCENE("<node>\n<matrix>1 0 0 0 0 1 0 0 0 0 1 0</matrix></node>"), "line 7"},
        {DAE_SCENE("<node>\n<rotate>0 0 0 90</rotate></node>"), "line 7"},
        {DAE_SCENE("<node>\n<translate>0 0 nan</translate></node>"), "line 7"},
        {DAE_SCENE("<node>\n<scale>1e300 1 1</scale><scale>1e300 1 1</scale>"
                   "<instance_geometry url='#g'/></node>"),
         "line 3"},
        {"</COLLADA>", "line 2"},
        {"<scene><instance_visual_scene url='#s'/></scene></COLLADA>", "line 6"},
        {"<asset><unit meter='0'/></asset>" DAE_PLACED, "line 6"},
        {"<asset><unit meter='-1'/></asset>" DAE_PLACED, "line 6"},
        {"<asset><unit meter='1m'/></asset>" DAE_PLACED, "line 6"},
        {"<asset><unit meter='inf'/></asset>" DAE_PLACED, "line 6"},
        {"<node>\n</COLLADA>", "line 7"},
        {"&e;</COLLADA>", "line 6"},
        {"", "line 6"},
    };
    struct file *file = malloc(sizeof *file);
    for (size_t i = 0; i < COUNT(geometries); i++) {
        file->size = 0;
        add_text(file, DAE_BEGIN "<library_geometries><geometry id='g'><mesh>" DAE_SQUARE);
        add_text(file, geometries[i][0]);
        add_text(file, "</mesh></geometry></library_geometries>" DAE_PLACED);
        expect_error(file->bytes, file->size, "", geometries[i][1]);
    }
    for (size_t i = 0; i < COUNT(arrays); i++) {
        const char *bar = strchr(arrays[i][0], '|');
        file->size = 0;
        add_text(file, DAE_BEGIN "<library_geometries><geometry id='g'><mesh><source id='p'>");
        add(file, arrays[i][0], (size_t) (bar - arrays[i][0]));
        add_text(file, "<technique_common>");
        add_text(file, bar + 1);
        add_text(file,
                 "</technique_common></source><vertices id='v'><input semantic='POSITION' "
                 "source='#p'/></vertices><triangles count='1'>" DAE_VERTEX
                 "<p>0 1 2</p>"
                 "</triangles></mesh></geometry></library_geometries>" DAE_PLACED);
        expect_error(file->bytes, file->size, "", arrays[i][1]);
    }
    for (size_t i = 0; i < COUNT(nodes); i++)
        expect_refused(DAE_BEGIN DAE_GEOMETRY(DAE_TRIANGLES), nodes[i][0], nodes[i][1]);
    expect_refused("<!DOCTYPE COLLADA [<!ENTITY e '0 0 0'>]>\n", DAE_BEGIN, "line 1");
    expect_refused("<html>", "\n</html>", "line 1");
    expect_error("v 0 0 0\n", 8, "a.dae", "line 1");
    free(file);
}

/* Nodes that double 60 times, and 300 nested ones. Without a limit, the first would take 2^60
 * steps.
 */
static void collada_does_not_multiply(void **state)
{
    struct file *file = malloc(sizeof *file);
    char node[128];
    file->size = 0;
    add_text(file, DAE_BEGIN "<library_nodes>");
    for (int i = 0; i < 60; i++) {
        sprintf(node,
                "<node id='n%d'>\n<instance_node url='#n%d'/><instance_node url='#n%d'/></node>", i,
                i + 1, i + 1);
        add_text(file, node);
    }
    add_text(file, "<node id='n60'/></library_nodes>" DAE_SCENE(
                       "<node><instance_node url='#n0'/></node>"));
    struct mesh mesh;
    char error[MESH_ERROR_MAX];
    assert_false(parse(file->bytes, file->size, "", &mesh, error));
    assert_non_null(strstr(error, "more than 512 MB, with all instances"));
    file->size = 0;
    add_text(file,
             DAE_BEGIN DAE_GEOMETRY(DAE_TRIANGLES) "<library_visual_scenes><visual_scene id='s'>");
    for (int i = 0; i < 300; i++)
        add_text(file, "<node>\n");
    for (int i = 0; i < 300; i++)
        add_text(file, "</node>");
    add_text(file,
             "</visual_scene></library_visual_scenes><scene>"
             "<instance_visual_scene url='#s'/></scene></COLLADA>");
    expect_error(file->bytes, file->size, "", "line 261");
    free(file);
}

/* ---- What is none of them -------------------------------------------------------------------- */

static void other_files_are_refused(void **state)
{
    expect_error("", 0, "a.obj", "byte 0");
    expect_error("hello", 5, "a.txt", "byte 0");
    expect_error("\0\0\0", 3, "", "byte 0");
    expect_error("vv 1", 4, "", "byte 0");
    expect_error("solids\n", 7, "", "byte 0");
    expect_error("# v\n#", 5, "", "byte 0");
}

static void expect_unread(const char *path, const char *expected)
{
    struct mesh mesh;
    char error[MESH_ERROR_MAX];
    assert_false(mesh_read(path, MESH_TRIANGLES, &mesh, error));
    assert_string_equal(error, expected);
    assert_true(!mesh.vertex && !mesh.face);
}

static void write_file(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_true(file && fwrite(bytes, 1, size, file) == size && fclose(file) == 0);
}

static void only_regular_files_are_read(void **state)
{
    static const char lfs[] = "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n";
    char folder[] = "/tmp/fmb-test-XXXXXX", path[64], error[MESH_ERROR_MAX];
    struct mesh mesh;
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/mesh.obj", folder);
    expect_unread(path, strerror(ENOENT));
    expect_unread(folder, "a folder, not a file");
    expect_unread("/dev/null", "no regular file: write what it gives into one first");
    assert_int_equal(mkfifo(path, 0600), 0);
    expect_unread(path, "no regular file: write what it gives into one first");
    unlink(path);
    write_file(path, "", 0);
    expect_unread(path, "byte 0: the file is empty");
    write_file(path, lfs, sizeof lfs - 1);
    expect_unread(path, "byte 0: a Git LFS pointer, not the mesh: run 'git lfs pull'");
    write_file(path, obj, sizeof obj - 1);
    assert_true(mesh_read(path, MESH_TRIANGLES, &mesh, error));
    expect_mesh(mesh, 4, square, 2, halves);
    unlink(path);
    rmdir(folder);
}

/* ---- Made and written ------------------------------------------------------------------------ */

static struct mesh read_back(const struct mesh *mesh,
                             void (*write)(FILE *out, const struct mesh *mesh))
{
    char *bytes, error[MESH_ERROR_MAX];
    size_t size;
    struct mesh again;
    FILE *file = open_memstream(&bytes, &size);
    assert_non_null(file);
    write(file, mesh);
    assert_int_equal(fclose(file), 0);
    if (!mesh_parse(bytes, size, "", MESH_TRIANGLES, &again, error))
        fail_msg("%s", error);
    free(bytes);
    return again;
}

/* STL has vertices in another order; what the corners are is the same, but for floats. */
static void expect_same_corners(const struct mesh *a, const struct mesh *b, double most)
{
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_int_equal(a->face_count, b->face_count);
    for (size_t i = 0; i < a->face_count; i++)
        for (int corner = 0; corner < 3; corner++)
            for (int axis = 0; axis < 3; axis++)
                assert_true(fabs(a->vertex[a->face[i][corner]][axis] -
                                 b->vertex[b->face[i][corner]][axis]) <= most);
}

static void all_formats_are_the_same_mesh(void **state)
{
    static const unsigned counts[] = {8, 1000, 5000};
    for (int made = 0; made < 3; made++) {
        struct mesh mesh;
        bumpy_make(counts[made], (uint64_t) made, &mesh);
        for (size_t i = 0; i < FORMAT_COUNT; i++) {
            struct mesh again = read_back(&mesh, formats[i].write);
            if (strncmp(formats[i].name, "stl", 3) != 0)
                expect_same(&mesh, &again);
            /* A float is nearer than half of its last bit: 2^-24 of 2 at most. */
            expect_same_corners(&mesh, &again,
                                strcmp(formats[i].name, "stl-binary") == 0 ? 0x1p-23 : 0);
            mesh_free(&again);
        }
        mesh_free(&mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ply_of_text_is_read),
        cmocka_unit_test(ply_of_bytes_is_read),
        cmocka_unit_test(bad_ply_headers_are_refused),
        cmocka_unit_test(words_in_errors_are_printable_and_short),
        cmocka_unit_test(too_long_ply_headers_are_refused),
        cmocka_unit_test(bad_ply_bodies_are_refused),
        cmocka_unit_test(bad_ply_bytes_are_refused),
        cmocka_unit_test(white_space_may_follow_ply),
        cmocka_unit_test(counts_beyond_the_file_are_refused),
        cmocka_unit_test(stl_of_text_is_read),
        cmocka_unit_test(bad_stl_of_text_is_refused),
        cmocka_unit_test(stl_of_bytes_is_read),
        cmocka_unit_test(bad_stl_of_bytes_is_refused),
        cmocka_unit_test(obj_is_read),
        cmocka_unit_test(bad_obj_is_refused),
        cmocka_unit_test(polygons_are_read),
        cmocka_unit_test(collada_is_read),
        cmocka_unit_test(nodes_of_collada_are_placed),
        cmocka_unit_test(bad_collada_is_refused),
        cmocka_unit_test(collada_does_not_multiply),
        cmocka_unit_test(other_files_are_refused),
        cmocka_unit_test(only_regular_files_are_read),
        cmocka_unit_test(all_formats_are_the_same_mesh),
    };
    return cmocka_run_group_tests_name("mesh_read", tests, NULL, NULL);
}
