/* The oracle on cases worked out by hand, so that it can be trusted elsewhere. It is called
 * about each case in both orders, and with either frame or both given as hulls. */

#include "unit.h"

#include <float.h>
#include <math.h>

#include "gap_check.h"
#include "oracle.h"
#include "question.h"

/* clang-format off */
#define UNIT2 {{1, 0}, {0, 1}}
#define UNIT3 {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}
#define SQUARE 2, FMB_CUBOID, UNIT2
#define CUBE 3, FMB_CUBOID, UNIT3
#define STILL {0}, false

struct known {
    const char *what;
    struct question question;
    enum fmb_verdict verdict;
    double contact[2];
    double box[2][FMB_DIM_MAX];
};

/* ---- Plane ---- */

static const struct known plane[] = {
    {"squares share an area", {{SQUARE, {0}, STILL}, {SQUARE, {0.5, 0.25}, STILL}, 1},
     FMB_OVERLAPPING, {0}, {{0.5, 0.25}, {1, 1}}},
    {"squares share an edge", {{SQUARE, {0}, STILL}, {SQUARE, {1, 0.5}, STILL}, 1},
     FMB_TOUCHING, {0}, {{1, 0.5}, {1, 1}}},
    {"squares share a corner", {{SQUARE, {0}, STILL}, {SQUARE, {-1, -1}, STILL}, 1},
     FMB_TOUCHING, {0}, {{0, 0}, {0, 0}}},
    {"squares a subnormal apart",
     {{SQUARE, {0}, STILL}, {2, FMB_CUBOID, {{-1, 0}, {0, 1}}, {-0x1p-1074, 0}, STILL}, 1},
     FMB_SEPARATED, {0}, {{0}}},
    {"squares a subnormal into each other",
     {{SQUARE, {0}, STILL}, {2, FMB_CUBOID, {{-1, 0}, {0, 1}}, {0x1p-1074, 0}, STILL}, 1},
     FMB_OVERLAPPING, {0}, {{0, 0}, {0x1p-1074, 1}}},
    {"triangles, hypotenuse on hypotenuse",
     {{2, FMB_TETRAHEDRON, UNIT2, {0}, STILL}, {2, FMB_TETRAHEDRON, {{-1, 0}, {0, -1}}, {1, 1}, STILL}, 1},
     FMB_TOUCHING, {0}, {{0, 0}, {1, 1}}},
    {"triangle misses what a square would hit",
     {{2, FMB_TETRAHEDRON, UNIT2, {0}, STILL}, {SQUARE, {0.75, 0.75}, STILL}, 1},
     FMB_SEPARATED, {0}, {{0}}},
    {"corner of a square inside a triangle",
     {{2, FMB_TETRAHEDRON, UNIT2, {0}, STILL}, {SQUARE, {0.25, 0.25}, STILL}, 1},
     FMB_OVERLAPPING, {0}, {{0.25, 0.25}, {0.75, 0.75}}},
    {"square moves in from the right: at t = 1 of 4",
     {{SQUARE, {0}, {0}, true}, {SQUARE, {3, 0}, {-2, 0}, true}, 4},
     FMB_OVERLAPPING, {1, 2}, {{0, 0}, {1, 1}}},
    {"square that never arrives, T = 0.5", {{SQUARE, {0}, STILL}, {SQUARE, {3, 0}, {-2, 0}, true}, 0.5},
     FMB_SEPARATED, {0}, {{0}}},
    {"square that arrives as the window ends, T = 1", {{SQUARE, {0}, STILL}, {SQUARE, {3, 0}, {-2, 0}, true}, 1},
     FMB_TOUCHING, {1, 1}, {{1, 0}, {1, 1}}},
    {"square slides along an edge", {{SQUARE, {0}, STILL}, {SQUARE, {1, -3}, {0, 1}, true}, 8},
     FMB_TOUCHING, {2, 4}, {{1, 0}, {1, 1}}},
    {"both move with equal velocities: the box is swept", {{SQUARE, {0}, {2, 0}, true}, {SQUARE, {0.5, 0}, {2, 0}, true}, 3},
     FMB_OVERLAPPING, {0, 3}, {{0.5, 0}, {7, 1}}},
    {"T = 0: the start is all there is", {{SQUARE, {0}, {0}, true}, {SQUARE, {1, 0}, {-1, 0}, true}, 0},
     FMB_TOUCHING, {0, 0}, {{1, 0}, {1, 1}}},
    {"overlap at the start, then recede", {{SQUARE, {0}, STILL}, {SQUARE, {0.5, 0}, {1, 0}, true}, 2},
     FMB_OVERLAPPING, {0, 0.5}, {{0.5, 0}, {1, 1}}},
    {"a velocity that is not carried is not read",
     {{SQUARE, {0}, {9, 9}, false}, {SQUARE, {1, 0}, {0, 0}, true}, 2},
     FMB_TOUCHING, {0, 2}, {{1, 0}, {1, 1}}},
};

