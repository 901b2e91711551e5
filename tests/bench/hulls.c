/* What hulls and shapes with a radius cost: verdicts, boxes and gaps near contact and far from it,
 * beside other libraries, and how often these are wrong. */
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "rings.h"
#include "solids.h"

#define COUNT(array) ((int) (sizeof(array) / sizeof(array)[0]))

/* ---- Pairs ---- */

/* Where the solids of a pair are: B's point farthest against a direction is opposite to A's point
 * farthest along it, `gap` away. A positive gap is the distance; a negative one is an upper bound
 * of the depth. With radii, it is at least minus half of their sum.
 *
 *   ANY     a random direction; of a pair with one radius, half of the time the normal of a face
 *   EXACT   without orientations, in multiples of 2^-20, so that a gap of 0 is exact
 *   TILTED  a face on a face */
enum place { ANY, EXACT, TILTED };

struct contact {
    const char *name;
    double gap;
    enum place place;
};

static const struct contact contacts[] = {
    {"random, apart", 1, ANY},    {"gap 1e-3", 1e-3, ANY},        {"gap 1e-9", 1e-9, ANY},
    {"touch, exactly", 0, EXACT}, {"resting, tilted", 0, TILTED}, {"overlap 1e-9", -1e-9, ANY},
    {"overlap 1e-3", -1e-3, ANY}, {"random, deep", -0.5, ANY}};

static const struct contact round_contacts[] = {
    {"random, apart", 1, ANY},      {"gap 1e-3", 1e-3, ANY},      {"gap 1e-6", 1e-6, ANY},
    {"gap 1e-9", 1e-9, ANY},        {"gap 1e-12", 1e-12, ANY},    {"touch, exactly", 0, EXACT},
    {"overlap 1e-12", -1e-12, ANY}, {"overlap 1e-9", -1e-9, ANY}, {"overlap 1e-6", -1e-6, ANY},
    {"overlap 1e-3", -1e-3, ANY},   {"random, deep", -0.5, ANY}};

/* Rings: a hull. No rings, and no sectors: a box; one sector: a sphere; two: a capsule. */
struct kind {
    const char *name;
    struct rings rings[2];
};

static const struct kind kinds[] = {
    {"8 + 8", {{2, 3}, {2, 3}}},         {"20 + 20", {{3, 6}, {3, 6}}},
    {"50 + 50", {{6, 8}, {6, 8}}},       {"152 + 102", {{10, 15}, {10, 10}}},
    {"498 + 498", {{16, 31}, {16, 31}}}, {"152 + box", {{10, 15}, {0, 0}}}};

static const struct kind round_kinds[] = {
    {"sphere + box", {{0, 1}, {0, 0}}},     {"sphere + 100", {{0, 1}, {7, 14}}},
    {"capsule + box", {{0, 2}, {0, 0}}},    {"capsule + 100", {{0, 2}, {7, 14}}},
    {"sphere + sphere", {{0, 1}, {0, 1}}},  {"sphere + capsule", {{0, 1}, {0, 2}}},
    {"capsule + capsule", {{0, 2}, {0, 2}}}};

static bool is_round(struct rings rings)
{
    return rings.rings == 0 && rings.sectors > 0;
}

static int vertices_of(struct rings rings)
{
    return rings.rings ? rings_vertices(rings) : rings.sectors ? rings.sectors : 8;
}

/* Pair i is body i and body count + i; after these, as many for warming up. */
struct hulls {
    size_t count;
    struct fmb_body *body; /* [2 count], as are the next ones */
    struct fmb_placement *placement;
    struct fmb_prepared *prepared;
    struct peer_solid *solid;
    double (*world[2])[3], *memory[2]; /* of all bodies of a side */
    int *face[2];
    unsigned (*pair)[2]; /* [2 count] */
    struct peers *peers;
    unsigned char *verdict;   /* [2 count] */
    struct fmb_gap *gap;      /* [2 count] */
    double *peer_gap;         /* [2 count] */
    struct fmb_answer *truth; /* [count], by the method exact */
};

enum { VERTICES = 512 };

/* A body that is being made, and its vertices. */
struct draft {
    struct rings rings;
    int count;
    double vertex[VERTICES][3]; /* body coordinates; of a hull, a box or a core */
    double turned[VERTICES][3]; /* by the orientation */
    double half[3], radius, orientation[4], position[3];
};

