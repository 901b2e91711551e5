/* Faces by their vertices, exactly: pairs whose edges no double holds, against an oracle that reads
 * nothing but the vertices; many at once; their boxes, and trees of these. */

#include "unit.h"

#include <float.h>
#include <gmp.h>
#include <limits.h>
#include <math.h>

#include "allocate.h"
#include "batch.h"
#include "draw.h"
#include "fmb.h"
#include "placed_pair.h"
#include "triangles.h"

/* ---- Points ---- */

/* A kind of numbers that coordinates are made of. */
typedef double numbers(struct draw *draw);

static double whole(struct draw *draw)
{
    return draw_int(draw, 0, 3);
}

static double tenth(struct draw *draw)
{
    return draw_int(draw, -12, 12) * 0.1;
}

static double tenth_of_thousands(struct draw *draw)
{
    return draw_int(draw, -12, 12) * 0.1 * 1000 + draw_int(draw, -3, 3) * 0.1;
}

/* What is subtracted from it loses its last bits, or all of them. */
static double of_two_sizes(struct draw *draw)
{
    static const int exponent[] = {0, 0, 0, 20, 40, 52, 53, 54, 60, -20, -53, -60};
    return ldexp(draw_int(draw, -3, 3), exponent[draw_int(draw, 0, (int) COUNT(exponent) - 1)]);
}

/* Each with a last place of its own, on both sides of 0. */
static double full_mantissa(struct draw *draw)
{
    return draw_log(draw, -4, 0);
}

/* A grid with holes of an ulp. */
static double near_whole(struct draw *draw)
{
    const double x = draw_int(draw, -2, 2);
    switch (draw_int(draw, 0, 5)) {
    case 0: return nextafter(x, HUGE_VAL);
    case 1: return nextafter(x, -HUGE_VAL);
    case 2: return x + 0x1p-52;
    default: return x;
    }
}

/* From one far out, near ones that differ by an ulp seem to be the same. */
static double hidden(struct draw *draw)
{
    static const double some[] = {
        0x1p54, 0, 1, 0.5, 0.1, 0x1.999999999999bp-4, 0x1.9999999999999p-4};
    return some[draw_int(draw, 0, (int) COUNT(some) - 1)];
}

static double sparse(struct draw *draw)
{
    return draw_int(draw, 0, 3) ? draw_int(draw, -1, 1) : full_mantissa(draw);
}

static double of_every_size(struct draw *draw)
{
    return draw_int(draw, 0, 2) ? draw_log(draw, -200, 200) : draw_int(draw, -1, 1);
}

static numbers *const all_numbers[] = {whole,        tenth,         tenth_of_thousands,
                                       of_two_sizes, full_mantissa, near_whole,
                                       sparse,       of_every_size, hidden};

enum { POOL = 10 };

typedef double point[3];

/* What is not drawn is made of what was: on a line or a face of earlier points, as near as rounding
 * lets it, or an ulp beside one. So drawn triangles share vertices and edges, lie in one plane or
 * nearly, and meet within edges and faces. */
static void derive_point(struct draw *draw, point *pool, int count, double out[3])
{
    const double *p = pool[draw_int(draw, 0, count - 1)], *q = pool[draw_int(draw, 0, count - 1)];
    const double *r = pool[draw_int(draw, 0, count - 1)];
    const int kind = draw_int(draw, 0, 7);
    const double s = draw_int(draw, -2, 6) * 0.25, t = draw_int(draw, 0, 4) * 0.25;
    for (int axis = 0; axis < 3; axis++)
        switch (kind) {
        case 0: out[axis] = p[axis] * 0.5 + q[axis] * 0.5; break;
        case 1: out[axis] = p[axis] + s * (q[axis] - p[axis]); break;
        case 2: out[axis] = p[axis] + t * (q[axis] - p[axis]) + s * (r[axis] - p[axis]); break;
        case 3: out[axis] = p[axis] + q[axis] - r[axis]; break;
        case 4: out[axis] = axis == 2 ? q[axis] : p[axis]; break;
        default: out[axis] = p[axis]; break;
        }
    if (kind == 7 || draw_int(draw, 0, 3) == 0) {
        double *x = &out[draw_int(draw, 0, 2)];
        *x = nextafter(*x, draw_coin(draw) ? HUGE_VAL : -HUGE_VAL);
    }
}

static void draw_pool(struct draw *draw, point *pool)
{
    numbers *const number = all_numbers[draw_int(draw, 0, (int) COUNT(all_numbers) - 1)];
    const int drawn = draw_int(draw, 4, 7);
    const double flat = number(draw);
    const bool in_plane = draw_int(draw, 0, 4) == 0;
    for (int i = 0; i < POOL; i++) {
        if (i >= drawn) {
            derive_point(draw, pool, i, pool[i]);
            continue;
        }
        for (int axis = 0; axis < 3; axis++)
            pool[i][axis] = number(draw);
        if (in_plane)
            pool[i][2] = flat;
    }
}

