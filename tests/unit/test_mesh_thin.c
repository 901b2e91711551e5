/* What a picture of limited size keeps of meshes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "allocate.h"
#include "mesh_thin.h"

#include <stdlib.h>
#include <string.h>

static const struct mesh_thin_cost cost = {.face = 18, .vertex = 16, .number = 6};
static const size_t unlimited = SIZE_MAX / 4;

/* ---- Meshes ---------------------------------------------------------------------------------- */

/* side * side squares of two faces each, and one vertex of no face. */
static struct mesh make_plane(unsigned side)
{
    struct mesh mesh = {.vertex_count = (size_t) (side + 1) * (side + 1) + 1,
                        .face_count = 2 * (size_t) side * side};
    mesh.vertex = allocate(mesh.vertex_count, sizeof *mesh.vertex);
    mesh.face = allocate(mesh.face_count, sizeof *mesh.face);
    for (unsigned i = 0; i < side * side; i++) {
        const unsigned corner = i / side * (side + 1) + i % side;
        const unsigned face[2][3] = {{corner, corner + 1, corner + side + 1},
                                     {corner + 1, corner + side + 2, corner + side + 1}};
        memcpy(mesh.face[2 * i], face, sizeof face);
    }
    return mesh;
}

/* far: nothing meets. Else every fifth face does, every hundredth is needed, and most others are
 * beside some. */
static unsigned char *make_roles(const struct mesh *mesh, bool far)
{
    unsigned char *role = allocate(mesh->face_count, 1);
    for (size_t f = 0; f < mesh->face_count; f++)
        role[f] = far            ? MESH_THIN_REST
                  : f % 100 == 0 ? MESH_THIN_NEEDED
                  : f % 5 == 0   ? MESH_THIN_MET
                  : f % 5 == 2   ? MESH_THIN_REST
                                 : MESH_THIN_BESIDE;
    return role;
}

/* ---- What is kept ---------------------------------------------------------------------------- */

/* How many faces of each role are kept, which ascend. Each of their vertices is kept once, and
 * where it is said to be; no other is kept. */
static void check_kept(const struct mesh *mesh, const unsigned char *role,
                       const struct mesh_thinned *kept, size_t tally[4])
{
    bool *is_used = allocate(mesh->vertex_count, sizeof *is_used);
    size_t used = 0;
    memset(tally, 0, 4 * sizeof *tally);
    for (size_t f = 0; f < kept->face_count; f++) {
        assert_true(f == 0 || kept->face[f] > kept->face[f - 1]);
        assert_true(kept->face[f] < mesh->face_count);
        tally[role[kept->face[f]]]++;
        for (int corner = 0; corner < 3; corner++) {
            const unsigned vertex = mesh->face[kept->face[f]][corner];
            assert_true(kept->place[vertex] < kept->vertex_count);
            assert_int_equal(kept->vertex[kept->place[vertex]], vertex);
            used += !is_used[vertex];
            is_used[vertex] = true;
        }
    }
    assert_int_equal(used, kept->vertex_count);
    free(is_used);
}

static size_t bytes_of(const struct mesh *mesh, const struct mesh_thinned *kept)
{
    const size_t number = kept->face_count < mesh->face_count ? cost.number : 0;
    return kept->face_count * (cost.face + number) + kept->vertex_count * cost.vertex;
}

struct outcome {
    size_t tally[2][4], bytes;
};

static struct outcome thin_of(const struct mesh *const mesh[2], int count, bool far, size_t limit)
{
    struct outcome outcome = {.bytes = 0};
    unsigned char *role[2] = {NULL, NULL};
    struct mesh_thinned kept[2];
    for (int m = 0; m < count; m++)
        role[m] = make_roles(mesh[m], far);
    mesh_thin(mesh, count, role, &cost, limit, kept);
    for (int m = 0; m < count; m++) {
        check_kept(mesh[m], role[m], &kept[m], outcome.tally[m]);
        outcome.bytes += bytes_of(mesh[m], &kept[m]);
        mesh_thinned_free(&kept[m]);
        free(role[m]);
    }
    return outcome;
}