static void turn(const double q[4], const double *v, double *out)
{
    double twice[3], again[3]; /* v + 2 u x (u x v + w v) of a unit quaternion (w, u) */
    vector_cross(q + 1, v, twice);
    vector_add(twice, q[0], v);
    vector_cross(q + 1, twice, again);
    memcpy(out, v, sizeof again);
    vector_add(out, 2, again);
}

static void normalise(double *v, int count)
{
    double square = 0;
    for (int i = 0; i < count; i++)
        square += v[i] * v[i];
    for (int i = 0; i < count; i++)
        v[i] /= sqrt(square);
}

static void draw_unit(struct draw *draw, int count, double *out)
{
    for (int i = 0; i < count; i++)
        out[i] = draw_uniform(draw, -1, 1);
    normalise(out, count);
}

static void turn_all(struct draft *draft)
{
    for (int v = 0; v < draft->count; v++)
        turn(draft->orientation, draft->vertex[v], draft->turned[v]);
}

/* A radius is a multiple of that number. */
static void draw_draft(struct draw *draw, struct rings rings, bool turned, double radius,
                       struct draft *out)
{
    *out = (struct draft){.rings = rings, .count = vertices_of(rings)};
    for (int axis = 0; axis < 3; axis++)
        out->half[axis] = ldexp(draw_int(draw, 1 << 18, 1 << 20), -20);
    if (is_round(rings))
        out->radius = draw_int(draw, 1 << 14, 1 << 16) * radius;
    if (rings.rings)
        rings_points(rings, out->half, out->vertex);
    for (int v = 0; v < out->count && !rings.sectors; v++)
        for (int axis = 0; axis < 3; axis++)
            out->vertex[v][axis] = (v >> axis & 1 ? 1 : -1) * out->half[axis];
    for (int v = 0; v < out->count && out->count == 2; v++)
        out->vertex[v][2] = (v ? 1 : -1) * out->half[2];
    draw_unit(draw, 4, out->orientation);
    if (!turned)
        memcpy(out->orientation, (const double[4]){1}, sizeof out->orientation);
    turn_all(out);
}

/* The middle of the first points, and the normal outwards of the first three of them: of the first
 * face. */
static void first_face(const struct draft *draft, double *middle, double *normal)
{
    static const int box[4] = {1, 3, 7, 5};
    const int north = draft->count - 2, ring[3] = {north, 0, 1};
    const int *face = draft->rings.sectors ? ring : box, count = draft->rings.sectors ? 3 : 4;
    double edge[2][3];
    memset(middle, 0, 3 * sizeof *middle);
    for (int i = 0; i < count; i++)
        vector_add(middle, 1.0 / count, draft->turned[face[i]]);
    for (int i = 0; i < 2; i++) {
        memcpy(edge[i], draft->turned[face[i + 1]], sizeof edge[i]);
        vector_add(edge[i], -1, draft->turned[face[0]]);
    }
    vector_cross(edge[0], edge[1], normal);
    normalise(normal, 3);
}

/* Turns the draft by the shortest arc from one unit vector to another. */
static void turn_to(struct draft *draft, const double *from, const double *to)
{
    double arc[4] = {1 + vector_dot(from, to)};
    const double *p = draft->orientation;
    vector_cross(from, to, arc + 1);
    normalise(arc, 4);
    double q[4] = {arc[0] * p[0] - vector_dot(arc + 1, p + 1)};
    vector_cross(arc + 1, p + 1, q + 1);
    vector_add(q + 1, arc[0], p + 1);
    vector_add(q + 1, p[0], arc + 1);
    memcpy(draft->orientation, q, sizeof q);
    turn_all(draft);
}

static const double *farthest(const struct draft *draft, const double *way, double sign)
{
    int best = 0;
    for (int v = 1; v < draft->count; v++)
        if (sign * vector_dot(way, draft->turned[v]) > sign * vector_dot(way, draft->turned[best]))
            best = v;
    return draft->turned[best];
}