/* ---- Flat frames in the plane ---- */
static const struct known flat_plane[] = {
    {"segment through a square", {{SQUARE, {0}, STILL}, {2, FMB_CUBOID, {{4, 0}, {0, 0}}, {-1, 0.5}, STILL}, 1},
     FMB_OVERLAPPING, {0}, {{0, 0.5}, {1, 0.5}}},
    {"segment along the edge of a square",
     {{SQUARE, {0}, STILL}, {2, FMB_CUBOID, {{4, 0}, {-4, 0}}, {0.5, 1}, STILL}, 1},
     FMB_TOUCHING, {0}, {{0, 1}, {1, 1}}},
    {"collinear segments share a length",
     {{2, FMB_CUBOID, {{1, 1}, {2, 2}}, {0}, STILL}, {2, FMB_TETRAHEDRON, {{1, 1}, {2, 2}}, {2, 2}, STILL}, 1},
     FMB_OVERLAPPING, {0}, {{2, 2}, {3, 3}}},
    {"collinear segments share an end",
     {{2, FMB_CUBOID, {{1, 1}, {2, 2}}, {0}, STILL}, {2, FMB_TETRAHEDRON, {{1, 1}, {2, 2}}, {3, 3}, STILL}, 1},
     FMB_TOUCHING, {0}, {{3, 3}, {3, 3}}},
    {"parallel segments",
     {{2, FMB_CUBOID, {{1, 1}, {2, 2}}, {0}, STILL}, {2, FMB_CUBOID, {{1, 1}, {2, 2}}, {0, 0x1p-1074}, STILL}, 1},
     FMB_SEPARATED, {0}, {{0}}},
    {"segments cross",
     {{2, FMB_CUBOID, {{2, 2}, {0, 0}}, {0}, STILL}, {2, FMB_CUBOID, {{-2, 2}, {0, 0}}, {2, 0}, STILL}, 1},
     FMB_OVERLAPPING, {0}, {{1, 1}, {1, 1}}},
    {"segments make a T",
     {{2, FMB_CUBOID, {{2, 2}, {0, 0}}, {0}, STILL}, {2, FMB_CUBOID, {{-2, 2}, {0, 0}}, {1, 1}, STILL}, 1},
     FMB_TOUCHING, {0}, {{1, 1}, {1, 1}}},
    {"equal points overlap",
     {{2, FMB_CUBOID, {{0}}, {3, 4}, STILL}, {2, FMB_TETRAHEDRON, {{0}}, {3, 4}, STILL}, 1},
     FMB_OVERLAPPING, {0}, {{3, 4}, {3, 4}}},
    {"points differ", {{2, FMB_CUBOID, {{0}}, {3, 4}, STILL}, {2, FMB_TETRAHEDRON, {{0}}, {3, 5}, STILL}, 1},
     FMB_SEPARATED, {0}, {{0}}},
    {"a point passes through a point",
     {{2, FMB_CUBOID, {{0}}, {3, 4}, STILL}, {2, FMB_CUBOID, {{0}}, {1, 4}, {0.5, 0}, true}, 8},
     FMB_OVERLAPPING, {4, 4}, {{3, 4}, {3, 4}}},
    {"a point on the corner of a square", {{SQUARE, {0}, STILL}, {2, FMB_CUBOID, {{0}}, {1, 1}, STILL}, 1},
     FMB_TOUCHING, {0}, {{1, 1}, {1, 1}}},
    {"a point in a square", {{SQUARE, {0}, STILL}, {2, FMB_TETRAHEDRON, {{0}}, {0.5, 0x1p-1074}, STILL}, 1},
     FMB_OVERLAPPING, {0}, {{0.5, 0x1p-1074}, {0.5, 0x1p-1074}}},
};

