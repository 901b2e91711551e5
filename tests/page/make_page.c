/* make-page WHICH: a page of a log that is made up, on standard output.
 *
 *     mixed   every kind of query and outcome, a known difference, numbers of all sizes, and
 *             a title that would break a page that reads it as HTML
 *     arm     an arm that swings over a table of parts, all pairs of them at 20 Hz
 *     many    more queries than a page keeps, of many pairs, with a long pause
 *     crowd   one scene of as many frames as a query may have
 *     empty   no query */
#include "teller.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double degree = 3.14159265358979323846 / 180;

enum { WANT_ALL = QUERY_WANT_BOX | QUERY_WANT_TIMES };

/* ---- What was different ---------------------------------------------------------------------- */

/* It was touching for a shorter time, in a smaller box. */
static void then_touching(struct pair_result *then)
{
    then->answer.verdict = FMB_TOUCHING;
    then->answer.contact[1] = (then->answer.contact[0] + then->answer.contact[1]) / 2;
    then->answer.box[1][0] = (then->answer.box[0][0] + then->answer.box[1][0]) / 2;
}

static void then_refused(struct pair_result *then)
{
    memset(&then->answer, 0, sizeof then->answer);
    then->status = FMB_BAD_DURATION;
    then->dim = then->method = 0;
    strcpy(then->detail, "duration: <b>not</b> what it should be");
}

/* One contact was missed, and the box of another was larger. */
static void then_missed(struct scene_result *then)
{
    if (then->contact_count < 2)
        return;
    const int numbers = 2 * then->dim;
    then->verdict_count--;
    then->contact_count--;
    if (then->has_times)
        memmove(then->times, then->times + 2,
                2 * (size_t) then->contact_count * sizeof *then->times);
    if (then->has_boxes)
        memmove(then->boxes, then->boxes + numbers,
                (size_t) (numbers * then->contact_count) * sizeof *then->boxes);
    memmove(then->verdict, then->verdict + 1, (size_t) then->verdict_count);
    memmove(then->pair, then->pair + 1, (size_t) then->verdict_count * sizeof *then->pair);
    if (then->has_boxes)
        then->boxes[then->dim] += 0.0625;
}

/* ---- Mixed ----------------------------------------------------------------------------------- */

static struct pair_query pair_of(struct query_frame a, struct query_frame b, double duration)
{
    return (struct pair_query){.duration = duration, .want = QUERY_WANT_BOX, .frame = {a, b}};
}

/* A square that passes a triangle in the plane. */
static void tell_plane(struct teller *teller)
{
    static const double still[] = {2, 0.5}, velocity[] = {1.5, 0.25};
    struct query_frame triangle = teller_solid(2, 2, FMB_TETRAHEDRON, 1.5, still);
    for (int i = 0; i < 24; i++) {
        const double at[] = {i * 0.2 - 1, 0.25};
        struct query_frame square = teller_solid(1, 2, FMB_CUBOID, 1, at);
        teller_move(&square, velocity);
        const struct pair_query query = pair_of(square, triangle, 0.5);
        teller_pair(teller, &query);
        teller_wait(teller, 0.05);
    }
}

/* A cube that falls onto a face; at the ninth query something else was recorded. */
static void tell_space(struct teller *teller)
{
    static const double plate[] = {2, 0.5, 0, 0, 2, 0.25}, origin[] = {0, 0, 0},
                        velocity[] = {0.5, 0, -1};
    const struct query_frame face = teller_frame(4, 3, FMB_FACE, plate, origin);
    for (int i = 0; i < 12; i++) {
        const double at[] = {0.25, 0.5, 2.5 - 0.25 * i};
        struct query_frame cube = teller_solid(3, 3, FMB_CUBOID, 0.75, at);
        teller_move(&cube, velocity);
        const struct pair_query query = pair_of(cube, face, 1);
        if (i == 8)
            teller->spoil_pair = then_touching;
        if (i == 10)
            teller->spoil_pair = then_refused;
        teller_pair(teller, &query);
        teller_wait(teller, 0.1);
    }
}

/* Two frames of this size at this place, half of it apart; the second one comes. */
static void tell_size(struct teller *teller, int64_t id, int dim, double size, double place)
{
    const double at[] = {place, place, place}, speed[] = {-size / 2, 0, 0};
    const double beside[] = {place + size / 2, place, place};
    struct query_frame a = teller_solid(id, dim, FMB_CUBOID, size, at);
    struct query_frame b = teller_solid(id + 1, dim, FMB_TETRAHEDRON, size, beside);
    teller_move(&b, speed);
    const struct pair_query query = pair_of(a, b, 1);
    teller_pair(teller, &query);
    teller_wait(teller, 0.05);
}