/* Draws a direction of three whole numbers whose length is whole. Returns the length. */
static double draw_whole(struct draw *draw, double *out)
{
    static const int known[][4] = {{1, 2, 2, 3}, {2, 3, 6, 7}, {1, 4, 8, 9}, {4, 4, 7, 9}};
    const int *one = known[draw_int(draw, 0, 3)], first = draw_int(draw, 0, 2);
    for (int axis = 0; axis < 3; axis++)
        out[axis] = one[(first + axis) % 3] * (draw_coin(draw) ? 1 : -1);
    return one[3];
}

static void draw_pair(struct draw *draw, const struct kind *kind, const struct contact *contact,
                      struct draft draft[2])
{
    double way[3] = {1}, points[2][3], length = 1;
    const bool is[2] = {is_round(kind->rings[0]), is_round(kind->rings[1])};
    if (is[0] && contact->place == EXACT)
        length = draw_whole(draw, way);
    for (int side = 0; side < 2; side++)
        draw_draft(draw, kind->rings[side], contact->place != EXACT, ldexp(length, -18),
                   &draft[side]);
    if (contact->place == TILTED) {
        double normal[3];
        first_face(&draft[0], points[0], way);
        first_face(&draft[1], points[1], normal);
        turn_to(&draft[1], normal, (const double[3]){-way[0], -way[1], -way[2]});
        first_face(&draft[1], points[1], normal);
    } else {
        const bool faced = contact->place == ANY && is[0] && !is[1] && draw_coin(draw);
        if (contact->place == ANY)
            draw_unit(draw, 3, way);
        memcpy(points[1], farthest(&draft[1], way, -1), sizeof points[1]);
        if (faced) {
            first_face(&draft[1], points[1], way);
            vector_add(way, -2, (const double[3]){way[0], way[1], way[2]});
        }
        memcpy(points[0], farthest(&draft[0], way, 1), sizeof points[0]);
    }
    const double radius = draft[0].radius + draft[1].radius;
    const double gap = radius > 0 ? fmax(contact->gap, -radius / 2) : contact->gap;
    const double apart = (gap + radius) / length;
    for (int axis = 0; axis < 3; axis++)
        draft[1].position[axis] = points[0][axis] - points[1][axis] + apart * way[axis];
}

/* ---- Their bodies ---- */

static void make_solid(const struct draft *draft, const int *face, double (*world)[3],
                       struct peer_solid *out)
{
    *out = (struct peer_solid){.dim = 3, .count = draft->count};
    memcpy(out->centre, draft->position, sizeof out->centre);
    memcpy(out->origin, draft->position, sizeof out->origin);
    memcpy(world, draft->turned, (size_t) draft->count * sizeof *world);
    out->radius = draft->radius;
    for (int i = 0; i < 3; i++) {
        out->size[i] = 2 * draft->half[i];
        turn(draft->orientation, (const double[3]){i == 0, i == 1, i == 2}, out->axis[i]);
    }
    if (draft->rings.sectors) {
        out->hull = (const double(*)[3]) world;
        out->face = face;
        if (draft->rings.rings)
            rings_faces(draft->rings, NULL, &out->faces);
        return;
    }
    out->box = true;
    memcpy(out->vertex, world, sizeof out->vertex);
    vector_add(out->origin, 1, world[0]);
    for (int v = 0; v < 8; v++)
        vector_add(out->vertex[v], 1, draft->position);
    for (int i = 0; i < 3; i++) {
        memcpy(out->component[i], world[1 << i], sizeof out->component[i]);
        vector_add(out->component[i], -1, world[0]);
    }
}

static void make_body(struct hulls *hulls, const struct draft *draft, size_t i, int side)
{
    const size_t at = i + (side ? hulls->count : 0), numbers = 3 * (size_t) draft->count;
    const size_t doubles = fmb_hull_doubles(3, (size_t) draft->count);
    struct fmb_placement *placement = &hulls->placement[at];
    double size[6] = {0};
    vector_add(size + 3, 2, draft->half);
    const enum fmb_status status =
        draft->rings.sectors
            ? fmb_body_make_hull(3, draft->vertex[0], numbers, hulls->memory[side] + i * doubles,
                                 &hulls->body[at])
            : fmb_body_make(3, FMB_BOX, size, 6, &hulls->body[at]);
    *placement = (struct fmb_placement){.body = &hulls->body[at], .orientation_count = 4};
    memcpy(placement->position, draft->position, sizeof draft->position);
    memcpy(placement->orientation, draft->orientation, sizeof draft->orientation);
    if (status != FMB_OK || fmb_body_inflate(&hulls->body[at], draft->radius) != FMB_OK ||
        fmb_prepare(placement, 0, 1, &hulls->prepared[at]) != FMB_OK) {
        fputs("bench: a hull is refused\n", stderr);
        exit(EXIT_FAILURE);
    }
    make_solid(draft, hulls->face[side], hulls->world[side] + i * (size_t) draft->count,
               &hulls->solid[at]);
}

