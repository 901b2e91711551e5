/* make-page NAME: writes the page of a made-up log to standard output.
 *
 *     mixed   every kind of query and outcome, a known difference, numbers of all sizes, and
 *             a title that would break a page that reads it as HTML
 *     arm     an arm that swings over a table of parts, all pairs of them at 20 Hz
 *     many    more queries than a page keeps, of many pairs, with a long pause
 *     crowd   one scene of nearly as many bodies, by handle, as a 3D query may have
 *     uneven  one pair at uneven times, a stretch of another one, bursts with long pauses
 *     empty   no query */
#include "sample_log.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double degree = 3.14159265358979323846 / 180;

enum { WANT_ALL = FMB_WANT_BOX | FMB_WANT_TIMES };

/* ---- Recorded results that differ ------------------------------------------------------------ */

/* Touching, for a shorter time and in a smaller box. */
static void record_touching(struct pair_result *then)
{
    then->answer.verdict = FMB_TOUCHING;
    then->answer.contact[1] = (then->answer.contact[0] + then->answer.contact[1]) / 2;
    then->answer.box[1][0] = (then->answer.box[0][0] + then->answer.box[1][0]) / 2;
}

static void record_refused(struct pair_result *then)
{
    memset(&then->answer, 0, sizeof then->answer);
    then->status = FMB_BAD_DURATION;
    then->dim = then->method = 0;
    strcpy(then->detail, "duration: <b>not</b> a duration");
}

/* One contact is missing, and the box of another is larger. */
static void record_missed(struct scene_result *then)
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

static struct pair_query pair_of(struct query_placement a, struct query_placement b,
                                 double duration)
{
    return (struct pair_query){.duration = duration, .want = FMB_WANT_BOX, .placement = {a, b}};
}

/* A square that passes a triangle in the plane. */
static void add_plane(struct sample_log *log)
{
    static const double still[] = {2, 0.5}, velocity[] = {1.5, 0.25};
    struct query_placement triangle = sample_solid(2, 2, FMB_TETRAHEDRON, 1.5, still);
    for (int i = 0; i < 24; i++) {
        const double at[] = {i * 0.2 - 1, 0.25};
        struct query_placement square = sample_solid(1, 2, FMB_CUBOID, 1, at);
        sample_move(&square, velocity);
        struct pair_query query = pair_of(square, triangle, 0.5);
        query.want |= FMB_WANT_GAP;
        sample_pair(log, &query);
        sample_wait(log, 0.05);
    }
}

/* A cube that falls onto a face; at the ninth query something else was recorded. */
static void add_space(struct sample_log *log)
{
    static const double plate[] = {2, 0.5, 0, 0, 2, 0.25}, origin[] = {0, 0, 0},
                        velocity[] = {0.5, 0, -1};
    const struct query_placement face = sample_body(4, 3, FMB_FACE, plate, origin);
    for (int i = 0; i < 12; i++) {
        const double at[] = {0.25, 0.5, 2.5 - 0.25 * i};
        struct query_placement cube = sample_solid(3, 3, FMB_CUBOID, 0.75, at);
        sample_move(&cube, velocity);
        const struct pair_query query = pair_of(cube, face, 1);
        if (i == 8)
            log->alter_pair = record_touching;
        if (i == 10)
            log->alter_pair = record_refused;
        sample_pair(log, &query);
        sample_wait(log, 0.1);
    }
}

/* Two bodies of this size, half of it apart; the second one moves towards the first. */
static void add_size(struct sample_log *log, int64_t id, int dim, double size, double place)
{
    const double at[] = {place, place, place}, speed[] = {-size / 2, 0, 0};
    const double beside[] = {place + size / 2, place, place};
    struct query_placement a = sample_solid(id, dim, FMB_CUBOID, size, at);
    struct query_placement b = sample_solid(id + 1, dim, FMB_TETRAHEDRON, size, beside);
    sample_move(&b, speed);
    const struct pair_query query = pair_of(a, b, 1);
    sample_pair(log, &query);
    sample_wait(log, 0.05);
}

static void add_sizes(struct sample_log *log)
{
    static const double sizes[] = {1e-300, 5e-324, 1e300, 1.7e308, 1e8, 0};
    for (int i = 0; i < (int) (sizeof sizes / sizeof *sizes); i++)
        add_size(log, 100 + 2 * i, 2 + i % 2, sizes[i], 0);
    add_size(log, 120, 2, 4, 1e16);
    add_size(log, 122, 3, 1, 1e12);
    add_size(log, 124, 3, 1.5e308, -1.7e308);
    add_size(log, 126, 2, 1, 1e300);
}

/* At both ends of the doubles: their distance is more than the largest one. */
static void add_far(struct sample_log *log)
{
    static const double low[] = {-1.7e308, 0, 0}, high[] = {1.7e308, 0, 0};
    const struct pair_query query = pair_of(sample_solid(128, 3, FMB_CUBOID, 1.2e308, low),
                                            sample_solid(129, 3, FMB_CUBOID, 1.2e308, high), 1);
    sample_pair(log, &query);
    sample_wait(log, 0.05);
}

