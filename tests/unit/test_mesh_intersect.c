/* Which faces of meshes intersect: against a test of every pair by an oracle that knows the
 * vertices only; where steps put a mesh. */

#include "unit.h"

#include <float.h>
#include <math.h>

#include "allocate.h"
#include "bumpy.h"
#include "draw.h"
#include "mesh_intersect.h"
#include "mesh_transform.h"
#include "triangles.h"

/* ---- Meshes ---- */

static void make_mesh(size_t vertices, size_t faces, struct mesh *out)
{
    *out = (struct mesh){.vertex_count = vertices, .face_count = faces};
    out->vertex = allocate(vertices, sizeof *out->vertex);
    out->face = allocate(faces, sizeof *out->face);
}

/* How far apart the points of a grid are, and where it begins. */
struct grid {
    double pitch, from;
};

static const struct grid grids[] = {{1, 0},      {0.1, 0},     {0.1, 1000},     {0.7, -0.35},
                                    {1e150, 0},  {1e-160, 0},  {0x1p-1074, 0},  {0x1p-30, 1},
                                    {0.1e30, 1}, {1 / 3.0, 0}, {0.1, -0x1p-40}, {0.1, 1e12}};

/* Faces of any vertices of a small grid, some vertices there twice, and some beside the grid. */
static void draw_soup(struct draw *draw, const struct grid *grid, int most, int vertices, int faces,
                      struct mesh *out)
{
    make_mesh((size_t) vertices, (size_t) faces, out);
    for (int v = 0; v < vertices; v++) {
        for (int axis = 0; axis < 3; axis++)
            out->vertex[v][axis] = draw_int(draw, 0, most) * grid->pitch + grid->from;
        const double *p = out->vertex[draw_int(draw, 0, v)], *q = out->vertex[draw_int(draw, 0, v)];
        const int kind = draw_int(draw, 0, 9);
        for (int axis = 0; axis < 3 && kind < 2; axis++)
            out->vertex[v][axis] = kind ? p[axis] * 0.5 + q[axis] * 0.5 : p[axis];
        double *x = &out->vertex[v][draw_int(draw, 0, 2)];
        if (kind == 2)
            *x = nextafter(*x, HUGE_VAL);
        if (*x == 0 && draw_coin(draw))
            *x = -0.0;
    }
    for (int f = 0; f < faces; f++)
        for (int corner = 0; corner < 3; corner++)
            out->face[f][corner] = (unsigned) draw_int(draw, 0, vertices - 1);
    for (int n = 0; n < faces / 8; n++) /* some twice, round another way */
        for (int corner = 0, from = draw_int(draw, 0, faces - 1), turn = draw_int(draw, 0, 2);
             corner < 3; corner++)
            out->face[n][corner] = out->face[from][(corner + turn) % 3];
}

/* On the same grid, so that they have much in common. */
static void draw_soups(struct draw *draw, struct mesh out[2])
{
    const struct grid *grid = &grids[draw_int(draw, 0, (int) COUNT(grids) - 1)];
    const int most = draw_int(draw, 1, 3);
    for (int m = 0; m < 2; m++)
        draw_soup(draw, grid, most, draw_int(draw, 3, 24), draw_int(draw, 0, 30), &out[m]);
}

static void set_triangle(const struct mesh *mesh, size_t face, const double *velocity,
                         struct triangle *out)
{
    memset(out, 0, sizeof *out);
    for (int corner = 0; corner < 3; corner++)
        memcpy(out->vertex[corner], mesh->vertex[mesh->face[face][corner]],
               sizeof out->vertex[corner]);
    out->moving = velocity != NULL;
    if (velocity)
        memcpy(out->velocity, velocity, sizeof out->velocity);
}

/* ---- Every pair ---- */

static void fail_of(const struct mesh *a, size_t i, const struct mesh *b, size_t j,
                    const char *what)
{
    for (int f = 0; f < 2; f++) {
        struct triangle t;
        set_triangle(f ? b : a, f ? j : i, NULL, &t);
        printf("# face %zu:", f ? j : i);
        for (int k = 0; k < 9; k++)
            printf(" %a%s", t.vertex[k / 3][k % 3], k % 3 == 2 ? "," : "");
        printf("\n");
    }
    fail_msg("%s", what);
}