static struct outcome thin(const struct mesh *const mesh[2], int count, size_t limit)
{
    return thin_of(mesh, count, false, limit);
}

/* ---- Tests ----------------------------------------------------------------------------------- */

enum { SIDE = 400, FACES = 2 * SIDE * SIDE };

static void all_is_kept_where_there_is_room(void **state)
{
    struct mesh plane = make_plane(SIDE);
    const struct mesh *const mesh[2] = {&plane, NULL};
    const struct outcome all = thin(mesh, 1, unlimited);
    assert_int_equal(all.tally[0][MESH_THIN_REST], FACES / 5);
    assert_int_equal(all.tally[0][MESH_THIN_BESIDE], FACES * 3 / 5);
    assert_int_equal(all.tally[0][MESH_THIN_MET], FACES / 5 - FACES / 100);
    assert_int_equal(all.tally[0][MESH_THIN_NEEDED], FACES / 100);
    assert_int_equal(thin(mesh, 1, all.bytes).bytes, all.bytes);
    assert_true(thin(mesh, 1, all.bytes - 1).bytes < all.bytes);
    mesh_free(&plane);
    (void) state;
}

/* The limit is kept, and not by far more than it asks for: what matters less goes first. */
static void what_matters_least_goes_first(void **state)
{
    struct mesh plane[2] = {make_plane(SIDE), make_plane(SIDE)};
    const struct mesh *const mesh[2] = {&plane[0], &plane[1]};
    const struct outcome all = thin(mesh, 2, unlimited);
    for (size_t limit = all.bytes; limit > all.bytes / 8; limit -= limit / 3) {
        const struct outcome some = thin(mesh, 2, limit);
        assert_true(some.bytes <= limit && some.bytes > limit / 3);
        for (int role = MESH_THIN_REST; role < MESH_THIN_NEEDED; role++)
            assert_true(some.tally[0][role] > 0 && some.tally[1][role] > 0);
        if (some.tally[0][MESH_THIN_MET] < all.tally[0][MESH_THIN_MET])
            assert_true(some.tally[0][MESH_THIN_BESIDE] + some.tally[1][MESH_THIN_BESIDE] <= 2);
        if (some.tally[0][MESH_THIN_BESIDE] < all.tally[0][MESH_THIN_BESIDE])
            assert_true(some.tally[0][MESH_THIN_REST] <= 10000);
        assert_int_equal(some.tally[0][MESH_THIN_NEEDED], FACES / 100);
    }
    mesh_free(&plane[0]);
    mesh_free(&plane[1]);
    (void) state;
}

static void the_larger_mesh_is_thinned(void **state)
{
    struct mesh plane[2] = {make_plane(10), make_plane(SIDE)};
    const struct mesh *const mesh[2] = {&plane[0], &plane[1]};
    const size_t all = thin_of(mesh, 2, true, unlimited).bytes;
    const struct outcome some = thin_of(mesh, 2, true, all / 2);
    assert_int_equal(some.tally[0][MESH_THIN_REST], plane[0].face_count);
    assert_true(some.tally[1][MESH_THIN_REST] < plane[1].face_count);
    assert_true(some.bytes <= all / 2 && some.bytes > all / 4);
    mesh_free(&plane[0]);
    mesh_free(&plane[1]);
    (void) state;
}

static void the_needed_are_kept_whatever_they_take(void **state)
{
    struct mesh plane = make_plane(SIDE), none = {0};
    const struct mesh *const mesh[2] = {&plane, &none};
    const struct outcome few = thin(mesh, 2, 0);
    assert_int_equal(few.tally[0][MESH_THIN_NEEDED], FACES / 100);
    assert_int_equal(few.tally[0][MESH_THIN_MET], 1);
    assert_int_equal(few.tally[0][MESH_THIN_BESIDE], 1);
    assert_true(few.tally[0][MESH_THIN_REST] <= 10000);
    mesh_free(&plane);
    (void) state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_is_kept_where_there_is_room),
        cmocka_unit_test(what_matters_least_goes_first),
        cmocka_unit_test(the_larger_mesh_is_thinned),
        cmocka_unit_test(the_needed_are_kept_whatever_they_take),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