static void add_outcome(struct sample_log *log, enum replay_outcome outcome,
                        const struct pair_query *query)
{
    log->outcome = outcome;
    sample_pair(log, query);
    sample_wait(log, 0.05);
}

/* Queries without a comparison, and bodies that cannot be drawn. */
static void add_odd(struct sample_log *log)
{
    static const double origin[] = {0, 0, 0};
    const struct query_placement cube = sample_solid(7, 3, FMB_CUBOID, 1, origin);
    struct pair_query query = pair_of(cube, sample_solid(8, 3, FMB_TETRAHEDRON, 1, origin), 1);
    add_outcome(log, REPLAY_BUSY, &query);
    add_outcome(log, REPLAY_UNRECORDED, &query);
    sample_define(log, &query.placement[1]);
    add_outcome(log, REPLAY_UNKNOWN, &query);
    query.placement[1].body.frame_count = query.placement[1].body.number_count = 0;
    memset(&query.placement[1].body.handle, 0x47, sizeof query.placement[1].body.handle);
    add_outcome(log, REPLAY_UNDEFINED, &query);
    query = pair_of(cube, sample_solid(INT64_MAX, 3, FMB_TETRAHEDRON, 1, origin), -1);
    query.placement[0].placed.position[1] = NAN;
    add_outcome(log, REPLAY_SAME, &query);
}

/* A scene with anonymous bodies, one of which moves. */
static void add_scene(struct sample_log *log, int32_t which)
{
    static struct scene_query query;
    static const double velocity[] = {0, -1, 0};
    memset(&query, 0, sizeof query);
    query.duration = 1;
    query.want = WANT_ALL;
    query.which = which;
    query.split = which == FMB_PAIRS_ACROSS ? 2 : 0;
    query.placement_count = 5;
    for (int i = 0; i < 5; i++) {
        const double at[] = {i * 0.75, i % 2, 0};
        query.placement[i] =
            sample_solid(i < 2 ? 0 : 30 + i, 3, i % 2 ? FMB_TETRAHEDRON : FMB_CUBOID, 1, at);
    }
    sample_move(&query.placement[1], velocity);
    if (which == FMB_PAIRS_LISTED) {
        query.index_count = 8;
        for (unsigned i = 0; i < 4; i++) {
            query.pair[i][0] = i;
            query.pair[i][1] = i + 1;
        }
    }
    sample_scene(log, &query);
    sample_wait(log, 0.25);
}

static void add_mixed(struct sample_log *log)
{
    sample_begin(log, "</title></script><script>throw 'title'</script><!-- \"&amp;' \xff");
    add_plane(log);
    add_space(log);
    add_sizes(log);
    add_far(log);
    add_odd(log);
    add_scene(log, FMB_PAIRS_LISTED);
    log->alter_scene = record_missed;
    add_scene(log, FMB_PAIRS_ALL);
    add_scene(log, FMB_PAIRS_ACROSS);
    log->log = "other \xc3\xa4 </script>.log";
    add_size(log, 1, 2, 1, 0);
}

/* ---- The arm --------------------------------------------------------------------------------- */

enum { LINKS = 3, PARTS = 6 };

/* A link that begins at the joint, and in the plane of the arm, which is turned about z. On output:
 * joint is the end of the link. */
static struct query_placement link_body(int64_t id, double joint[3], double yaw, double pitch,
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
    return sample_body(id, 3, FMB_CUBOID, components, origin);
}

static void arm_links(double time, struct query_placement out[LINKS])
{
    static const double length[] = {0.5, 0.45, 0.2}, thickness[] = {0.09, 0.07, 0.05};
    double joint[] = {0, 0, 0.8}, yaw = (60 * sin(0.9 * time) + 10) * degree;
    double pitch = (50 - 20 * sin(0.7 * time)) * degree;
    for (int i = 0; i < LINKS; i++) {
        out[i] = link_body(11 + i, joint, yaw, pitch, length[i], thickness[i]);
        pitch -= (i == 0 ? 80 + 24 * cos(1.3 * time) : 35) * degree;
    }
}

static void arm_scene(double time, double step, struct scene_query *out)
{
    static const double table[] = {0.9, 0, 0, 0, 1.6, 0, 0, 0, 0.05},
                        table_at[] = {0.25, -0.8, 0.7};
    static const double column[] = {0.2, 0, 0, 0, 0.2, 0, 0, 0, 0.8}, column_at[] = {-0.1, -0.1, 0};
    struct query_placement links[LINKS], next[LINKS];
    int count = 0;
    out->placement[count++] = sample_body(1, 3, FMB_CUBOID, table, table_at);
    out->placement[count++] = sample_body(2, 3, FMB_CUBOID, column, column_at);
    arm_links(time, links);
    arm_links(time + step, next);
    for (int i = 0; i < LINKS; i++) {
        double velocity[3];
        for (int axis = 0; axis < 3; axis++)
            velocity[axis] =
                (next[i].placed.position[axis] - links[i].placed.position[axis]) / step;
        sample_move(&links[i], velocity);
        out->placement[count++] = links[i];
    }
    for (int i = 0; i < PARTS; i++) {
        const double at[] = {0.45 + 0.1 * (i % 3), -0.65 + 0.22 * i, 0.75};
        out->placement[count++] =
            sample_solid(21 + i, 3, i % 2 ? FMB_TETRAHEDRON : FMB_CUBOID, 0.11 + 0.02 * i, at);
    }
    out->placement_count = count;
}