/* In no special position, so that doubles mostly decide; edges round. */
static void draw_loose_pool(struct draw *draw, point *pool)
{
    for (int i = 0; i < POOL; i++)
        for (int axis = 0; axis < 3; axis++)
            pool[i][axis] = full_mantissa(draw);
}

/* To any size: exactly, or, where it comes out below the normal numbers, into their grid. */
static void scale_pool(struct draw *draw, point *pool)
{
    static const int some[] = {0,    0,   0,    0,   100,  -100,  199,
                               -199, 300, -300, 498, -498, -1020, -1070};
    const int exponent = some[draw_int(draw, 0, (int) COUNT(some) - 1)];
    for (int i = 0; i < POOL; i++)
        for (int axis = 0; axis < 3; axis++)
            pool[i][axis] = ldexp(pool[i][axis], exponent);
}

static void draw_triangle(struct draw *draw, point *pool, struct triangle *out)
{
    memset(out, 0, sizeof *out);
    for (int corner = 0; corner < 3; corner++)
        memcpy(out->vertex[corner], pool[draw_int(draw, 0, POOL - 1)], sizeof out->vertex[corner]);
}

static enum fmb_status make_face(const double vertex[3][3], struct fmb_body *out)
{
    return fmb_body_make_vertices(3, FMB_FACE, vertex[0], 9, out);
}

/* A way from one point of the pool to another in the window, so that what moves often passes
 * through vertices. */
static void draw_motion(struct draw *draw, point *pool, struct triangle *out)
{
    const double *p = pool[draw_int(draw, 0, POOL - 1)], *q = pool[draw_int(draw, 0, POOL - 1)];
    out->moving = true;
    for (int axis = 0; axis < 3; axis++)
        out->velocity[axis] = q[axis] - p[axis];
}

struct drawn {
    struct triangle triangle[2];
    double duration;
};

static void draw_pair(struct draw *draw, bool moving, struct drawn *out)
{
    point pool[POOL];
    if (draw_int(draw, 0, 7))
        draw_pool(draw, pool);
    else
        draw_loose_pool(draw, pool);
    scale_pool(draw, pool);
    for (int f = 0; f < 2; f++)
        draw_triangle(draw, pool, &out->triangle[f]);
    out->duration = 1;
    if (!moving)
        return;
    const int who = draw_int(draw, 1, 3);
    for (int f = 0; f < 2; f++)
        if (who & (1 << f))
            draw_motion(draw, pool, &out->triangle[f]);
    if (draw_int(draw, 0, 3) == 0)
        out->duration = draw_int(draw, 0, 4) * 0.3;
}

/* ---- The engine ---- */

struct arranged {
    struct fmb_body body[2];
    struct pair pair;
};

static void set_frame(const struct triangle *triangle, int first, struct fmb_body *body,
                      struct fmb_placement *out)
{
    double vertex[3][3];
    for (int corner = 0; corner < 3; corner++)
        memcpy(vertex[corner], triangle->vertex[(corner + first) % 3], sizeof vertex[corner]);
    assert_int_equal(make_face((const double(*)[3]) vertex, body), FMB_OK);
    *out = (struct fmb_placement){.body = body};
    if (triangle->moving)
        memcpy(out->velocity, triangle->velocity, sizeof out->velocity);
}

/* turn: which vertex is the first of each, and which triangle is (from 9 on) the second. */
enum { TURNS = 18 };

static void set_arranged(const struct drawn *drawn, int turn, struct arranged *out)
{
    const int swapped = turn / 9;
    set_frame(&drawn->triangle[swapped], turn % 3, &out->body[0], &out->pair.a);
    set_frame(&drawn->triangle[!swapped], turn / 3 % 3, &out->body[1], &out->pair.b);
    out->pair.duration = drawn->duration;
}

static void print_drawn(const struct drawn *drawn)
{
    printf("# struct drawn drawn = {{");
    for (int f = 0; f < 2; f++) {
        const struct triangle *t = &drawn->triangle[f];
        printf("{{");
        for (int corner = 0; corner < 3; corner++)
            printf("{%a, %a, %a},", t->vertex[corner][0], t->vertex[corner][1],
                   t->vertex[corner][2]);
        printf("}, {%a, %a, %a}, %d},", t->velocity[0], t->velocity[1], t->velocity[2], t->moving);
    }
    printf("}, %a};\n", drawn->duration);
}

static void fail_of(const struct drawn *drawn, int turn, const char *what, int found, int expected)
{
    print_drawn(drawn);
    fail_msg("%s, turn %d: found %d, expected %d", what, turn, found, expected);
}

/* Whether sign * (end - exact) >= 0. */
static bool is_beyond(double end, int sign, const mpq_t exact)
{
    if (isinf(end))
        return (end > 0) == (sign > 0);
    mpq_t number;
    mpq_init(number);
    mpq_set_d(number, end);
    const int order = mpq_cmp(number, exact);
    mpq_clear(number);
    return sign * order >= 0;
}

/* The end contains the exact one; and, of the tightest, the next double does not. */
static bool is_end(double end, int which, bool tightest, const mpq_t exact)
{
    const int sign = which ? 1 : -1;
    return is_beyond(end, sign, exact) &&
           (!tightest || !is_beyond(nextafter(end, -sign * HUGE_VAL), sign, exact));
}