static void hulls_open(const struct bench *bench, const struct kind *kind,
                       const struct contact *contact, struct hulls *out)
{
    const size_t count = bench->pairs < 512 ? bench->pairs : 512;
    struct draw draw = {bench->seed};
    static struct draft draft[2];
    *out = (struct hulls){.count = count,
                          .body = scene_allocate(2 * count, sizeof *out->body),
                          .placement = scene_allocate(2 * count, sizeof *out->placement),
                          .prepared = scene_allocate(2 * count, sizeof *out->prepared),
                          .solid = scene_allocate(2 * count, sizeof *out->solid),
                          .pair = scene_allocate(2 * count, sizeof *out->pair),
                          .verdict = scene_allocate(2 * count, 1),
                          .gap = scene_allocate(2 * count, sizeof *out->gap),
                          .peer_gap = scene_allocate(2 * count, sizeof *out->peer_gap),
                          .truth = scene_allocate(count, sizeof *out->truth)};
    for (int side = 0; side < 2; side++) {
        const struct rings rings = kind->rings[side];
        const size_t vertices = (size_t) vertices_of(rings);
        int faces;
        out->memory[side] = scene_allocate(count * fmb_hull_doubles(3, vertices), sizeof(double));
        out->world[side] = scene_allocate(count * vertices, sizeof *out->world[side]);
        out->face[side] = scene_allocate((size_t) rings_faces(rings, NULL, &faces), sizeof(int));
        rings_faces(rings, out->face[side], &faces);
    }
    for (size_t i = 0; i < 2 * count; i++) {
        out->pair[i][0] = (unsigned) (i % count);
        out->pair[i][1] = (unsigned) (count + (i < count ? i : i + 1) % count);
    }
    for (size_t i = 0; i < count; i++) {
        draw_pair(&draw, kind, contact, draft);
        for (int side = 0; side < 2; side++)
            make_body(out, &draft[side], i, side);
    }
    out->peers = peers_open(out->solid, 2 * count);
}

static void hulls_close(struct hulls *hulls)
{
    peers_close(hulls->peers);
    for (int side = 0; side < 2; side++) {
        free(hulls->memory[side]);
        free(hulls->world[side]);
        free(hulls->face[side]);
    }
    free(hulls->body);
    free(hulls->placement);
    free(hulls->prepared);
    free(hulls->solid);
    free(hulls->pair);
    free(hulls->verdict);
    free(hulls->truth);
    free(hulls->gap);
    free(hulls->peer_gap);
}

/* ---- Runs ---- */

static void batch(struct hulls *hulls, size_t first, size_t count)
{
    const struct fmb_batch batch = {.frames = hulls->prepared,
                                    .frame_count = 2 * hulls->count,
                                    .pairs = (const unsigned(*)[2]) hulls->pair + first,
                                    .pair_count = count,
                                    .instant = true,
                                    .verdicts = hulls->verdict + first};
    fmb_decide_batch(&batch);
}

static void decide(struct hulls *hulls, size_t first, size_t count, unsigned want)
{
    for (size_t i = first; i < first + count; i++) {
        struct fmb_answer answer;
        fmb_decide(fmb_method_default(), &hulls->placement[hulls->pair[i][0]],
                   &hulls->placement[hulls->pair[i][1]], 0, want, &answer);
        hulls->verdict[i] = (unsigned char) answer.verdict;
        if (want & FMB_WANT_GAP)
            hulls->gap[i] = answer.gap;
    }
}