static void add_arm(struct sample_log *log)
{
    static struct scene_query query;
    const double step = 0.05;
    sample_begin(log, "arm.log");
    for (int i = 0; i < 240; i++) {
        memset(&query, 0, sizeof query);
        query.duration = 4 * step;
        query.want = WANT_ALL;
        query.which = FMB_PAIRS_ALL;
        arm_scene(i * step, 4 * step, &query);
        if (i == 37 || i == 38 || i == 161)
            log->alter_scene = record_missed;
        sample_scene(log, &query);
        sample_wait(log, step);
    }
}

/* ---- Many queries, many bodies --------------------------------------------------------------- */

/* Ninety pairs in turn; after a minute, a pause of one day. */
static void add_many(struct sample_log *log)
{
    enum { PAIRS = 90, QUERIES = PAGE_EVENTS_MAX + 700 };
    sample_begin(log, "many.log");
    for (int i = 0; i < QUERIES; i++) {
        const int pair = i % PAIRS;
        const double zero[] = {0, 0}, turn = i * 0.01 + pair;
        const double at[] = {(1.2 + pair % 7 * 0.1) * cos(turn), 1.2 * sin(turn)};
        const struct pair_query query =
            pair_of(sample_solid(1000 + pair / 3, 2, FMB_CUBOID, 1, zero),
                    sample_solid(2000 + pair, 2, FMB_TETRAHEDRON, 1, at), 0);
        if (i % 997 == 500)
            log->alter_pair = record_refused;
        sample_pair(log, &query);
        sample_wait(log, i == 4000 ? 86400 : 0.015);
    }
}

static void add_uneven_pair(struct sample_log *log, int64_t id)
{
    static const double at[] = {0, 0};
    const struct pair_query query = pair_of(sample_solid(id, 2, FMB_CUBOID, 1, at),
                                            sample_solid(id + 1, 2, FMB_CUBOID, 1, at), 1);
    sample_pair(log, &query);
}

/* Bodies 1 and 2 overlap always: queried 200 times at steps of 0.01 to 10.24 s, with the pair of 3
 * and 4 in between; not while that is queried 300 times; then in five bursts an hour apart. */
static void add_uneven(struct sample_log *log)
{
    sample_begin(log, "uneven.log");
    for (int i = 0; i < 200; i++) {
        add_uneven_pair(log, i % 3 == 2 ? 3 : 1);
        add_uneven_pair(log, 1);
        sample_wait(log, 0.01 * (1 << i * 7 % 11));
    }
    for (int i = 0; i < 300; i++) {
        add_uneven_pair(log, 3);
        sample_wait(log, 0.1);
    }
    for (int i = 0; i < 5 * 15; i++) {
        add_uneven_pair(log, 1);
        sample_wait(log, i % 15 == 14 ? 3600 : 0.1);
    }
}

/* A placement by handle takes 68 bytes. */
static void add_crowd(struct sample_log *log)
{
    enum { CROWD = 720 };
    static struct scene_query query;
    memset(&query, 0, sizeof query);
    sample_begin(log, "crowd.log");
    query.which = FMB_PAIRS_ALL;
    query.placement_count = CROWD;
    query.want = FMB_WANT_BOX;
    for (int i = 0; i < CROWD; i++) {
        const double at[] = {i % 14 * 0.9, i / 14 % 10 * 0.85, i / 140 * 1.0};
        query.placement[i] =
            sample_solid(i + 1, 3, i % 3 ? FMB_CUBOID : FMB_TETRAHEDRON, 0.8 + i % 5 * 0.1, at);
        sample_define(log, &query.placement[i]);
    }
    sample_scene(log, &query);
}

static void add_empty(struct sample_log *log)
{
    sample_begin(log, "");
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        void (*add)(struct sample_log *log);
    } pages[] = {{"mixed", add_mixed}, {"arm", add_arm},       {"many", add_many},
                 {"crowd", add_crowd}, {"uneven", add_uneven}, {"empty", add_empty}};
    for (size_t i = 0; argc == 2 && i < sizeof pages / sizeof *pages; i++) {
        struct sample_log log;
        if (strcmp(argv[1], pages[i].name) != 0)
            continue;
        pages[i].add(&log);
        return sample_end(&log, stdout) ? EXIT_SUCCESS : EXIT_FAILURE;
    }
    fprintf(stderr, "usage: make-page mixed|arm|many|crowd|uneven|empty > FILE\n");
    return 2;
}