/* At most 1e-12 of the window out, or the next double. */
static bool is_near(double end, int which, double duration, const mpq_t exact)
{
    const double inner = nextafter(end, which ? -HUGE_VAL : HUGE_VAL);
    const double in = which ? end - 0.99e-12 * duration : end + 0.99e-12 * duration;
    return !is_beyond(inner, which ? 1 : -1, exact) || !is_beyond(in, which ? 1 : -1, exact);
}

static void assert_answer(const struct drawn *drawn, int turn, const char *method,
                          const struct triangles_answer *truth)
{
    struct arranged arranged;
    struct fmb_answer answer;
    const bool exact = strcmp(method, "exact") == 0;
    const bool moving = drawn->triangle[0].moving || drawn->triangle[1].moving;
    set_arranged(drawn, turn, &arranged);
    memset(&answer, 0xa5, sizeof answer);
    assert_int_equal(pair_decide(fmb_method_by_name(method), &arranged.pair, FMB_WANT_BOX, &answer),
                     FMB_OK);
    if (answer.verdict != truth->verdict)
        fail_of(drawn, turn, method, (int) answer.verdict, (int) truth->verdict);
    const bool meet = truth->verdict != FMB_SEPARATED;
    assert_int_equal(answer.has_contact, meet);
    assert_int_equal(answer.has_box, meet);
    if (meet && !moving)
        assert_true(answer.contact[0] == 0 && answer.contact[1] == drawn->duration);
    for (int end = 0; end < 2 && meet; end++) {
        if (moving && !(is_end(answer.contact[end], end, exact, truth->contact[end]) &&
                        is_near(answer.contact[end], end, drawn->duration, truth->contact[end])))
            fail_of(drawn, turn, exact ? "exact contact" : "certified contact", end, 0);
        for (int axis = 0; axis < 3; axis++)
            if (!is_end(answer.box[end][axis], end, exact, truth->box[end][axis]))
                fail_of(drawn, turn, exact ? "exact box" : "certified box", end, axis);
    }
}

static void assert_certificate(const struct drawn *drawn, int turn, enum fmb_verdict verdict)
{
    char text[FMB_CERTIFICATE_MAX], why[200] = "";
    size_t length;
    struct arranged arranged;
    set_arranged(drawn, turn, &arranged);
    assert_int_equal(pair_certificate(&arranged.pair, text, sizeof text, &length), FMB_OK);
    for (int other = FMB_SEPARATED; other <= FMB_OVERLAPPING && length > 0; other++) {
        const bool holds =
            pair_certificate_holds(&arranged.pair, (enum fmb_verdict) other, text, why, sizeof why);
        if (holds != (other == (int) verdict)) {
            printf("# %s: %s\n", text, why);
            fail_of(drawn, turn, "certificate", holds, other);
        }
    }
}

/* ---- Pairs, one by one ---- */

struct tally {
    long rounded, of_verdict[FMB_OVERLAPPING + 1];
};

static void count_drawn(const struct drawn *drawn, enum fmb_verdict verdict, struct tally *tally)
{
    struct arranged arranged;
    set_arranged(drawn, 0, &arranged);
    tally->rounded += arranged.body[0].one.rounded || arranged.body[1].one.rounded;
    tally->of_verdict[verdict]++;
}

static void assert_tally(const struct tally *tally, long count)
{
    printf("# %ld rounded, %ld separated, %ld touching, %ld overlapping\n", tally->rounded,
           tally->of_verdict[1], tally->of_verdict[2], tally->of_verdict[3]);
    if (count < 200)
        return;
    assert_true(tally->rounded > count / 4);
    for (int v = FMB_SEPARATED; v <= FMB_OVERLAPPING; v++)
        assert_true(tally->of_verdict[v] > count / 20);
}

static void assert_pairs(const char *what, bool moving, long usual)
{
    struct draw draw;
    struct drawn drawn;
    struct triangles_answer truth;
    struct tally tally = {0};
    const long count = draw_sample(usual);
    draw_begin(&draw, what);
    triangles_init(&truth);
    for (long i = 0; i < count; i++) {
        draw_pair(&draw, moving, &drawn);
        triangles_decide(drawn.triangle, drawn.duration, true, &truth);
        count_drawn(&drawn, truth.verdict, &tally);
        for (int turn = 0; turn < TURNS; turn++)
            assert_answer(&drawn, turn, "certified", &truth);
        assert_answer(&drawn, draw_int(&draw, 0, TURNS / 2 - 1), "exact", &truth);
        assert_answer(&drawn, draw_int(&draw, TURNS / 2, TURNS - 1), "exact", &truth);
        assert_certificate(&drawn, draw_int(&draw, 0, TURNS - 1), truth.verdict);
    }
    triangles_clear(&truth);
    assert_tally(&tally, count);
}

static void pairs_at_rest_are_what_their_vertices_say(void **state)
{
    assert_pairs("pairs_at_rest_are_what_their_vertices_say", false, 8000);
}