/* ---- Space ---- */
static const struct known space[] = {
    {"cubes share a face", {{CUBE, {0}, STILL}, {CUBE, {0, 0, 1}, STILL}, 1},
     FMB_TOUCHING, {0}, {{0, 0, 1}, {1, 1, 1}}},
    {"the scene of the design",
     {{CUBE, {0}, {0, 0, 0}, true}, {3, FMB_TETRAHEDRON, UNIT3, {0.5, 0, 0}, STILL}, 1},
     FMB_OVERLAPPING, {0, 1}, {{0.5, 0, 0}, {1, 1, 1}}},
    {"a tetrahedron's slope on a cube's corner",
     {{3, FMB_TETRAHEDRON, {{3, 0, 0}, {0, 3, 0}, {0, 0, 3}}, {0}, STILL}, {CUBE, {1, 1, 1}, STILL}, 1},
     FMB_TOUCHING, {0}, {{1, 1, 1}, {1, 1, 1}}},
    {"cubes, edge across edge",
     {{3, FMB_CUBOID, {{1, 1, 0}, {-1, 1, 0}, {0, 0, 1}}, {0}, STILL},
      {3, FMB_CUBOID, {{1, 0, 1}, {1, 0, -1}, {0, 1, 0}}, {1, 0.5, 0.5}, STILL}, 1},
     FMB_TOUCHING, {0}, {{1, 1, 0.5}, {1, 1, 0.5}}},
    {"a cube flies through a corner of another, T = 2",
     {{CUBE, {0}, STILL}, {CUBE, {2, 1, 0.5}, {-1, -1, 0}, true}, 2},
     FMB_OVERLAPPING, {1, 2}, {{0, 0, 0.5}, {1, 1, 1}}},
    {"cubes graze each other's edges in an instant",
     {{CUBE, {0}, STILL}, {CUBE, {2, 0, 0.25}, {-1, 1, 0}, true}, 2},
     FMB_TOUCHING, {1, 1}, {{1, 1, 0.25}, {1, 1, 1}}},
};

/* ---- Flat frames in space ---- */
static const struct known flat_space[] = {
    {"a plate through a box",
     {{CUBE, {0}, STILL}, {3, FMB_FACE, {{4, 0, 0}, {0, 4, 0}}, {-1, -1, 0.5}, STILL}, 1},
     FMB_OVERLAPPING, {0}, {{0, 0, 0.5}, {1, 1, 0.5}}},
    {"a plate on a box",
     {{CUBE, {0}, STILL}, {3, FMB_CUBOID, {{4, 0, 0}, {0, 4, 0}, {4, 4, 0}}, {-1, -1, 1}, STILL}, 1},
     FMB_TOUCHING, {0}, {{0, 0, 1}, {1, 1, 1}}},
    {"coplanar faces share an area",
     {{3, FMB_FACE, {{2, 0, 0}, {0, 2, 0}}, {0, 0, 7}, STILL},
      {3, FMB_FACE, {{-2, 0, 0}, {0, -2, 0}}, {1.5, 1.5, 7}, STILL}, 1},
     FMB_OVERLAPPING, {0}, {{0, 0, 7}, {1.5, 1.5, 7}}},
    {"coplanar faces share an edge",
     {{3, FMB_FACE, {{2, 0, 0}, {0, 2, 0}}, {0, 0, 7}, STILL},
      {3, FMB_FACE, {{-2, 0, 0}, {0, -2, 0}}, {2, 2, 7}, STILL}, 1},
     FMB_TOUCHING, {0}, {{0, 0, 7}, {2, 2, 7}}},
    {"coplanar faces apart",
     {{3, FMB_FACE, {{2, 0, 0}, {0, 2, 0}}, {0, 0, 7}, STILL},
      {3, FMB_FACE, {{-2, 0, 0}, {0, -2, 0}}, {2, 2.5, 7}, STILL}, 1},
     FMB_SEPARATED, {0}, {{0}}},
    {"faces cross, as two cards",
     {{3, FMB_FACE, {{4, 0, 0}, {0, 4, 0}}, {0, 0, 0}, STILL},
      {3, FMB_FACE, {{4, 0, 0}, {0, 0, 4}}, {0, 1, -1}, STILL}, 1},
     FMB_OVERLAPPING, {0}, {{0, 1, 0}, {3, 1, 0}}},
    {"a card stands on a card",
     {{3, FMB_FACE, {{4, 0, 0}, {0, 4, 0}}, {0, 0, 0}, STILL},
      {3, FMB_FACE, {{4, 0, 0}, {0, 0, 4}}, {0, 1, 0}, STILL}, 1},
     FMB_TOUCHING, {0}, {{0, 1, 0}, {3, 1, 0}}},
    {"a segment pierces a face",
     {{3, FMB_FACE, {{4, 0, 0}, {0, 4, 0}}, {0, 0, 0}, STILL},
      {3, FMB_CUBOID, {{0, 0, 2}, {0, 0, 1}, {0, 0, -1}}, {1, 1, -1}, STILL}, 1},
     FMB_OVERLAPPING, {0}, {{1, 1, 0}, {1, 1, 0}}},
    {"a segment meets a face with its end",
     {{3, FMB_FACE, {{4, 0, 0}, {0, 4, 0}}, {0, 0, 0}, STILL},
      {3, FMB_TETRAHEDRON, {{0, 0, 2}, {0}, {0}}, {1, 1, 0}, STILL}, 1},
     FMB_TOUCHING, {0}, {{1, 1, 0}, {1, 1, 0}}},
    {"skew segments",
     {{3, FMB_CUBOID, {{4, 0, 0}, {0}, {0}}, {0, 0, 0}, STILL},
      {3, FMB_CUBOID, {{0, 4, 0}, {0}, {0}}, {1, -1, 0x1p-1074}, STILL}, 1},
     FMB_SEPARATED, {0}, {{0}}},
    {"equal points", {{3, FMB_CUBOID, {{0}}, {1, 2, 3}, STILL}, {3, FMB_FACE, {{0}}, {1, 2, 3}, STILL}, 1},
     FMB_OVERLAPPING, {0}, {{1, 2, 3}, {1, 2, 3}}},
    {"a plate falls through a plate, T = 4",
     {{3, FMB_CUBOID, {{1, 0, 0}, {0, 1, 0}, {0}}, {0}, STILL},
      {3, FMB_CUBOID, {{1, 0, 0}, {0, 1, 0}, {0}}, {0.5, 0, 1}, {0, 0, -0.5}, true}, 4},
     FMB_OVERLAPPING, {2, 2}, {{0.5, 0, 0}, {1, 1, 0}}},
    {"a plate falls past a plate, edge along edge, T = 4",
     {{3, FMB_CUBOID, {{1, 0, 0}, {0, 1, 0}, {0}}, {0}, STILL},
      {3, FMB_CUBOID, {{1, 0, 0}, {0, 1, 0}, {0}}, {1, 0, 1}, {0, 0, -0.5}, true}, 4},
     FMB_TOUCHING, {2, 2}, {{1, 0, 0}, {1, 1, 0}}},
    {"huge and subnormal in one pair",
     {{3, FMB_CUBOID, {{DBL_MAX, 0, 0}, {0, 0x1p-1074, 0}, {0, 0, 1}}, {0}, STILL},
      {3, FMB_CUBOID, {{0x1p-1074, 0, 0}, {0, DBL_MAX, 0}, {0, 0, 1}}, {0}, STILL}, 1},
     FMB_OVERLAPPING, {0}, {{0, 0, 0}, {0x1p-1074, 0x1p-1074, 1}}},
};

