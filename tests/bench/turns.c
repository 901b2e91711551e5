/* Cost of windows in which bodies turn: verdicts and contacts of boxes and hulls far from contact,
 * near contact and in contact, beside the continuous solvers of FCL, and how often each method is
 * wrong. Truth is the verdict of the method certified, which build/turning compares with an oracle
 * that shares no code with it. */
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "rings.h"
#include "solids.h"

#define COUNT(array) ((int) (sizeof(array) / sizeof(array)[0]))

/* ---- Windows ---- */

/* How two bodies move. In all motions but ANYHOW, B stands on A:
 *
 *   ANYHOW  from and to random poses; the turn is at most `most` radians
 *   SLIDES  yaws and slides on A
 *   TUMBLES turns upwards about the edge on which it stands; the edge does not move
 *   CLOSES  turns downwards about this edge until its face is level, as a door
 */
enum motion { ANYHOW, SLIDES, TUMBLES, CLOSES };

/* gap: for ANYHOW, the gap over the window, negative for a depth, or 0 for any gap. For the other
 * motions, the height of B above A. */
static const struct kind {
    const char *name;
    enum motion motion;
    double gap, most;
    bool hulls, both; /* both: A turns too */
} kinds[] = {{"boxes, random, one turns", ANYHOW, 0, 3.1, false, false},
             {"boxes, random, both turn", ANYHOW, 0, 3.1, false, true},
             {"boxes, random, turns up to 17 deg", ANYHOW, 0, 0.3, false, true},
             {"boxes, gap 1e-3", ANYHOW, 1e-3, 3.1, false, true},
             {"boxes, gap 1e-6", ANYHOW, 1e-6, 3.1, false, true},
             {"boxes, gap 1e-9", ANYHOW, 1e-9, 3.1, false, true},
             {"boxes, gap 1e-12", ANYHOW, 1e-12, 3.1, false, true},
             {"boxes, depth 1e-3", ANYHOW, -1e-3, 3.1, false, true},
             {"boxes, depth 1e-6", ANYHOW, -1e-6, 3.1, false, true},
             {"boxes, depth 1e-9", ANYHOW, -1e-9, 3.1, false, true},
             {"boxes, depth 1e-12", ANYHOW, -1e-12, 3.1, false, true},
             {"slides on a table", SLIDES, 0, 1.5, false, false},
             {"slides 1e-3 above it", SLIDES, 1e-3, 1.5, false, false},
             {"slides 1e-9 above it", SLIDES, 1e-9, 1.5, false, false},
             {"tumbles on a table", TUMBLES, 0, 1.5, false, false},
             {"tumbles 1e-3 above it", TUMBLES, 1e-3, 1.5, false, false},
             {"tumbles 1e-9 above it", TUMBLES, 1e-9, 1.5, false, false},
             {"a door closes", CLOSES, 0, 1.5, false, false},
             {"a door closes up to 1e-3", CLOSES, 1e-3, 1.5, false, false},
             {"a door closes up to 1e-9", CLOSES, 1e-9, 1.5, false, false},
             {"hulls, random, one turns", ANYHOW, 0, 3.1, true, false},
             {"hulls, random, both turn", ANYHOW, 0, 3.1, true, true},
             {"hulls, gap 1e-3", ANYHOW, 1e-3, 3.1, true, true},
             {"hulls, gap 1e-9", ANYHOW, 1e-9, 3.1, true, true},
             {"hulls, depth 1e-3", ANYHOW, -1e-3, 3.1, true, true},
             {"hulls, depth 1e-9", ANYHOW, -1e-9, 3.1, true, true}};

static const struct rings of_hulls = {7, 14}; /* 100 vertices */

enum { VERTICES = 100, SHIFTS = 12 };

/* A body under construction. */
struct draft {
    bool turns;
    double half[3];
    struct peer_motion motion;
};

/* ---- Drawing ---- */

static void draw_unit(struct draw *draw, int count, double *out)
{
    double square = 0;
    for (int i = 0; i < count; i++)
        out[i] = draw_uniform(draw, -1, 1);
    for (int i = 0; i < count; i++)
        square += out[i] * out[i];
    for (int i = 0; i < count; i++)
        out[i] /= sqrt(square);
}