static void moving_pairs_are_what_their_vertices_say(void **state)
{
    assert_pairs("moving_pairs_are_what_their_vertices_say", true, 4000);
}

/* ---- Many pairs ---- */

enum { CROWD = 24, CROWD_PAIRS = CROWD * CROWD };

/* Frames of one pool: triangles, and some solids among them. */
struct crowd {
    double duration;
    struct triangle triangle[CROWD]; /* of those that are */
    bool is_triangle[CROWD];
    struct fmb_body body[CROWD];
    struct fmb_placement frame[CROWD];
    struct fmb_prepared prepared[CROWD];
};

/* From one vertex of the pool to others, as near as doubles have it. */
static void set_solid(struct draw *draw, point *pool, bool moving, struct fmb_body *body,
                      struct fmb_placement *out)
{
    struct triangle motion;
    double component[3][3];
    const double *origin = pool[draw_int(draw, 0, POOL - 1)];
    for (int i = 0; i < 3; i++) {
        const double *corner = pool[draw_int(draw, 0, POOL - 1)];
        for (int axis = 0; axis < 3; axis++)
            component[i][axis] = corner[axis] - origin[axis];
    }
    const enum fmb_shape shape = draw_coin(draw) ? FMB_CUBOID : FMB_TETRAHEDRON;
    assert_int_equal(fmb_body_make(3, shape, component[0], 9, body), FMB_OK);
    draw_motion(draw, pool, &motion);
    *out = (struct fmb_placement){.body = body};
    memcpy(out->position, origin, sizeof out->position);
    if (moving)
        memcpy(out->velocity, motion.velocity, sizeof out->velocity);
}

static void draw_crowd(struct draw *draw, struct crowd *out)
{
    point pool[POOL];
    const bool loose = draw_coin(draw), moving = draw_coin(draw);
    draw_pool(draw, pool);
    scale_pool(draw, pool);
    out->duration = draw_coin(draw) ? 1 : draw_int(draw, 0, 4) * 0.3;
    for (int i = 0; i < CROWD; i++) {
        const bool moves = moving && draw_coin(draw);
        if (loose && draw_coin(draw)) /* not of the vertices of others */
            draw_loose_pool(draw, pool);
        out->is_triangle[i] = draw_int(draw, 0, 3) > 0;
        if (out->is_triangle[i]) {
            draw_triangle(draw, pool, &out->triangle[i]);
            if (moves)
                draw_motion(draw, pool, &out->triangle[i]);
            set_frame(&out->triangle[i], 0, &out->body[i], &out->frame[i]);
        } else {
            set_solid(draw, pool, moves, &out->body[i], &out->frame[i]);
        }
        assert_int_equal(fmb_prepare(&out->frame[i], 0, 1, &out->prepared[i]), FMB_OK);
    }
}

/* The answer of every pair: of triangles the verdict is the oracle's, and the rest, as that of
 * others, of the exact method, which certifies what is not here. */
static void set_truth(const struct crowd *crowd, struct fmb_answer truth[CROWD_PAIRS])
{
    struct triangles_answer oracle;
    triangles_init(&oracle);
    for (int k = 0; k < CROWD_PAIRS; k++) {
        const int i = k / CROWD, j = k % CROWD;
        const struct pair pair = {crowd->frame[i], crowd->frame[j], crowd->duration};
        struct fmb_answer certified;
        assert_int_equal(pair_decide(fmb_method_by_name("exact"), &pair, FMB_WANT_BOX, &truth[k]),
                         FMB_OK);
        assert_int_equal(pair_decide(fmb_method_default(), &pair, 0, &certified), FMB_OK);
        assert_int_equal(certified.verdict, truth[k].verdict);
        if (!crowd->is_triangle[i] || !crowd->is_triangle[j] || i > j)
            continue;
        const struct triangle two[2] = {crowd->triangle[i], crowd->triangle[j]};
        triangles_decide(two, crowd->duration, false, &oracle);
        assert_int_equal(oracle.verdict, truth[k].verdict);
    }
    triangles_clear(&oracle);
}

struct answers {
    unsigned char verdict[CROWD_PAIRS];
    double contact[CROWD_PAIRS][2], box[CROWD_PAIRS][2][FMB_DIM_MAX];
};

static void assert_crowd_answers(const struct fmb_answer *truth, const struct answers *answers,
                                 bool contacts, bool boxes)
{
    for (int k = 0; k < CROWD_PAIRS; k++) {
        assert_int_equal(answers->verdict[k], truth[k].verdict);
        for (int end = 0; end < 2; end++) {
            const int sign = end ? 1 : -1;
            const double *box = answers->box[k][end], *true_box = truth[k].box[end];
            if (contacts && !truth[k].has_contact)
                assert_true(isnan(answers->contact[k][end]));
            else if (contacts)
                assert_true(sign * answers->contact[k][end] >= sign * truth[k].contact[end]);
            for (int axis = 0; axis < 3 && boxes; axis++)
                assert_true(truth[k].has_box ? sign * box[axis] >= sign * true_box[axis]
                                             : isnan(box[axis]));
        }
    }
}