/* clang-format on */

static void assert_equal(const char *what, const mpq_t found, double expected)
{
    mpq_t exact;
    mpq_init(exact);
    mpq_set_d(exact, expected);
    if (mpq_cmp(found, exact) != 0)
        fail_msg("%s: %.17g, expected %.17g", what, mpq_get_d(found), expected);
    mpq_clear(exact);
}

/* ---- Placed ---- */

/* clang-format off */
/* A square of edge 5 turned by the angle whose cosine is 3/5: w = 2, z = 1. Its corners: 0, (3, 4),
 * (-1, 7), (-4, 3). */
#define TURNED_SQUARE {2, FMB_CUBOID, {{5, 0}, {0, 5}}, {0}, STILL, {0}, {0x1p500, 0x1p499}, 2, 0}
#define HALF_CUBE(x, y, z) 3, FMB_BOX, UNIT3, {x, y, z}, {0}, false
static const struct known placed[] = {
    {"a turned square and one at its corner", {TURNED_SQUARE, {SQUARE, {3, 4}, STILL}, 1},
     FMB_TOUCHING, {0}, {{3, 4}, {3, 4}}},
    {"a turned square and a box that its corner is in",
     {TURNED_SQUARE, {2, FMB_BOX, UNIT2, {3, 4}, {0}, false, {0.5, 0.5}, {0}, 0, 0}, 1},
     FMB_TOUCHING, {0}, {{3, 4}, {3, 4}}},
    {"a turned square and a box on its way past the corner",
     {TURNED_SQUARE, {2, FMB_BOX, UNIT2, {2.75, 0}, {0, 2}, true}, 4},
     FMB_OVERLAPPING, {1.25, 2.53125}, {{2.25, 3}, {3, 4.5625}}},
    {"a cuboid whose origin is turned with it",
     {{CUBE, {10, 0, 0}, {0}, false, {1, 0, 0}, {1, 0, 0, 1}, 4, 0}, {CUBE, {10, 2, 0}, STILL}, 1},
     FMB_TOUCHING, {0}, {{10, 2, 0}, {10, 2, 1}}},
    {"boxes, one turned by a third of the diagonal, share a face",
     {{HALF_CUBE(0, 0, 0), {0}, {-3, 3, 3, 3}, 4, 0}, {HALF_CUBE(0, 0, 1)}, 1},
     FMB_TOUCHING, {0}, {{-0.5, -0.5, 0.5}, {0.5, 0.5, 0.5}}},
    {"a face turned by half about x, and the corner of a box",
     {{3, FMB_FACE, {{2, 0, 0}, {0, 2, 0}}, {0}, {0}, false, {0}, {0, 1e-150, 0, 0}, 4, 0},
      {HALF_CUBE(-0.5, 0.5, 0), {0, -1, 0}}, 1},
     FMB_TOUCHING, {0}, {{0, -1, 0}, {0, 0, 0}}},
    {"tetrahedra turned about each axis by the half angle whose tangent is 1/2",
     {{3, FMB_TETRAHEDRON, {{5, 0, 0}, {0, 5, 0}, {0, 0, 1}}, {0}, {0}, false, {0}, {2, 0, 0, 1}, 4, 0},
      {3, FMB_TETRAHEDRON, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {3, 4, 0}, STILL}, 1},
     FMB_TOUCHING, {0}, {{3, 4, 0}, {3, 4, 0}}},
};
/* clang-format on */