static void tell_sizes(struct teller *teller)
{
    static const double sizes[] = {1e-300, 5e-324, 1e300, 1.7e308, 1e8, 0};
    for (int i = 0; i < (int) (sizeof sizes / sizeof *sizes); i++)
        tell_size(teller, 100 + 2 * i, 2 + i % 2, sizes[i], 0);
    tell_size(teller, 120, 2, 4, 1e16);
    tell_size(teller, 122, 3, 1, 1e12);
    tell_size(teller, 124, 3, 1.5e308, -1.7e308);
    tell_size(teller, 126, 2, 1, 1e300);
}

/* From one end of the doubles to the other, and beyond: no double holds how far they are apart. */
static void tell_far(struct teller *teller)
{
    static const double low[] = {-1.7e308, 0, 0}, high[] = {1.7e308, 0, 0};
    const struct pair_query query = pair_of(teller_solid(128, 3, FMB_CUBOID, 1.2e308, low),
                                            teller_solid(129, 3, FMB_CUBOID, 1.2e308, high), 1);
    teller_pair(teller, &query);
    teller_wait(teller, 0.05);
}

/* What cannot be compared, or drawn. */
static void tell_odd(struct teller *teller)
{
    static const double origin[] = {0, 0, 0};
    const struct query_frame cube = teller_solid(7, 3, FMB_CUBOID, 1, origin);
    struct query_frame other = teller_solid(8, 3, FMB_TETRAHEDRON, 1, origin);
    struct pair_query query = pair_of(cube, other, 1);
    teller->outcome = REPLAY_BUSY;
    teller_pair(teller, &query);
    teller_wait(teller, 0.05);
    teller->outcome = REPLAY_ALONE;
    teller_pair(teller, &query);
    teller_wait(teller, 0.05);
    query.frame[1].key = 4711;
    query.frame[1].components.count = 0;
    teller->outcome = REPLAY_UNKNOWN;
    teller_pair(teller, &query);
    teller_wait(teller, 0.05);
    query = pair_of(cube, other, -1);
    query.frame[0].origin.number[1] = NAN;
    query.frame[1].body_id = INT64_MAX;
    teller_pair(teller, &query);
    teller_wait(teller, 0.05);
}

/* A scene with anonymous frames, of which one moves. */
static void tell_scene(struct teller *teller, int32_t which)
{
    static struct scene_query query;
    static const double velocity[] = {0, -1, 0};
    memset(&query, 0, sizeof query);
    query.duration = 1;
    query.want = WANT_ALL;
    query.which = which;
    query.split = which == QUERY_PAIRS_ACROSS ? 2 : 0;
    query.frame_count = 5;
    for (int i = 0; i < 5; i++) {
        const double at[] = {i * 0.75, i % 2, 0};
        query.frame[i] =
            teller_solid(i < 2 ? 0 : 30 + i, 3, i % 2 ? FMB_TETRAHEDRON : FMB_CUBOID, 1, at);
    }
    teller_move(&query.frame[1], velocity);
    if (which == QUERY_PAIRS_LISTED) {
        query.index_count = 8;
        for (unsigned i = 0; i < 4; i++) {
            query.pair[i][0] = i;
            query.pair[i][1] = i + 1;
        }
    }
    teller_scene(teller, &query);
    teller_wait(teller, 0.25);
}

static void tell_mixed(struct teller *teller)
{
    teller_begin(teller, "</title></script><script>throw 'title'</script><!-- \"&amp;' \xff");
    tell_plane(teller);
    tell_space(teller);
    tell_sizes(teller);
    tell_far(teller);
    tell_odd(teller);
    tell_scene(teller, QUERY_PAIRS_LISTED);
    teller->spoil_scene = then_missed;
    tell_scene(teller, QUERY_PAIRS_ALL);
    tell_scene(teller, QUERY_PAIRS_ACROSS);
    teller->log = "other \xc3\xa4 </script>.log";
    tell_size(teller, 1, 2, 1, 0);
}

/* ---- The arm --------------------------------------------------------------------------------- */

enum { LINKS = 3, PARTS = 6, BODIES = 2 + LINKS + PARTS };

/* A link from a joint on, its direction in the plane of the arm, which is turned about z. */
static struct query_frame link_frame(int64_t id, double joint[3], double yaw, double pitch,
                                     double length, double thickness)
{
    const double along[] = {cos(yaw) * cos(pitch), sin(yaw) * cos(pitch), sin(pitch)};
    const double side[] = {-sin(yaw), cos(yaw), 0};
    const double up[] = {-cos(yaw) * sin(pitch), -sin(yaw) * sin(pitch), cos(pitch)};
    double components[9], origin[3];
    for (int axis = 0; axis < 3; axis++) {
        components[axis] = length * along[axis];
        components[3 + axis] = thickness * side[axis];
        components[6 + axis] = thickness * up[axis];
        origin[axis] = joint[axis] - thickness / 2 * (side[axis] + up[axis]);
        joint[axis] += length * along[axis];
    }
    return teller_frame(id, 3, FMB_CUBOID, components, origin);
}