static void decide_crowd(const struct crowd *crowd, const unsigned (*pairs)[2],
                         enum instructions instructions, int wanted, struct answers *out)
{
    const struct fmb_batch batch = {.frames = crowd->prepared,
                                    .frame_count = CROWD,
                                    .pairs = pairs,
                                    .pair_count = CROWD_PAIRS,
                                    .duration = crowd->duration,
                                    .verdicts = out->verdict,
                                    .contacts = wanted & 1 ? out->contact : NULL,
                                    .boxes = wanted & 2 ? out->box : NULL};
    memset(out, 0, sizeof *out);
    memset(out->verdict, 0xa5, sizeof out->verdict);
    assert_int_equal(batch_decide(&batch, instructions, INFINITY), FMB_OK);
}

/* Whatever the instructions, the same bits. Returns the number of pairs with a face that is
 * rounded.
 */
static long assert_crowd(const struct crowd *crowd)
{
    static struct fmb_answer truth[CROWD_PAIRS];
    static struct answers answers, other;
    long rounded = 0;
    unsigned pairs[CROWD_PAIRS][2];
    for (unsigned k = 0; k < CROWD_PAIRS; k++) {
        pairs[k][0] = k / CROWD;
        pairs[k][1] = k % CROWD;
    }
    set_truth(crowd, truth);
    for (int wanted = 0; wanted < 4; wanted++) {
        decide_crowd(crowd, (const unsigned(*)[2]) pairs, INSTRUCTIONS_PLAIN, wanted, &answers);
        assert_crowd_answers(truth, &answers, wanted & 1, wanted & 2);
        for (int set = INSTRUCTIONS_BEST; set <= INSTRUCTIONS_AVX512; set++) {
            if (!instructions_supported(set))
                continue;
            decide_crowd(crowd, (const unsigned(*)[2]) pairs, (enum instructions) set, wanted,
                         &other);
            assert_memory_equal(answers.verdict, other.verdict, sizeof answers.verdict);
            if (wanted) /* NAN is of the same bits too, since it is not computed */
                assert_memory_equal(&answers, &other, sizeof answers);
        }
        if (wanted)
            continue;
        for (int k = 0; k < CROWD_PAIRS; k++) {
            enum fmb_verdict single;
            assert_int_equal(
                fmb_decide_prepared(&crowd->prepared[k / CROWD], &crowd->prepared[k % CROWD],
                                    crowd->duration, &single),
                FMB_OK);
            assert_int_equal(single, answers.verdict[k]);
            rounded += crowd->body[k / CROWD].one.rounded || crowd->body[k % CROWD].one.rounded;
        }
    }
    return rounded;
}

static void batches_decide_rounded_faces(void **state)
{
    static struct crowd crowd;
    struct draw draw;
    long rounded = 0;
    draw_begin(&draw, "batches_decide_rounded_faces");
    for (long n = draw_sample(40); n > 0; n--) {
        draw_crowd(&draw, &crowd);
        rounded += assert_crowd(&crowd);
    }
    printf("# %ld pairs with a rounded face\n", rounded);
    assert_true(rounded > 0);
}

/* ---- Boxes ---- */

/* No larger than the rounding of its numbers makes it: with u = 2^-52 of the largest coordinate, an
 * edge is off by at most u on each axis, the frame by 3 u, and two sums step down by 2 u each. */
static void a_box_is_tight(void **state)
{
    struct draw draw;
    draw_begin(&draw, "a_box_is_tight");
    for (long n = draw_sample(20000); n > 0; n--) {
        struct drawn drawn;
        struct arranged arranged;
        struct fmb_prepared prepared;
        double box[2][FMB_DIM_MAX];
        draw_pair(&draw, false, &drawn);
        set_arranged(&drawn, 0, &arranged);
        assert_int_equal(fmb_prepare(&arranged.pair.a, 0, 1, &prepared), FMB_OK);
        fmb_box_of(&prepared, 1, box);
        const double *v0 = drawn.triangle[0].vertex[0];
        double size = 0;
        for (int k = 0; k < 9; k++)
            size = fmax(size, fabs(v0[k]));
        for (int axis = 0; axis < 3; axis++) {
            const double(*v)[3] = (const double(*)[3]) drawn.triangle[0].vertex;
            const double least = fmin(v[0][axis], fmin(v[1][axis], v[2][axis]));
            const double most = fmax(v[0][axis], fmax(v[1][axis], v[2][axis]));
            const double slack = arranged.body[0].one.rounded ? 8 * 0x1p-52 * size + 0x1p-1073 : 0;
            assert_true(box[0][axis] >= least - slack && box[1][axis] <= most + slack);
        }
    }
}

/* ---- Trees of boxes ---- */

/* Boxes that stand in an array, or are made of triangles. */
struct world {
    size_t count;
    double duration;
    bool moving;
    double velocity[3];
    double (*box)[2][FMB_DIM_MAX];
    struct triangle *triangle;
    struct fmb_body *body;
    struct fmb_placement *placement;
    struct fmb_prepared *prepared;
    struct fmb_tree boxes, frames;
    void *memory[2];
};