/* Equal and opposite orientations are the same: nothing else is said of the length. */
static void an_orientation_has_no_length(void **state)
{
    static const double lengths[] = {1, -1, 3, 1e-150, 1e150, -0x1p-1000};
    struct question question = placed[0].question;
    for (size_t i = 0; i < COUNT(lengths); i++) {
        struct fmb_body body[2];
        struct pair pair;
        struct oracle_answer truth;
        question.a.orientation[0] = 2 * lengths[i];
        question.a.orientation[1] = lengths[i];
        question_pair(&question, body, &pair);
        oracle_init(&truth);
        oracle_decide(&pair, 0, &truth);
        assert_int_equal(truth.verdict, FMB_TOUCHING);
        oracle_clear(&truth);
    }
}

/* Two unit squares beside each other, and two above: a body of both pairs is one of 2 x 1. */
static void bodies_of_frames(void **state)
{
    static const double square[2][6] = {{0, 0, 1, 0, 0, 1}, {1, 0, 1, 0, 0, 1}};
    struct fmb_frame frames[2] = {{.dim = 2}, {.dim = 2}};
    for (int i = 0; i < 2; i++) {
        frames[i].shape = FMB_CUBOID;
        frames[i].count = 2;
        frames[i].origin[0] = square[i][0];
        frames[i].component[0][0] = frames[i].component[1][1] = 1;
    }
    const struct fmb_body body = {.dim = 2, .frame_count = 2, .frames = frames};
    struct pair pair = {{.body = &body}, {.body = &body, .position = {2, 0.5}}, 3};
    struct oracle_answer truth;
    oracle_init(&truth);
    oracle_decide(&pair, FMB_WANT_BOX, &truth);
    assert_int_equal(truth.verdict, FMB_TOUCHING);
    assert_equal("first", truth.contact[0], 0);
    assert_equal("last", truth.contact[1], 3);
    assert_equal("x", truth.box[0][0], 2);
    assert_equal("y", truth.box[1][1], 1);

    pair.b.position[0] = 0.5; /* at rest: x from 0.5 to 2; all the way: one frame after another */
    oracle_decide(&pair, FMB_WANT_BOX, &truth);
    assert_int_equal(truth.verdict, FMB_OVERLAPPING);
    assert_equal("x", truth.box[0][0], 0.5);
    assert_equal("x", truth.box[1][0], 2);

    pair.b.position[0] = -3;
    pair.b.velocity[0] = 2;
    oracle_decide(&pair, FMB_WANT_BOX, &truth);
    assert_int_equal(truth.verdict, FMB_OVERLAPPING);
    assert_equal("first", truth.contact[0], 0.5);
    assert_equal("last", truth.contact[1], 2.5);
    oracle_clear(&truth);
}

enum { STRIDE = 8 };

