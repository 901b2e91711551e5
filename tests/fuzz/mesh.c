/* Reads any bytes as a mesh, under a name chosen by their number. If the bytes are refused, the
 * report names a place that exists, and nothing of the mesh is left. If they are read, the mesh is
 * valid, and no larger than the bytes allow. Numbers are those that strtod() reads. */
#define _GNU_SOURCE /* memmem */
#include "fuzz.h"

#include "mesh.h"
#include "mesh_source.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Numbers --------------------------------------------------------------------------------- */

static bool same_bits(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b));
}

/* The text that is taken for a number; or where none is, that there is none for strtod(). */
static void check_number(const uint8_t *at)
{
    double value;
    char *rest;
    const uint8_t *end = mesh_number(at, &value);
    if (!end) {
        strtod((const char *) at, &rest);
        FUZZ_CHECK(rest == (const char *) at);
        return;
    }
    char *text = fuzz_room((size_t) (end - at) + 1);
    memcpy(text, at, (size_t) (end - at));
    text[end - at] = '\0';
    FUZZ_CHECK(same_bits(strtod(text, &rest), value) && *rest == '\0');
    free(text);
}

/* Where words begin. */
static void check_numbers(const uint8_t *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++)
        if (!isspace(bytes[i]) && (i == 0 || isspace(bytes[i - 1])))
            check_number(bytes + i);
}

/* ---- What is refused ------------------------------------------------------------------------- */

static size_t count_lines(const uint8_t *bytes, size_t size)
{
    size_t lines = 1;
    for (size_t i = 0; i < size; i++)
        lines += bytes[i] == '\n';
    return lines;
}

static void check_error(const char *error, const uint8_t *bytes, size_t size)
{
    const char *line = "line ", *byte = "byte ";
    char *rest;
    const unsigned long long number = strtoull(error + strlen(line), &rest, 10);
    FUZZ_CHECK(strncmp(error, line, strlen(line)) == 0 || strncmp(error, byte, strlen(byte)) == 0);
    FUZZ_CHECK(rest > error + strlen(line) && (*rest == ':' || *rest == ' '));
    if (*error == 'l')
        FUZZ_CHECK(number >= 1 && number <= count_lines(bytes, size));
    else
        FUZZ_CHECK(number <= size);
    FUZZ_CHECK(strlen(error) < MESH_ERROR_MAX - 1);
    for (; *error; error++)
        FUZZ_CHECK(*error >= ' ' && *error < 0x7f);
}

/* ---- What is read ---------------------------------------------------------------------------- */

/* Instances of COLLADA repeat what is in the file. */
static bool repeats(const uint8_t *bytes, size_t size)
{
    return memmem(bytes, size, "<COLLADA", 8);
}

static void check_mesh(const struct mesh *mesh, const uint8_t *bytes, size_t size)
{
    FUZZ_CHECK((mesh->vertex_count <= size / 3 && mesh->face_count <= size / 4) ||
               repeats(bytes, size));
    FUZZ_CHECK(!mesh->vertex == (mesh->vertex_count == 0));
    FUZZ_CHECK(!mesh->face == (mesh->face_count == 0));
    for (size_t i = 0; i < mesh->vertex_count; i++)
        for (int axis = 0; axis < 3; axis++)
            FUZZ_CHECK(isfinite(mesh->vertex[i][axis]));
    for (size_t i = 0; i < mesh->face_count; i++)
        for (int corner = 0; corner < 3; corner++)
            FUZZ_CHECK(mesh->face[i][corner] < mesh->vertex_count);
}

/* ---- STL as it is written ------------------------------------------------------------- */

/* Each coordinate is the float at its place, and no two vertices are the same. */
static void check_stl(const struct mesh *mesh, const uint8_t *bytes)
{
    for (size_t i = 0; i < mesh->face_count; i++) {
        for (int corner = 0; corner < 3; corner++) {
            for (int axis = 0; axis < 3; axis++) {
                const uint8_t *at = bytes + 84 + 50 * i + 12 + 12 * corner + 4 * axis;
                const uint32_t bits =
                    at[0] | (uint32_t) at[1] << 8 | (uint32_t) at[2] << 16 | (uint32_t) at[3] << 24;
                float value;
                memcpy(&value, &bits, sizeof value);
                FUZZ_CHECK(mesh->vertex[mesh->face[i][corner]][axis] == value);
            }
        }
    }
    for (size_t i = 0; i < mesh->vertex_count; i++)
        for (size_t j = 0; j < i; j++)
            FUZZ_CHECK(memcmp(mesh->vertex[i], mesh->vertex[j], sizeof *mesh->vertex) != 0);
}

static bool is_stl(const uint8_t *bytes, size_t size)
{
    return size >= 84 && memcmp(bytes, "ply", 3) != 0 && (size - 84) % 50 == 0 &&
           (bytes[80] | bytes[81] << 8) == (int) ((size - 84) / 50) && !bytes[82] && !bytes[83];
}

/* ---- Each name ------------------------------------------------------------------------------- */

static void check_file(const uint8_t *bytes, size_t size, const char *name)
{
    struct mesh mesh;
    char error[MESH_ERROR_MAX];
    if (mesh_parse(bytes, size, name, MESH_TRIANGLES, &mesh, error)) {
        check_mesh(&mesh, bytes, size);
        if (is_stl(bytes, size))
            check_stl(&mesh, bytes);
    } else {
        check_error(error, bytes, size);
        FUZZ_CHECK(!mesh.vertex && !mesh.face && mesh.vertex_count + mesh.face_count == 0);
    }
    mesh_free(&mesh);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"", "a.ply", "a.STL", "a.obj", "a.dae"};
    uint8_t *bytes = fuzz_room(size + 1);
    if (size > 0)
        memcpy(bytes, data, size);
    bytes[size] = '\0';
    check_numbers(bytes, size);
    check_file(bytes, size, names[size % (sizeof names / sizeof *names)]);
    free(bytes);
    return 0;
}