/* out := q followed by a rotation about a unit vector. */
static void turn_by(const double q[4], double angle, const double axis[3], double out[4])
{
    double by[3] = {0};
    vector_add(by, sin(angle / 2), axis);
    out[0] = cos(angle / 2) * q[0] - vector_dot(by, q + 1);
    vector_cross(by, q + 1, out + 1);
    vector_add(out + 1, cos(angle / 2), q + 1);
    vector_add(out + 1, q[0], by);
}

/* Of boxes, B is a rod. */
static void draw_anyhow(struct draw *draw, const struct kind *kind, struct draft draft[2])
{
    for (int side = 0; side < 2; side++) {
        struct draft *of = &draft[side];
        struct peer_motion *motion = &of->motion;
        double axis[3];
        of->turns = side == 1 || kind->both;
        for (int i = 0; i < 3; i++) {
            const bool thin = side == 1 && i > 0 && !kind->hulls;
            of->half[i] = draw_uniform(draw, thin ? 0.025 : 0.1, thin ? 0.075 : 0.5);
            motion->position[0][i] = side ? draw_uniform(draw, -1, 1) : 0;
            motion->position[1][i] =
                motion->position[0][i] + (of->turns ? draw_uniform(draw, -0.6, 0.6) : 0);
        }
        draw_unit(draw, 4, motion->orientation[0]);
        draw_unit(draw, 3, axis);
        turn_by(motion->orientation[0], of->turns ? draw_uniform(draw, 0, kind->most) : 0, axis,
                motion->orientation[1]);
    }
}

/* A is a table whose top is at height 0. */
static void draw_standing(struct draw *draw, const struct kind *kind, struct draft draft[2])
{
    static const double axis[2][3] = {{0, 0, 1}, {0, -1, 0}}, level[4] = {1};
    const double turn = draw_uniform(draw, 0.2, kind->most);
    struct peer_motion *motion = &draft[1].motion;
    memcpy(draft[0].half, (const double[3]){4, 4, 0.25}, sizeof draft[0].half);
    for (int end = 0; end < 2; end++) {
        memcpy(draft[0].motion.orientation[end], level, sizeof level);
        draft[0].motion.position[end][2] = -0.25;
        for (int i = 0; i < 2 && kind->motion == SLIDES; i++)
            motion->position[end][i] = draw_uniform(draw, -0.5, 0.5);
        const bool turned = end == (kind->motion != CLOSES);
        turn_by(level, turned ? turn : 0, axis[kind->motion != SLIDES], motion->orientation[end]);
        motion->position[end][2] = kind->gap;
    }
    for (int i = 0; i < 3; i++)
        draft[1].half[i] = ldexp(draw_int(draw, 1 << 10, 5 << 10), -13);
    motion->centre[2] = draft[1].half[2];
    motion->centre[0] = kind->motion == SLIDES ? 0 : draft[1].half[0];
    draft[1].turns = true;
}

/* ---- Bodies ---- */

struct turns {
    size_t count; /* pair i is body i and body count + i; as many follow, for warming up */
    struct scene scene;
    struct pairs pairs;
    struct peer_solid *solid;   /* [2 count] */
    struct peer_motion *motion; /* [2 count] */
    double (*vertex)[VERTICES][3], *memory;
    int *face, faces;
    struct work work;
};

static void or_end(enum fmb_status status)
{
    if (status == FMB_OK)
        return;
    fprintf(stderr, "bench: a body that turns is refused: %s\n", fmb_status_text(status));
    exit(EXIT_FAILURE);
}

static void place(const struct draft *draft, struct fmb_placement *out)
{
    const struct peer_motion *motion = &draft->motion;
    memcpy(out->position, motion->position[0], sizeof out->position);
    memcpy(out->orientation, motion->orientation[0], sizeof out->orientation);
    out->orientation_count = 4;
    if (!draft->turns)
        return;
    memcpy(out->end_position, motion->position[1], sizeof out->end_position);
    memcpy(out->end_orientation, motion->orientation[1], sizeof out->end_orientation);
    out->end_count = 7;
}