/* Makes the frame the hull of its vertices. */
static void by_its_vertices(const struct solid *solid, double memory[FMB_DIM_MAX * STRIDE],
                            struct fmb_frame *out)
{
    double vertex[VERTICES_MAX][FMB_DIM_MAX] = {{0}};
    const int count = solid_vertices(solid, vertex);
    for (int v = 0; v < count; v++)
        for (int axis = 0; axis < solid->dim; axis++)
            memory[axis * STRIDE + v] = vertex[v][axis];
    *out = (struct fmb_frame){.dim = solid->dim,
                              .shape = FMB_HULL,
                              .vertex_count = (unsigned) count,
                              .vertex_stride = STRIDE,
                              .vertices = memory};
}

/* hulls: a sum of 1, A is given by its vertices, and 2, B is. */
static void assert_known(const struct known *known, const struct question *question, int hulls)
{
    double memory[2][FMB_DIM_MAX * STRIDE];
    struct fmb_body body[2];
    struct pair pair;
    struct oracle_answer truth;
    question_pair(question, body, &pair);
    if (hulls & 1)
        by_its_vertices(&question->a, memory[0], &body[0].one);
    if (hulls & 2)
        by_its_vertices(&question->b, memory[1], &body[1].one);
    oracle_init(&truth);
    oracle_decide(&pair, FMB_WANT_BOX, &truth);

    const bool moving = question->a.moving || question->b.moving;
    const bool in_contact = known->verdict != FMB_SEPARATED;
    const double always[2] = {0, question->duration};
    const double *contact = moving ? known->contact : always;
    if (truth.verdict != known->verdict)
        fail_msg("%s: verdict %d, expected %d", known->what, truth.verdict, known->verdict);
    assert_int_equal(truth.has_box, in_contact);
    assert_int_equal(truth.has_contact, in_contact);
    for (int end = 0; in_contact && end < 2; end++) {
        assert_equal(known->what, truth.contact[end], contact[end]);
        for (int axis = 0; axis < question->a.dim; axis++)
            assert_equal(known->what, truth.box[end][axis], known->box[end][axis]);
    }
    oracle_clear(&truth);
}

static void assert_all_known(const struct known *known, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const struct question swapped = question_swapped(&known[i].question);
        for (int hulls = 0; hulls < 4; hulls++) {
            assert_known(&known[i], &known[i].question, hulls);
            assert_known(&known[i], &swapped, hulls);
        }
    }
}

static void plane_by_hand(void **state)
{
    assert_all_known(plane, COUNT(plane));
}

static void flat_plane_by_hand(void **state)
{
    assert_all_known(flat_plane, COUNT(flat_plane));
}

static void space_by_hand(void **state)
{
    assert_all_known(space, COUNT(space));
}

static void flat_space_by_hand(void **state)
{
    assert_all_known(flat_space, COUNT(flat_space));
}

/* Square [0,1]^2; a point starts at (0, 2) and moves by (1, -3) a second. It is at height 1 at
 * t = 1/3, at height 0 at t = 2/3, between x = 1/3 and x = 2/3. */
static const struct question thirds = {
    {2, FMB_CUBOID, UNIT2, {0}, {0}, false}, {2, FMB_CUBOID, {{0}}, {0, 2}, {1, -3}, true}, 4};

static void decide(const struct question *question, struct fmb_body body[2], struct pair *pair,
                   struct oracle_answer *truth)
{
    question_pair(question, body, pair);
    oracle_init(truth);
    oracle_decide(pair, FMB_WANT_BOX, truth);
}

static void placed_by_hand(void **state)
{
    assert_all_known(placed, COUNT(placed));
}

static void numbers_that_are_no_doubles(void **state)
{
    struct fmb_body body[2];
    struct pair pair;
    struct oracle_answer truth;
    decide(&thirds, body, &pair, &truth);
    assert_int_equal(truth.verdict, FMB_OVERLAPPING);
    assert_int_equal(mpq_cmp_ui(truth.contact[0], 1, 3), 0);
    assert_int_equal(mpq_cmp_ui(truth.contact[1], 2, 3), 0);
    assert_int_equal(mpq_cmp_ui(truth.box[0][0], 1, 3), 0);
    assert_int_equal(mpq_cmp_ui(truth.box[1][0], 2, 3), 0);
    assert_int_equal(mpq_cmp_ui(truth.box[0][1], 0, 1), 0);
    assert_int_equal(mpq_cmp_ui(truth.box[1][1], 1, 1), 0);
    oracle_clear(&truth);
}

/* ---- The checks see what is wrong ---- */