/* The next pair of the meeting, if it is this one. */
static const struct mesh_pair *take_pair(const struct mesh_intersection *meeting, size_t *at,
                                         size_t i, size_t j)
{
    const struct mesh_pair *pair = *at < meeting->count ? &meeting->pair[*at] : NULL;
    if (!pair || pair->a != i || pair->b != j)
        return NULL;
    ++*at;
    return pair;
}

/* Whether sign * (end - exact) >= 0. */
static bool is_beyond(double end, int sign, const mpq_t exact)
{
    mpq_t number;
    mpq_init(number);
    mpq_set_d(number, end);
    const int order = mpq_cmp(number, exact);
    mpq_clear(number);
    return sign * order >= 0;
}

static void assert_contact(const struct mesh_pair *pair, double duration,
                           const struct triangles_answer *truth)
{
    for (int end = 0; end < 2; end++) {
        const int sign = end ? 1 : -1;
        const double x = pair->contact[end], in = x - sign * (1e-12 * duration);
        assert_true(x >= 0 && x <= duration && is_beyond(x, sign, truth->contact[end]));
        assert_true(!is_beyond(in, sign, truth->contact[end]) || duration == 0);
    }
}

/* Counts again what the meeting says of itself. */
static void assert_counts(const struct mesh_query *question,
                          const struct mesh_intersection *meeting)
{
    size_t of[4] = {0}, faces[2] = {0};
    unsigned char *in[2] = {allocate(question->a->face_count, 1),
                            allocate(question->b->face_count, 1)};
    for (size_t k = 0; k < meeting->count; k++) {
        of[meeting->pair[k].verdict]++;
        in[0][meeting->pair[k].a] = 1;
        in[1][meeting->pair[k].b] = 1;
    }
    for (size_t i = 0; i < question->a->face_count; i++)
        faces[0] += in[0][i];
    for (size_t i = 0; i < question->b->face_count; i++)
        faces[1] += in[1][i];
    assert_int_equal(of[FMB_OVERLAPPING], meeting->overlapping);
    assert_int_equal(of[FMB_TOUCHING], meeting->touching);
    assert_int_equal(of[FMB_OVERLAPPING] + of[FMB_TOUCHING], meeting->count);
    assert_int_equal(faces[0], meeting->faces[0]);
    assert_int_equal(faces[1], meeting->faces[1]);
    free(in[0]);
    free(in[1]);
}

static void assert_meeting_of_two(const struct mesh_query *question)
{
    struct mesh_intersection meeting;
    struct triangles_answer truth;
    size_t at = 0;
    triangles_init(&truth);
    assert_int_equal(mesh_intersect(question, &meeting), FMB_OK);
    const bool moving = question->velocity[0] || question->velocity[1];
    assert_int_equal(meeting.moving, moving);
    for (size_t i = 0; i < question->a->face_count; i++)
        for (size_t j = 0; j < question->b->face_count; j++) {
            struct triangle pair[2];
            set_triangle(question->a, i, question->velocity[0], &pair[0]);
            set_triangle(question->b, j, question->velocity[1], &pair[1]);
            triangles_decide(pair, question->duration, moving, &truth);
            const struct mesh_pair *found = take_pair(&meeting, &at, i, j);
            if ((found ? found->verdict : FMB_SEPARATED) != truth.verdict)
                fail_of(question->a, i, question->b, j, "another verdict");
            if (found && moving)
                assert_contact(found, question->duration, &truth);
        }
    assert_int_equal(at, meeting.count);
    assert_counts(question, &meeting);
    mesh_intersection_free(&meeting);
    triangles_clear(&truth);
}

static void meshes_meet_where_every_pair_says(void **state)
{
    struct draw draw;
    draw_begin(&draw, "meshes_meet_where_every_pair_says");
    for (long n = draw_sample(150); n > 0; n--) {
        struct mesh mesh[2];
        draw_soups(&draw, mesh);
        const struct mesh_query question = {.a = &mesh[0], .b = &mesh[1], .duration = 1};
        assert_meeting_of_two(&question);
        mesh_free(&mesh[0]);
        mesh_free(&mesh[1]);
    }
}