static void make_body(struct turns *turns, const struct draft *draft, bool hull, size_t at)
{
    struct fmb_body *body = &turns->scene.body[at];
    struct fmb_placement *placement = &turns->scene.placement[at];
    struct peer_solid *solid = &turns->solid[at];
    double box[6];
    *solid = (struct peer_solid){.dim = 3, .box = !hull, .count = hull ? VERTICES : 8};
    memcpy(box, draft->motion.centre, sizeof draft->motion.centre);
    for (int i = 0; i < 3; i++)
        box[3 + i] = solid->size[i] = 2 * draft->half[i];
    turns->motion[at] = draft->motion;
    solid->motion = &turns->motion[at];
    if (hull) {
        double(*vertex)[3] = turns->vertex[at];
        rings_points(of_hulls, draft->half, vertex);
        solid->hull = (const double(*)[3]) vertex;
        solid->face = turns->face;
        solid->faces = turns->faces;
        or_end(fmb_body_make_hull(3, vertex[0], 3 * (size_t) VERTICES,
                                  turns->memory + at * fmb_hull_doubles(3, VERTICES), body));
    } else {
        or_end(fmb_body_make(3, FMB_BOX, box, 6, body));
    }
    *placement = (struct fmb_placement){.body = body};
    place(draft, placement);
}

/* Shifts B along the direction of the gap until the middle of its bounds is near the target.
 * Returns false if that takes too many shifts, or if the first gap is far from 0 or missing. */
static bool shift(const struct kind *kind, struct draft *draft, struct fmb_placement *a,
                  struct fmb_placement *b)
{
    const double far = fmax(0.01 * fabs(kind->gap), 0.4e-12);
    for (int round = 0; round < SHIFTS; round++) {
        struct fmb_answer answer;
        place(draft, b);
        if (fmb_decide(fmb_method_default(), a, b, 1, FMB_WANT_GAP, &answer) != FMB_OK)
            return false;
        const double *bounds = answer.gap.bounds, middle = bounds[0] / 2 + bounds[1] / 2;
        if (round == 0 && (middle < -0.05 || middle > 0.4))
            return false;
        if (fabs(middle - kind->gap) <= far)
            return true;
        for (int end = 0; end < 2; end++)
            vector_add(draft->motion.position[end], kind->gap - middle, answer.gap.direction);
    }
    return false;
}

static void draw_pair(struct draw *draw, const struct kind *kind, struct turns *turns, size_t i)
{
    struct draft draft[2];
    struct fmb_placement *placement[2] = {&turns->scene.placement[i],
                                          &turns->scene.placement[turns->count + i]};
    do {
        memset(draft, 0, sizeof draft);
        (kind->motion == ANYHOW ? draw_anyhow : draw_standing)(draw, kind, draft);
        for (int side = 0; side < 2; side++)
            make_body(turns, &draft[side], kind->hulls, side ? turns->count + i : i);
    } while (kind->motion == ANYHOW && kind->gap != 0 &&
             !shift(kind, &draft[1], placement[0], placement[1]));
    turns->motion[turns->count + i] = draft[1].motion;
    for (int side = 0; side < 2; side++)
        or_end(fmb_prepare(placement[side], 0, 1,
                           &turns->scene.prepared[side ? turns->count + i : i]));
}

static void turns_open(const struct bench *bench, const struct kind *kind, struct turns *out)
{
    const size_t count = bench->pairs < 512 ? bench->pairs : 512;
    struct draw draw = {bench->seed};
    *out = (struct turns){
        .count = count,
        .scene = scene_empty(2 * count),
        .pairs = pairs_side_by_side(count),
        .solid = scene_allocate(2 * count, sizeof *out->solid),
        .motion = scene_allocate(2 * count, sizeof *out->motion),
        .vertex = scene_allocate(2 * count, sizeof *out->vertex),
        .memory = scene_allocate(2 * count * fmb_hull_doubles(3, VERTICES), sizeof *out->memory)};
    out->face = scene_allocate((size_t) rings_faces(of_hulls, NULL, &out->faces), sizeof(int));
    rings_faces(of_hulls, out->face, &out->faces);
    for (size_t i = 0; i < count; i++)
        draw_pair(&draw, kind, out, i);
    out->work = work_of(&out->scene, &out->pairs);
    out->work.count = out->work.warm_count = count;
    out->work.warm = out->work.pair + count;
    out->work.instructions = bench->instructions;
    out->work.peers = peers_open(out->solid, 2 * count);
}