/* The tightest answer to thirds. The double 1./3 is below 1/3, and so is 2./3 below 2/3. */
static struct fmb_answer tight_thirds(void)
{
    const double third = 1. / 3, two_thirds = nextafter(2. / 3, 1);
    return (struct fmb_answer){.verdict = FMB_OVERLAPPING,
                               .has_contact = true,
                               .has_box = true,
                               .contact = {third, two_thirds},
                               .box = {{third, 0, 0}, {two_thirds, 1, 0}}};
}

static bool design(const struct fmb_answer *answer)
{
    char why[200];
    struct fmb_body body[2];
    struct pair pair;
    question_pair(&thirds, body, &pair);
    return oracle_check(&pair, FMB_WANT_BOX, answer, why, sizeof why);
}

static bool tightest(const struct fmb_answer *answer)
{
    char why[200];
    struct fmb_body body[2];
    struct pair pair;
    question_pair(&thirds, body, &pair);
    return oracle_check_tightest(&pair, FMB_WANT_BOX, answer, why, sizeof why);
}

static void checks_accept_what_is_right(void **state)
{
    struct fmb_answer answer = tight_thirds();
    assert_true(design(&answer));
    assert_true(tightest(&answer));

    answer.contact[0] = nextafter(answer.contact[0], 0); /* loose, but within the limits */
    assert_true(design(&answer));
    assert_false(tightest(&answer));

    answer = tight_thirds();
    answer.box[1][1] = nextafter(1, 2);
    assert_true(design(&answer));
    assert_false(tightest(&answer));
}

#define ASSERT_REFUSED(change)                     \
    do {                                           \
        struct fmb_answer answer = tight_thirds(); \
        change;                                    \
        assert_false(design(&answer));             \
        assert_false(tightest(&answer));           \
    } while (0)

static void checks_refuse_what_is_wrong(void **state)
{
    ASSERT_REFUSED(answer.verdict = FMB_TOUCHING);
    ASSERT_REFUSED(answer.has_contact = false);
    ASSERT_REFUSED(answer.has_box = false);
    ASSERT_REFUSED(answer.contact[0] = nextafter(1. / 3, 1));
    ASSERT_REFUSED(answer.contact[1] = 2. / 3);
    ASSERT_REFUSED(answer.contact[0] = 1. / 3 - 4.1e-12);
    ASSERT_REFUSED(answer.contact[1] = nextafter(4, 5));
    ASSERT_REFUSED(answer.contact[0] = NAN);
    ASSERT_REFUSED(answer.box[0][0] = nextafter(1. / 3, 1));
    ASSERT_REFUSED(answer.box[1][0] = 2. / 3);
    /* The farthest vertex is the point at the end: (0, 2) + 4 (1, -3) = (4, -10). */
    ASSERT_REFUSED(answer.box[1][1] = 1 + 1.01e-11);
    ASSERT_REFUSED(answer.box[0][1] = -0.0);
    ASSERT_REFUSED(answer.box[0][1] = NAN);
    ASSERT_REFUSED(answer.box[1][1] = HUGE_VAL);
    ASSERT_REFUSED(answer.box[0][2] = -0.0);
    ASSERT_REFUSED(answer.box[1][2] = 1);
}

/* Two equal squares with corners at DBL_MAX and 2 DBL_MAX: the box ends beyond the doubles. */
static void an_end_beyond_the_doubles_is_infinite(void **state)
{
    char why[200];
    const struct solid solid = {2, FMB_CUBOID, {{DBL_MAX, 0}, {0, 1}}, {DBL_MAX, 0}, {0}, false};
    const struct question question = {solid, solid, 1};
    struct fmb_body body[2];
    struct pair pair;
    question_pair(&question, body, &pair);
    struct fmb_answer answer = {.verdict = FMB_OVERLAPPING,
                                .has_contact = true,
                                .has_box = true,
                                .contact = {0, 1},
                                .box = {{DBL_MAX, 0, 0}, {HUGE_VAL, 1, 0}}};
    assert_true(oracle_check_tightest(&pair, FMB_WANT_BOX, &answer, why, sizeof why));
    answer.box[1][0] = DBL_MAX;
    assert_false(oracle_check(&pair, FMB_WANT_BOX, &answer, why, sizeof why));
    answer.box[1][0] = -HUGE_VAL;
    assert_false(oracle_check(&pair, FMB_WANT_BOX, &answer, why, sizeof why));
    answer.box[1][0] = HUGE_VAL;
    answer.box[0][0] = -HUGE_VAL;
    assert_false(oracle_check(&pair, FMB_WANT_BOX, &answer, why, sizeof why));
}

/* ---- Distance and depth ---- */