static void moving_meshes_meet_where_every_pair_says(void **state)
{
    struct draw draw;
    draw_begin(&draw, "moving_meshes_meet_where_every_pair_says");
    for (long n = draw_sample(80); n > 0; n--) {
        struct mesh mesh[2];
        double velocity[2][3];
        const int who = draw_int(&draw, 1, 3);
        draw_soups(&draw, mesh);
        for (int k = 0; k < 6; k++) {
            const double *vertex = mesh[0].vertex[draw_int(&draw, 0, 2)];
            velocity[k / 3][k % 3] =
                draw_int(&draw, -2, 2) * 0.5 * (vertex[k % 3] - mesh[0].vertex[0][k % 3]);
        }
        const struct mesh_query question = {
            .a = &mesh[0],
            .b = &mesh[1],
            .velocity = {who & 1 ? velocity[0] : NULL, who & 2 ? velocity[1] : NULL},
            .duration = n % 4 ? 1 : draw_int(&draw, 0, 3) * 0.7};
        assert_meeting_of_two(&question);
        mesh_free(&mesh[0]);
        mesh_free(&mesh[1]);
    }
}

/* More candidates than are decided at a time, of faces that are as large as the mesh. */
static void soups_of_more_than_a_block(void **state)
{
    struct draw draw;
    struct mesh mesh[2];
    draw_begin(&draw, "soups_of_more_than_a_block");
    for (int m = 0; m < 2; m++)
        draw_soup(&draw, &grids[1], 3, 40, 90, &mesh[m]);
    const struct mesh_query question = {.a = &mesh[0], .b = &mesh[1], .duration = 1};
    assert_meeting_of_two(&question);
    mesh_free(&mesh[0]);
    mesh_free(&mesh[1]);
}

/* Closed ones, one of them pushed into the other. */
static void closed_meshes_meet_where_every_pair_says(void **state)
{
    static const double way[][3] = {{0, 0, 0}, {0.1, 0.2, 0.3}, {1.9, 0, 0}, {0, 0, 5}};
    for (size_t n = 0; n < COUNT(way); n++) {
        struct mesh mesh[2];
        struct mesh_transform transform = {.count = 1, .step = {{.kind = MESH_TRANSLATE}}};
        memcpy(transform.step[0].number, way[n], sizeof way[n]);
        bumpy_make(72, 1, &mesh[0]);
        bumpy_make(72, n == 0 ? 1 : 2, &mesh[1]);
        assert_true(mesh_transform(&transform, &mesh[1]) == SIZE_MAX);
        const struct mesh_query question = {.a = &mesh[0], .b = &mesh[1], .duration = 1};
        assert_meeting_of_two(&question);
        mesh_free(&mesh[0]);
        mesh_free(&mesh[1]);
    }
}

/* One face of that size, and one of another mesh that is near it. */
static void faces_of_every_size_meet(void **state)
{
    static const double sizes[] = {1, DBL_MAX / 2, 0x1p-1074};
    for (size_t n = 0; n < COUNT(sizes); n++) {
        struct mesh mesh[2];
        struct mesh_intersection meeting;
        for (int m = 0; m < 2; m++) {
            make_mesh(3, 1, &mesh[m]);
            for (unsigned corner = 0; corner < 3; corner++) {
                mesh[m].face[0][corner] = corner;
                mesh[m].vertex[corner][corner] = sizes[n];
            }
        }
        const struct mesh_query question = {.a = &mesh[0], .b = &mesh[1], .duration = 1};
        assert_int_equal(mesh_intersect(&question, &meeting), FMB_OK);
        assert_int_equal(meeting.overlapping, 1);
        mesh_intersection_free(&meeting);
        mesh_free(&mesh[0]);
        mesh_free(&mesh[1]);
    }
}

static void empty_meshes_meet_nothing(void **state)
{
    struct mesh mesh[3] = {{0}};
    bumpy_make(8, 1, &mesh[1]);
    make_mesh(5, 0, &mesh[2]); /* only vertices */
    for (int k = 0; k < 9; k++) {
        if (k == 4)
            continue; /* the mesh with faces, and itself */
        const struct mesh_query question = {.a = &mesh[k / 3], .b = &mesh[k % 3], .duration = 1};
        struct mesh_intersection meeting;
        assert_int_equal(mesh_intersect(&question, &meeting), FMB_OK);
        assert_int_equal(meeting.count, 0);
        mesh_intersection_free(&meeting);
    }
    for (int m = 0; m < 3; m++)
        mesh_free(&mesh[m]);
}

/* ---- Steps ---- */

static size_t put(const struct mesh_step *step, int count, const double from[3], double out[3])
{
    struct mesh_transform transform = {.count = count};
    struct mesh mesh;
    make_mesh(2, 0, &mesh); /* the first one stays near */
    memcpy(mesh.vertex[1], from, sizeof mesh.vertex[1]);
    if (count > 0)
        memcpy(transform.step, step, (size_t) count * sizeof *step);
    const size_t far = mesh_transform(&transform, &mesh);
    memcpy(out, mesh.vertex[1], sizeof mesh.vertex[1]);
    mesh_free(&mesh);
    return far;
}