static void put_box(const void *context, unsigned index, double box[2][FMB_DIM_MAX])
{
    const struct world *world = context;
    assert_true(index < world->count);
    memcpy(box, world->box[index], sizeof world->box[index]);
}

static void put_box_of_frame(const void *context, unsigned index, double box[2][FMB_DIM_MAX])
{
    const struct world *world = context;
    fmb_box_of(&world->prepared[index], world->duration, box);
}

/* The triangles have one velocity, and so do their boxes. */
static void open_world(struct draw *draw, point *pool, size_t count, double duration,
                       struct world *out)
{
    struct triangle motion = {.moving = draw_coin(draw)};
    if (motion.moving)
        draw_motion(draw, pool, &motion);
    *out = (struct world){.count = count, .duration = duration, .moving = motion.moving};
    memcpy(out->velocity, motion.velocity, sizeof out->velocity);
    out->box = allocate(count, sizeof *out->box);
    out->triangle = allocate(count, sizeof *out->triangle);
    out->body = allocate(count, sizeof *out->body);
    out->placement = allocate(count, sizeof *out->placement);
    out->prepared = allocate(count, sizeof *out->prepared);
    for (size_t i = 0; i < count; i++) {
        struct triangle *triangle = &out->triangle[i];
        draw_triangle(draw, pool, triangle);
        triangle->moving = motion.moving;
        memcpy(triangle->velocity, motion.velocity, sizeof motion.velocity);
        set_frame(triangle, 0, &out->body[i], &out->placement[i]);
        assert_int_equal(fmb_prepare(&out->placement[i], 0, 1, &out->prepared[i]), FMB_OK);
        for (int axis = 0; axis < 3; axis++) {
            const double(*v)[3] = (const double(*)[3]) triangle->vertex;
            out->box[i][0][axis] = fmin(v[0][axis], fmin(v[1][axis], v[2][axis]));
            out->box[i][1][axis] = fmax(v[0][axis], fmax(v[1][axis], v[2][axis]));
        }
        if (draw_int(draw, 0, 30) == 0)
            out->box[i][0][draw_int(draw, 0, 2)] = -INFINITY;
        if (draw_int(draw, 0, 30) == 0)
            out->box[i][1][draw_int(draw, 0, 2)] = INFINITY;
    }
    const struct fmb_boxes boxes = {3, put_box, out, motion.moving ? out->velocity : NULL};
    for (int t = 0; t < 2; t++)
        out->memory[t] = allocate(1, fmb_tree_bytes(count));
    assert_int_equal(fmb_tree_build(&boxes, count, duration, out->memory[0], &out->boxes), FMB_OK);
    const struct fmb_boxes frames = {3, put_box_of_frame, out, NULL};
    assert_int_equal(fmb_tree_build(&frames, count, duration, out->memory[1], &out->frames),
                     FMB_OK);
}

static void close_world(struct world *world)
{
    free(world->box);
    free(world->triangle);
    free(world->body);
    free(world->placement);
    free(world->prepared);
    free(world->memory[0]);
    free(world->memory[1]);
}

/* The box over the window, at least: sum is rounded to one double that is beyond it or is next to
 * it. Returns 1 where what both trees may find is not decided by doubles. */
static void sweep(const struct world *world, size_t i, mpq_t out[2][3], bool endless[2][3])
{
    mpq_t way;
    mpq_init(way);
    for (int end = 0; end < 2; end++)
        for (int axis = 0; axis < 3; axis++) {
            const double x = world->box[i][end][axis], v = world->velocity[axis];
            endless[end][axis] = isinf(x);
            mpq_set_d(out[end][axis], isinf(x) ? 0 : x);
            if (!world->moving || (end ? v < 0 : v > 0))
                continue;
            mpq_set_d(way, v);
            mpq_t time;
            mpq_init(time);
            mpq_set_d(time, world->duration);
            mpq_mul(way, way, time);
            mpq_add(out[end][axis], out[end][axis], way);
            mpq_clear(time);
        }
    mpq_clear(way);
}

/* Whether the exact boxes meet. */
static bool boxes_meet(const struct world *a, size_t i, const struct world *b, size_t j)
{
    mpq_t box[2][2][3];
    bool endless[2][2][3], meet = true;
    for (int k = 0; k < 12; k++)
        mpq_init(box[k / 6][k / 3 % 2][k % 3]);
    sweep(a, i, box[0], endless[0]);
    sweep(b, j, box[1], endless[1]);
    for (int axis = 0; axis < 3; axis++)
        for (int f = 0; f < 2; f++)
            meet = meet && (endless[f][0][axis] || endless[!f][1][axis] ||
                            mpq_cmp(box[f][0][axis], box[!f][1][axis]) <= 0);
    for (int k = 0; k < 12; k++)
        mpq_clear(box[k / 6][k / 3 % 2][k % 3]);
    return meet;
}

/* How often each pair is reported. */
static void count_pairs(const struct fmb_tree *a, const struct fmb_tree *b, unsigned char *times)
{
    enum { CAPACITY = FMB_TREE_CAPACITY_MIN + 5 };
    unsigned pairs[CAPACITY][2];
    struct fmb_tree_cursor cursor = {0};
    for (size_t count = 1; count > 0;) {
        assert_int_equal(fmb_tree_pairs(a, b, &cursor, pairs, CAPACITY, &count), FMB_OK);
        for (size_t k = 0; k < count; k++)
            times[pairs[k][0] * b->frame_count + pairs[k][1]]++;
    }
}