static void arm_links(double time, struct query_frame out[LINKS])
{
    static const double length[] = {0.5, 0.45, 0.2}, thickness[] = {0.09, 0.07, 0.05};
    double joint[] = {0, 0, 0.8}, yaw = (60 * sin(0.9 * time) + 10) * degree;
    double pitch = (50 - 20 * sin(0.7 * time)) * degree;
    for (int i = 0; i < LINKS; i++) {
        out[i] = link_frame(11 + i, joint, yaw, pitch, length[i], thickness[i]);
        pitch -= (i == 0 ? 80 + 24 * cos(1.3 * time) : 35) * degree;
    }
}

static void arm_scene(double time, double step, struct scene_query *out)
{
    static const double table[] = {0.9, 0, 0, 0, 1.6, 0, 0, 0, 0.05},
                        table_at[] = {0.25, -0.8, 0.7};
    static const double column[] = {0.2, 0, 0, 0, 0.2, 0, 0, 0, 0.8}, column_at[] = {-0.1, -0.1, 0};
    struct query_frame links[LINKS], next[LINKS];
    int count = 0;
    out->frame[count++] = teller_frame(1, 3, FMB_CUBOID, table, table_at);
    out->frame[count++] = teller_frame(2, 3, FMB_CUBOID, column, column_at);
    arm_links(time, links);
    arm_links(time + step, next);
    for (int i = 0; i < LINKS; i++) {
        double velocity[3];
        for (int axis = 0; axis < 3; axis++)
            velocity[axis] = (next[i].origin.number[axis] - links[i].origin.number[axis]) / step;
        teller_move(&links[i], velocity);
        out->frame[count++] = links[i];
    }
    for (int i = 0; i < PARTS; i++) {
        const double at[] = {0.45 + 0.1 * (i % 3), -0.65 + 0.22 * i, 0.75};
        out->frame[count++] =
            teller_solid(21 + i, 3, i % 2 ? FMB_TETRAHEDRON : FMB_CUBOID, 0.11 + 0.02 * i, at);
    }
    out->frame_count = count;
}

static void tell_arm(struct teller *teller)
{
    static struct scene_query query;
    const double step = 0.05;
    teller_begin(teller, "arm.log");
    for (int i = 0; i < 240; i++) {
        memset(&query, 0, sizeof query);
        query.duration = 4 * step;
        query.want = WANT_ALL;
        query.which = QUERY_PAIRS_ALL;
        arm_scene(i * step, 4 * step, &query);
        if (i == 37 || i == 38 || i == 161)
            teller->spoil_scene = then_missed;
        teller_scene(teller, &query);
        teller_wait(teller, step);
    }
}

/* ---- Many, a crowd --------------------------------------------------------------------------- */

/* Ninety pairs in turns; after a minute a pause of a day. */
static void tell_many(struct teller *teller)
{
    enum { PAIRS = 90, QUERIES = PAGE_EVENTS_MAX + 700 };
    teller_begin(teller, "many.log");
    for (int i = 0; i < QUERIES; i++) {
        const int pair = i % PAIRS;
        const double zero[] = {0, 0}, turn = i * 0.01 + pair;
        const double at[] = {(1.2 + pair % 7 * 0.1) * cos(turn), 1.2 * sin(turn)};
        const struct pair_query query =
            pair_of(teller_solid(1000 + pair / 3, 2, FMB_CUBOID, 1, zero),
                    teller_solid(2000 + pair, 2, FMB_TETRAHEDRON, 1, at), 0);
        if (i % 997 == 500)
            teller->spoil_pair = then_refused;
        teller_pair(teller, &query);
        teller_wait(teller, i == 4000 ? 86400 : 0.015);
    }
}

static void tell_crowd(struct teller *teller)
{
    static struct scene_query query;
    memset(&query, 0, sizeof query);
    teller_begin(teller, "crowd.log");
    query.which = QUERY_PAIRS_ALL;
    query.frame_count = QUERY_FRAMES_MAX;
    query.want = QUERY_WANT_BOX;
    for (int i = 0; i < QUERY_FRAMES_MAX; i++) {
        const double at[] = {i % 14 * 1.1, i / 14 % 10 * 1.05, i / 140 * 1.2};
        query.frame[i] =
            teller_solid(i + 1, 3, i % 3 ? FMB_CUBOID : FMB_TETRAHEDRON, 0.8 + i % 5 * 0.1, at);
    }
    teller_scene(teller, &query);
}

static void tell_empty(struct teller *teller)
{
    teller_begin(teller, "");
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        void (*tell)(struct teller *teller);
    } stories[] = {{"mixed", tell_mixed},
                   {"arm", tell_arm},
                   {"many", tell_many},
                   {"crowd", tell_crowd},
                   {"empty", tell_empty}};
    for (size_t i = 0; argc == 2 && i < sizeof stories / sizeof *stories; i++) {
        struct teller teller;
        if (strcmp(argv[1], stories[i].name) != 0)
            continue;
        stories[i].tell(&teller);
        return teller_end(&teller, stdout) ? EXIT_SUCCESS : EXIT_FAILURE;
    }
    fprintf(stderr, "usage: make-page mixed|arm|many|crowd|empty > FILE\n");
    return 2;
}