static void decide_truth(struct hulls *hulls)
{
    for (size_t i = 0; i < hulls->count; i++)
        fmb_decide(fmb_method_by_name("exact"), &hulls->placement[hulls->pair[i][0]],
                   &hulls->placement[hulls->pair[i][1]], 0, FMB_WANT_GAP, &hulls->truth[i]);
}

static void query(struct hulls *hulls, size_t first, size_t count)
{
    decide(hulls, first, count, 0);
}

static void query_box(struct hulls *hulls, size_t first, size_t count)
{
    decide(hulls, first, count, FMB_WANT_BOX);
}

static void query_gap(struct hulls *hulls, size_t first, size_t count)
{
    decide(hulls, first, count, FMB_WANT_GAP);
}

static const struct {
    const char *name;
    void (*run)(struct hulls *hulls, size_t first, size_t count);
} own[] = {{"batch", batch}, {"query", query}, {"query+box", query_box}, {"query+gap", query_gap}};

enum { OWN_RUNS = sizeof own / sizeof *own, RUNS_MAX = OWN_RUNS + PEERS_MAX, BLOCKS_MAX = 64 };

static const char *run_name(int k)
{
    return k < OWN_RUNS ? own[k].name : peer_name(k - OWN_RUNS);
}

static void run(struct hulls *hulls, int k, size_t first, size_t count)
{
    if (k < OWN_RUNS)
        own[k].run(hulls, first, count);
    else
        peer_run(hulls->peers, k - OWN_RUNS, (const unsigned(*)[2]) hulls->pair + first, count,
                 hulls->peer_gap + first);
}

/* The runs that answer something of such pairs. Returns how many. */
static int runs_of(const struct contact *contact, int out[RUNS_MAX])
{
    const int answers = PEER_VERDICT | (contact->gap > 0 ? PEER_DISTANCE : PEER_DEPTH);
    int count = 0;
    for (int k = 0; run_name(k) && count < RUNS_MAX; k++)
        if (k < OWN_RUNS ||
            (peer_takes(k - OWN_RUNS, PEER_HULLS) && peer_answers(k - OWN_RUNS) & answers))
            out[count++] = k;
    return count;
}

/* Nanoseconds a pair, the runs in turn within each block; slow ones decide some pairs only. */
static void time_runs(const struct bench *bench, struct hulls *hulls, const int *runs, int count,
                      struct spread out[RUNS_MAX])
{
    double times[RUNS_MAX][BLOCKS_MAX];
    size_t pairs[RUNS_MAX];
    const int blocks = bench->race.blocks < 9 ? bench->race.blocks : 9;
    for (int k = 0; k < count; k++) {
        const double start = stopwatch_now();
        run(hulls, runs[k], 0, 8);
        const double most = 8 * bench->race.budget / (stopwatch_now() - start);
        pairs[k] = most > (double) hulls->count ? hulls->count : most > 8 ? (size_t) most : 8;
    }
    for (int block = 0; block < blocks; block++) {
        stopwatch_calibrate();
        for (int k = 0; k < count; k++) {
            run(hulls, runs[k], hulls->count, pairs[k] / 4);
            const double start = stopwatch_now();
            run(hulls, runs[k], 0, pairs[k]);
            times[k][block] = (stopwatch_now() - start) / (double) pairs[k];
        }
    }
    for (int k = 0; k < count; k++)
        out[k] = spread_of(times[k], blocks);
}

/* Whether a peer's answer is wrong: about contact, or about the gap by more than far. A missing
 * answer is wrong. Touching is contact, but its gap may have any sign. */
static bool is_wrong_of_peer(double gap, const struct fmb_answer *truth, double far)
{
    const double *bounds = truth->gap.bounds;
    const bool contradicts = (truth->verdict == FMB_SEPARATED) != (gap > 0);
    if (isinf(gap))
        return contradicts;
    return (contradicts && truth->verdict != FMB_TOUCHING) ||
           !(gap >= bounds[0] - far && gap <= bounds[1] + far);
}

/* The same for the engine, whose enclosure of the gap has to agree with the true one. */
static bool is_wrong(const struct hulls *hulls, size_t i, int k)
{
    const struct fmb_answer *truth = &hulls->truth[i];
    const double *bounds = hulls->gap[i].bounds, *true_bounds = truth->gap.bounds;
    return hulls->verdict[i] != truth->verdict ||
           (own[k].run == query_gap &&
            !(bounds[0] <= true_bounds[1] && bounds[1] >= true_bounds[0]));
}