/* Those whose exact boxes meet, each once; no others where the boxes stand still. */
static void assert_pairs_of(const struct world *a, const struct world *b)
{
    unsigned char *times = allocate(a->count * b->count, 1);
    count_pairs(&a->boxes, &b->boxes, times);
    for (size_t i = 0; i < a->count; i++)
        for (size_t j = 0; j < b->count; j++) {
            const int found = times[i * b->count + j];
            const bool meet = (a != b || i < j) && boxes_meet(a, i, b, j);
            assert_true(found == 1 || (found == 0 && !meet));
            assert_true(meet || found == 0 || ((a->moving || b->moving) && (a != b || i < j)));
        }
    free(times);
}

/* Trees of boxes and of frames, in any order: no two triangles that meet are lost. */
static void assert_none_lost(const struct world *a, const struct world *b)
{
    struct triangles_answer truth;
    triangles_init(&truth);
    for (int kinds = 0; kinds < 4; kinds++) {
        unsigned char *times = allocate(a->count * b->count, 1);
        count_pairs(kinds & 1 ? &a->frames : &a->boxes, kinds & 2 ? &b->frames : &b->boxes, times);
        for (size_t i = 0; i < a->count; i++)
            for (size_t j = 0; j < b->count; j++) {
                const struct triangle pair[2] = {a->triangle[i], b->triangle[j]};
                assert_true(times[i * b->count + j] <= 1);
                if (times[i * b->count + j])
                    continue;
                triangles_decide(pair, a->duration, false, &truth);
                assert_int_equal(truth.verdict, FMB_SEPARATED);
            }
        free(times);
    }
    triangles_clear(&truth);
}

static void trees_of_boxes_lose_nothing(void **state)
{
    struct draw draw;
    draw_begin(&draw, "trees_of_boxes_lose_nothing");
    for (long n = draw_sample(400); n > 0; n--) {
        point pool[POOL];
        struct world a, b;
        const double duration = draw_coin(&draw) ? 1 : draw_int(&draw, 0, 4) * 0.3;
        draw_pool(&draw, pool);
        scale_pool(&draw, pool);
        open_world(&draw, pool, (size_t) draw_int(&draw, 0, 40), duration, &a);
        open_world(&draw, pool, (size_t) draw_int(&draw, 0, 40), duration, &b);
        assert_pairs_of(&a, &b);
        assert_pairs_of(&a, &a);
        if (n % 4 == 0)
            assert_none_lost(&a, &b);
        close_world(&a);
        close_world(&b);
    }
}

/* In the plane the third numbers of boxes are not read. */
static void put_flat_box(const void *context, unsigned index, double box[2][FMB_DIM_MAX])
{
    const double(*at)[2] = context;
    for (int axis = 0; axis < 2; axis++)
        box[0][axis] = box[1][axis] = at[index][axis];
    box[0][2] = NAN;
    box[1][2] = -INFINITY;
}

static void boxes_in_the_plane(void **state)
{
    static const double at[4][2] = {{0, 0}, {1, 0}, {0, 0}, {1, -0.0}};
    static const unsigned expected[2][2] = {{0, 2}, {1, 3}};
    const struct fmb_boxes boxes = {2, put_flat_box, at, NULL};
    struct fmb_tree tree;
    struct fmb_tree_cursor cursor = {0};
    unsigned pairs[FMB_TREE_CAPACITY_MIN][2];
    size_t count;
    void *memory = allocate(1, fmb_tree_bytes(4));
    assert_int_equal(fmb_tree_build(&boxes, 4, 1, memory, &tree), FMB_OK);
    assert_int_equal(fmb_tree_pairs(&tree, &tree, &cursor, pairs, FMB_TREE_CAPACITY_MIN, &count),
                     FMB_OK);
    assert_int_equal(count, 2);
    assert_memory_equal(pairs, expected, sizeof expected);
    free(memory);
}

static void boxes_that_cannot_be_are_refused(void **state)
{
    static const double bad[] = {-1, -0x1p-1074, INFINITY, NAN};
    struct fmb_boxes boxes = {3, put_flat_box, NULL, NULL};
    struct fmb_tree tree;
    for (size_t i = 0; i < COUNT(bad); i++) {
        tree.frame_count = 7;
        assert_int_equal(fmb_tree_build(&boxes, 3, bad[i], NULL, &tree), FMB_BAD_DURATION);
        assert_int_equal(tree.frame_count, 0);
    }
    assert_int_equal(fmb_tree_build(&boxes, UINT_MAX, 1, NULL, &tree), FMB_OVER_LIMIT);
    assert_int_equal(fmb_tree_build(&boxes, 0, 1, NULL, &tree), FMB_OK);
    assert_int_equal(tree.frame_count, 0);
    boxes.dim = 4;
    assert_int_equal(fmb_tree_build(&boxes, 3, 1, NULL, &tree), FMB_WRONG_DIMENSION);
    boxes.dim = 1;
    assert_int_equal(fmb_tree_build(&boxes, 3, 1, NULL, &tree), FMB_WRONG_DIMENSION);
}