/* The deepest pair is the vertex (1, 1) of the first body, and a point of an edge of the other. */
static bool depth_is(const struct pair *pair, double lower, double upper, double x, double y)
{
    char why[200];
    const struct fmb_gap gap = {.bounds = {lower, upper},
                                .direction = {x, y},
                                .has_witness = true,
                                .witness = {{1, 1}, {0.2, 0.6}}};
    return gap_check(pair, FMB_OVERLAPPING, &gap, why, sizeof why);
}

/* The square of corners +-1, with the origin as one more vertex, and the rhombus of corners
 * (+-1, 0), (0, +-2) at (c, c): along (2, 1) their gap is (3 c - 5) / sqrt(5). */
static void gaps_of_hulls_by_hand(void **state)
{
    static const double square[2 * STRIDE] = {1, -1, 0, 1, -1, 0, 0, 0, 1, 1, 0, -1, -1};
    static const double rhombus[2 * STRIDE] = {1, -1, 0, 0, 0, 0, 0, 0, 0, 0, 2, -2};
    const struct fmb_frame frames[2] = {{.dim = 2,
                                         .shape = FMB_HULL,
                                         .vertex_count = 5,
                                         .vertex_stride = STRIDE,
                                         .vertices = square},
                                        {.dim = 2,
                                         .shape = FMB_HULL,
                                         .vertex_count = 4,
                                         .vertex_stride = STRIDE,
                                         .vertices = rhombus}};
    const struct fmb_body body[2] = {{.dim = 2, .frame_count = 1, .frames = &frames[0]},
                                     {.dim = 2, .frame_count = 1, .frames = &frames[1]}};
    struct pair pair = {{.body = &body[0]}, {.body = &body[1], .position = {3, 3}}, 0};
    mpq_t square_of_distance;
    mpq_init(square_of_distance);
    gap_check_distance(&pair, square_of_distance);
    assert_int_equal(mpq_cmp_ui(square_of_distance, 16, 5), 0);
    mpq_clear(square_of_distance);

    /* At c = 1 the depth along (2, 1) is 2 / sqrt(5), along the axes it is 1 and more. */
    const double norm = sqrt(5), depth = 2 / norm;
    pair.b.position[0] = pair.b.position[1] = 1;
    const double lower = nextafter(-depth, -1), upper = nextafter(-depth, 0);
    assert_true(depth_is(&pair, lower, upper, 2 / norm, 1 / norm));
    assert_false(depth_is(&pair, lower, upper, 1, 0));
    assert_false(depth_is(&pair, lower + 1e-13, upper + 1e-13, 2 / norm, 1 / norm));
    assert_false(depth_is(&pair, lower - 1e-13, upper - 1e-13, 2 / norm, 1 / norm));
}

/* A window so short that a step of doubles is more than 1e-12 of it: the next double will do. */
static void doubles_too_coarse_for_the_limit(void **state)
{
    char why[200];
    struct question question = thirds;
    question.duration = 0x1p-1072; /* four steps of 2^-1074; x = 0 at 4/3, x = 2 steps at 4 */
    question.b = (struct solid){2, FMB_CUBOID, {{0}}, {-0x1p-1074, 0.5}, {0.75, 0}, true};
    struct fmb_body body[2];
    struct pair pair;
    question_pair(&question, body, &pair);
    struct fmb_answer answer = {.verdict = FMB_OVERLAPPING,
                                .has_contact = true,
                                .has_box = true,
                                .contact = {0x1p-1074, 0x1p-1072},
                                .box = {{0, 0.5, 0}, {0x1p-1073, 0.5, 0}}};
    assert_true(oracle_check_tightest(&pair, FMB_WANT_BOX, &answer, why, sizeof why));
    answer.contact[0] = 0;
    assert_false(oracle_check(&pair, FMB_WANT_BOX, &answer, why, sizeof why));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plane_by_hand),
        cmocka_unit_test(flat_plane_by_hand),
        cmocka_unit_test(space_by_hand),
        cmocka_unit_test(flat_space_by_hand),
        cmocka_unit_test(placed_by_hand),
        cmocka_unit_test(an_orientation_has_no_length),
        cmocka_unit_test(bodies_of_frames),
        cmocka_unit_test(numbers_that_are_no_doubles),
        cmocka_unit_test(checks_accept_what_is_right),
        cmocka_unit_test(checks_refuse_what_is_wrong),
        cmocka_unit_test(an_end_beyond_the_doubles_is_infinite),
        cmocka_unit_test(gaps_of_hulls_by_hand),
        cmocka_unit_test(doubles_too_coarse_for_the_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