static void assert_put(const struct mesh_step *step, int count, const double from[3], double x,
                       double y, double z)
{
    double at[3];
    assert_true(put(step, count, from, at) == SIZE_MAX);
    assert_true(at[0] == x && at[1] == y && at[2] == z);
}

static void right_angles_are_exact(void **state)
{
    static const double p[3] = {0.1, 1e300, -0x1p-1074};
    static const struct {
        double degrees;
        int quarters;
    } angle[] = {{0, 0},     {90, 1},   {180, 2},  {270, 3},   {360, 0},        {450, 1},
                 {-90, 3},   {-180, 2}, {-270, 1}, {-360, 0},  {36000090, 1},   {-0.0, 0},
                 {36e15, 0}, {810, 1},  {540, 2},  {-1350, 1}, {0x1p60 * 45, 0}};
    for (int axis = 0; axis < 3; axis++)
        for (size_t n = 0; n < COUNT(angle); n++) {
            const struct mesh_step step = {MESH_ROTATE, axis, {angle[n].degrees}};
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            double expected[3] = {p[0], p[1], p[2]};
            for (int k = 0; k < angle[n].quarters; k++) { /* the right hand: u goes to v */
                const double x = expected[u];
                expected[u] = -expected[v];
                expected[v] = x;
            }
            assert_put(&step, 1, p, expected[0], expected[1], expected[2]);
        }
}

/* Each coordinate is rounded once in a translation, and in a scale. */
static void steps_round_once(void **state)
{
    struct draw draw;
    draw_begin(&draw, "steps_round_once");
    for (long n = draw_sample(2000); n > 0; n--) {
        struct mesh_step step = {.kind = n % 2 ? MESH_TRANSLATE : MESH_SCALE};
        double p[3], x[3];
        for (int axis = 0; axis < 3; axis++) {
            p[axis] = draw_log(&draw, -40, 40);
            step.number[axis] = draw_log(&draw, -40, 40);
            x[axis] = n % 2 ? p[axis] + step.number[axis] : p[axis] * step.number[axis];
        }
        assert_put(&step, 1, p, x[0], x[1], x[2]);
    }
}

static void what_goes_too_far_is_reported(void **state)
{
    static const double p[3] = {1, 0, -1}, half[3] = {DBL_MAX / 2, -DBL_MAX / 2, 0};
    const double beyond = nextafter(DBL_MAX / 2, INFINITY);
    double at[3];
    assert_true(put(NULL, 0, half, at) == SIZE_MAX);
    for (int axis = 0; axis < 3; axis++) {
        struct mesh_step far = {.kind = MESH_TRANSLATE};
        far.number[axis] = axis == 1 ? -beyond : beyond;
        assert_int_equal(put(&far, 1, (const double[3]){0, 0, 0}, at), 0); /* all vertices move */
        double one[3] = {0};
        one[axis] = far.number[axis];
        assert_int_equal(put(NULL, 0, one, at), 1);
    }
    const struct mesh_step large = {MESH_SCALE, 0, {DBL_MAX, 1, 1}};
    const struct mesh_step none = {MESH_SCALE, 0, {0, 0, 0}};
    const struct mesh_step back = {MESH_SCALE, 0, {0x1p-1000, 1, 1}};
    assert_int_equal(put(&large, 1, p, at), 1);
    assert_int_equal(put((struct mesh_step[]){large, large, back}, 3, p, at), 1);
    assert_int_equal(put((struct mesh_step[]){large, large, none}, 3, p, at), 1); /* no number */
    assert_true(put((struct mesh_step[]){large, none}, 2, p, at) == SIZE_MAX);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(meshes_meet_where_every_pair_says),
        cmocka_unit_test(moving_meshes_meet_where_every_pair_says),
        cmocka_unit_test(soups_of_more_than_a_block),
        cmocka_unit_test(closed_meshes_meet_where_every_pair_says),
        cmocka_unit_test(faces_of_every_size_meet),
        cmocka_unit_test(empty_meshes_meet_nothing),
        cmocka_unit_test(right_angles_are_exact),
        cmocka_unit_test(steps_round_once),
        cmocka_unit_test(what_goes_too_far_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