/* ---- Bodies ---- */

static double any_size(struct draw *draw)
{
    switch (draw_int(draw, 0, 4)) {
    case 0: return draw_log(draw, 1018, 1023);
    case 1: return draw_coin(draw) ? DBL_MAX : -DBL_MAX;
    case 2: return ldexp(draw_int(draw, -5, 5), -1074);
    case 3: return draw_int(draw, -1, 1);
    default: return draw_finite(draw);
    }
}

/* Edges that doubles hold: the body is the same as that of its origin and components, to the byte.
 */
static void what_does_not_round_is_an_ordinary_face(void **state)
{
    struct draw draw;
    draw_begin(&draw, "what_does_not_round_is_an_ordinary_face");
    for (long n = draw_sample(2000); n > 0; n--) {
        double vertex[3][3], number[3][3];
        struct fmb_body body, ordinary;
        for (int k = 0; k < 9; k++)
            vertex[k / 3][k % 3] = draw_int(&draw, -4, 4) * 0.125;
        for (int k = 0; k < 6; k++)
            number[1 + k / 3][k % 3] = vertex[1 + k / 3][k % 3] - vertex[0][k % 3];
        memcpy(number[0], vertex[0], sizeof number[0]);
        assert_int_equal(make_face((const double(*)[3]) vertex, &body), FMB_OK);
        assert_int_equal(fmb_body_make(3, FMB_FACE, number[0], 9, &ordinary), FMB_OK);
        assert_memory_equal(&body, &ordinary, sizeof body);
    }
}

/* Coordinates up to the largest double, and subnormal ones, in one pair. */
static void pairs_at_the_ends_of_the_doubles(void **state)
{
    struct draw draw;
    struct triangles_answer truth;
    long arranged = 0;
    draw_begin(&draw, "pairs_at_the_ends_of_the_doubles");
    triangles_init(&truth);
    for (long n = draw_sample(1500); n > 0; n--) {
        struct drawn drawn = {.duration = 1};
        double pool[6];
        for (int k = 0; k < 6; k++)
            pool[k] = any_size(&draw) * 0.5;
        for (int f = 0; f < 2; f++)
            for (int k = 0; k < 9; k++)
                drawn.triangle[f].vertex[k / 3][k % 3] = pool[draw_int(&draw, 0, 5)];
        triangles_decide(drawn.triangle, 1, true, &truth);
        arranged += truth.verdict != FMB_SEPARATED;
        for (int turn = 0; turn < TURNS; turn += 5) {
            assert_answer(&drawn, turn, "certified", &truth);
            assert_answer(&drawn, turn, "exact", &truth);
        }
        assert_certificate(&drawn, draw_int(&draw, 0, TURNS - 1), truth.verdict);
    }
    triangles_clear(&truth);
    assert_true(arranged > 0);
}

/* The first face is rotated into the plane z = 0, where the second lies. The integers are rows of
 * the matrix of the rotation. Rounded, the planes cross. */
static void rotated_faces_share_their_plane(void **state)
{
    static const double flat[9] = {-0.5, -0.5, 0, 2, 0, 0, 0, 2, 0};
    for (int x = 1; x < 6; x++)
        for (int y = 1; y < 6; y++) {
            const int w = 1, z = 7;
            const double number[6] = {w * w + x * x - y * y - z * z, 2 * (x * y - w * z),
                                      2 * (x * z + w * y),           2 * (x * y + w * z),
                                      w * w - x * x + y * y - z * z, 2 * (y * z - w * x)};
            struct fmb_body body[2];
            assert_int_equal(fmb_body_make(3, FMB_FACE, number, 6, &body[0]), FMB_OK);
            assert_int_equal(fmb_body_make(3, FMB_FACE, flat, 9, &body[1]), FMB_OK);
            const struct fmb_placement a = {
                .body = &body[0], .orientation = {w, x, y, z}, .orientation_count = 4};
            const struct fmb_placement b = {.body = &body[1]};
            struct fmb_answer answer;
            assert_int_equal(fmb_decide(fmb_method_default(), &a, &b, 0, 0, &answer), FMB_OK);
            assert_int_equal(answer.verdict, FMB_OVERLAPPING);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rotated_faces_share_their_plane),
        cmocka_unit_test(pairs_at_rest_are_what_their_vertices_say),
        cmocka_unit_test(moving_pairs_are_what_their_vertices_say),
        cmocka_unit_test(batches_decide_rounded_faces),
        cmocka_unit_test(pairs_at_the_ends_of_the_doubles),
        cmocka_unit_test(a_box_is_tight),
        cmocka_unit_test(trees_of_boxes_lose_nothing),
        cmocka_unit_test(boxes_in_the_plane),
        cmocka_unit_test(boxes_that_cannot_be_are_refused),
        cmocka_unit_test(what_does_not_round_is_an_ordinary_face),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