static void turns_close(struct turns *turns)
{
    peers_close(turns->work.peers);
    work_free(&turns->work);
    pairs_free(&turns->pairs);
    scene_free(&turns->scene);
    free(turns->solid);
    free(turns->motion);
    free(turns->vertex);
    free(turns->memory);
    free(turns->face);
}

/* ---- Races ---- */

static int list_raced(enum contender raced[CONTENDERS_AND_PEERS])
{
    int count = 0;
    raced[count++] = CONTENDER_BATCH;
    raced[count++] = CONTENDER_QUERY;
    for (int peer = 0; peer_name(peer); peer++)
        if (peer_answers(peer) & PEER_TURNING_VERDICT)
            raced[count++] = (enum contender)(CONTENDERS + peer);
    return count;
}

static double share_of(const unsigned char *verdict, size_t count, enum fmb_verdict least,
                       enum fmb_verdict most)
{
    size_t found = 0;
    for (size_t i = 0; i < count; i++)
        found += verdict[i] >= (unsigned char) least && verdict[i] <= (unsigned char) most;
    return (double) found / (double) count;
}

/* Every method decides all pairs, without a time limit. */
static void row(struct bench *bench, const struct kind *kind, const enum contender *raced,
                int count)
{
    const struct race race = {bench->race.blocks < 9 ? bench->race.blocks : 9, INFINITY};
    struct spread ns[CONTENDERS_AND_PEERS];
    struct turns turns;
    bench_progress(kind->name);
    turns_open(bench, kind, &turns);
    const struct work *work = &turns.work;
    unsigned char *certified = scene_allocate(work->count, 1);
    race_run(&race, work, raced, count, ns);
    contender_run(CONTENDER_QUERY, work);
    memcpy(certified, work->verdicts, work->count);
    const double meet = share_of(certified, work->count, FMB_TOUCHING, FMB_OVERLAPPING);
    const double undecided = share_of(certified, work->count, 0, 0);
    bench_progress(NULL);
    printf("%-34s %5.1f %5.1f", kind->name, 100 * meet, 100 * undecided);
    json_begin(&bench->json, NULL, '{');
    json_string(&bench->json, "pairs_are", kind->name);
    json_number(&bench->json, "pairs", (double) work->count);
    json_number(&bench->json, "meet", meet);
    json_number(&bench->json, "undecided", undecided);
    json_begin(&bench->json, "methods", '[');
    for (int i = 0; i < count; i++) {
        const double wrong = contender_wrong(raced[i], work, certified);
        printf(" %10.0f %5.1f", ns[i].median, 100 * wrong);
        json_begin(&bench->json, NULL, '{');
        json_string(&bench->json, "name", contender_name(raced[i]));
        json_number(&bench->json, "ns", ns[i].median);
        json_number(&bench->json, "low", ns[i].low);
        json_number(&bench->json, "high", ns[i].high);
        json_number(&bench->json, "wrong", wrong);
        json_end(&bench->json, '}');
    }
    json_end(&bench->json, ']');
    json_end(&bench->json, '}');
    putchar('\n');
    free(certified);
    turns_close(&turns);
}

void turns_run(struct bench *bench)
{
    enum contender raced[CONTENDERS_AND_PEERS];
    if (!bench_wants(bench, "turns"))
        return;
    const int count = list_raced(raced);
    printf(
        "\nBoxes, or hulls of 100 vertices, that turn within the window. Nanoseconds a pair, the\n"
        "same distinct pairs for all methods; after each time the percentage of wrong verdicts;\n"
        "touching is contact. query includes the contact. All methods interpolate quaternions as\n"
        "fmb.h does. meet: the percentage of pairs that meet; open: the percentage of pairs\n"
        "without a certified answer.\n");
    peers_help();
    printf("%-34s %5s %5s", "", "meet", "open");
    for (int i = 0; i < count; i++)
        printf(" %16s", contender_name(raced[i]));
    putchar('\n');
    json_begin(&bench->json, "turns", '[');
    for (int i = 0; i < COUNT(kinds); i++)
        row(bench, &kinds[i], raced, count);
    json_end(&bench->json, ']');
}