/* The share of answers that are wrong. */
static double wrong_of(struct hulls *hulls, int k, double far)
{
    size_t wrong = 0;
    run(hulls, k, 0, hulls->count);
    for (size_t i = 0; i < hulls->count; i++)
        wrong += k < OWN_RUNS ? is_wrong(hulls, i, k)
                              : is_wrong_of_peer(hulls->peer_gap[i], &hulls->truth[i], far);
    return (double) wrong / (double) hulls->count;
}

/* The share of pairs that touch. */
static double touching_of(const struct hulls *hulls)
{
    size_t touching = 0;
    for (size_t i = 0; i < hulls->count; i++)
        touching += hulls->truth[i].verdict == FMB_TOUCHING;
    return (double) touching / (double) hulls->count;
}

/* ---- Tables ---- */

/* far: the largest error of a gap that counts as right. */
static void row(struct bench *bench, const struct kind *kind, const struct contact *contact,
                double far)
{
    struct hulls hulls;
    struct spread ns[RUNS_MAX];
    int runs[RUNS_MAX];
    char name[64];
    const int count = runs_of(contact, runs);
    snprintf(name, sizeof name, "%s, %s", contact->name, kind->name);
    bench_progress(name);
    hulls_open(bench, kind, contact, &hulls);
    time_runs(bench, &hulls, runs, count, ns);
    decide_truth(&hulls);
    bench_progress(NULL);
    printf("%-32s", name);
    json_begin(&bench->json, NULL, '{');
    json_number(&bench->json, "dim", 3);
    json_bool(&bench->json, "moving", false);
    json_string(&bench->json, "pairs_are", name);
    json_number(&bench->json, "touching", touching_of(&hulls));
    json_begin(&bench->json, "methods", '[');
    for (int k = 0; k < count; k++) {
        const double wrong = wrong_of(&hulls, runs[k], far);
        printf(" %s %.0f (%.1f %%)", run_name(runs[k]), ns[k].median, 100 * wrong);
        json_begin(&bench->json, NULL, '{');
        json_string(&bench->json, "name", run_name(runs[k]));
        json_number(&bench->json, "ns", ns[k].median);
        json_number(&bench->json, "low", ns[k].low);
        json_number(&bench->json, "high", ns[k].high);
        json_number(&bench->json, "wrong", wrong);
        json_end(&bench->json, '}');
    }
    json_end(&bench->json, ']');
    json_end(&bench->json, '}');
    putchar('\n');
    hulls_close(&hulls);
}

static void table(struct bench *bench, const char *name, const struct kind *kind, int kind_count,
                  const struct contact *contact, int contact_count, double far)
{
    peers_help();
    json_begin(&bench->json, name, '[');
    for (int i = 0; i < kind_count; i++)
        for (int k = 0; k < contact_count; k++)
            row(bench, &kind[i], &contact[k], far);
    json_end(&bench->json, ']');
}

void hulls_run(struct bench *bench)
{
    if (!bench_wants(bench, "hulls"))
        return;
    printf(
        "\nHulls by their vertices, whose numbers come last; nanoseconds a pair at rest,\n"
        "distinct pairs, all in turn. batch: verdicts of prepared frames; query: fmb_decide() of\n"
        "placements; +box, +gap: with these. Others are given the vertices turned, and rounded.\n"
        "In parentheses, the percentage of answers that are wrong: in whether the two meet, or\n"
        "off by more than 1e-9 where another library gives a gap.\n");
    table(bench, "hulls", kinds, COUNT(kinds), contacts, COUNT(contacts), 1e-9);
}

void radii_run(struct bench *bench)
{
    if (!bench_wants(bench, "radii"))
        return;
    printf(
        "\nShapes with a radius, and boxes and hulls of 100 vertices; the same runs and numbers.\n"
        "Others have their own spheres and capsules, or a support function. A gap is wrong if\n"
        "it is off by more than 1e-6, or if its sign is wrong.\n");
    table(bench, "radii", round_kinds, COUNT(round_kinds), round_contacts, COUNT(round_contacts),
          1e-6);
}
