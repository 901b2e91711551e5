/* Queries that the service refuses, for every reason that it has, and numbers at the ends of the
 * doubles, which it does not refuse. */
#include "kinds.h"

#include "log_client.h"
#include "parts.h"
#include "writer.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define COUNT(array) ((int) (sizeof(array) / sizeof(array)[0]))

/* Placements of nothing of which a scene is longer than one may be. */
enum { A_CLIENT = 1618033, TOO_LONG = 1050 };

static const double zero[3] = {0}, one[3] = {1, 1, 1}, half[3] = {0.5, 0.5, 0.5};

static const double tiny = 0x1p-1074; /* the least double there is */

struct refusing {
    struct instance *instance;
    int64_t next_number;
    struct scene_query scene;
    struct scene_result scene_result;
};

/* ---- Pairs that are wrong ---- */

/* Breaks one thing of a query that is good. */
typedef void spoil_pair(struct pair_query *query);

/* Any geometry: of so many frames of a shape, with so many numbers, all of them 1 but the first
 * dim. */
static void set_geometry(struct query_placement *placement, int32_t dim, int32_t frames, int shape,
                         int32_t numbers)
{
    static unsigned char bytes[16][256];
    static int next;
    struct writer writer = {.at = bytes[next], .end = bytes[next] + sizeof bytes[next]};
    const unsigned char *begin = bytes[next];
    next = (next + 1) % COUNT(bytes);
    writer_int32(&writer, dim);
    writer_int32(&writer, frames);
    for (int32_t i = 0; i < frames; i++)
        *writer_take(&writer, 1) = (unsigned char) shape;
    writer_int32(&writer, 0); /* counts */
    writer_int32(&writer, numbers);
    for (int32_t i = 0; i < numbers; i++)
        writer_double(&writer, i < dim ? 0 : 1);
    placement->body = (struct body_view){.dim = dim,
                                         .frame_count = frames,
                                         .number_count = numbers,
                                         .bytes = begin,
                                         .size = writer_end(&writer, begin)};
}

/* One of the numbers of a body of one frame. */
static void set_number(struct query_placement *placement, int i, double number)
{
    static unsigned char bytes[16][GEOMETRY_FRAME_BYTES_MAX];
    static int next;
    unsigned char *to = bytes[next];
    uint64_t bits;
    next = (next + 1) % COUNT(bytes);
    memcpy(&bits, &number, sizeof bits);
    memcpy(to, placement->body.bytes, placement->body.size);
    big_endian_put_64(to + 17 + 8 * i, bits);
    placement->body.bytes = to;
}

/* A handle that no service ever held. */
static const struct handle unheard = {{0xde, 0xad, 0xbe, 0xef}};

static void client_below_0(struct pair_query *query)
{
    query->client_id = -1;
}

static void client_too_large(struct pair_query *query)
{
    query->client_id = QUERY_ID_MAX + 1;
}

static void number_too_large(struct pair_query *query)
{
    query->sequence_number = INT64_MAX;
}

static void body_below_0(struct pair_query *query)
{
    query->placement[0].placed.id = INT64_MIN;
}

static void handle_and_frames(struct pair_query *query)
{
    query->placement[1].body.handle = unheard;
}

static void handle_and_numbers(struct pair_query *query)
{
    set_geometry(&query->placement[1], 3, 0, 0, 3);
    query->placement[1].body.handle = unheard;
}

static void neither_handle_nor_frames(struct pair_query *query)
{
    set_geometry(&query->placement[0], 3, 0, 0, 0);
}

static void no_shape(struct pair_query *query)
{
    set_geometry(&query->placement[0], 3, 1, 0, 12);
}

static void shape_5(struct pair_query *query)
{
    set_geometry(&query->placement[1], 3, 1, 99, 12);
}

static void dim_0(struct pair_query *query)
{
    set_geometry(&query->placement[0], 0, 1, FMB_CUBOID, 0);
}

static void face_in_plane(struct pair_query *query)
{
    set_geometry(&query->placement[1], 2, 1, FMB_FACE, 6);
}

static void numbers_11(struct pair_query *query)
{
    set_geometry(&query->placement[0], 3, 1, FMB_CUBOID, 11);
}

static void numbers_0(struct pair_query *query)
{
    set_geometry(&query->placement[1], 3, 1, FMB_CUBOID, 0);
}

static void numbers_of_face(struct pair_query *query)
{
    set_geometry(&query->placement[0], 3, 1, FMB_FACE, 12); /* which has 9 of them */
}

static void velocity_2(struct pair_query *query)
{
    query->placement[1].velocity_count = 2;
}

static void orientation_3(struct pair_query *query)
{
    query->placement[1].placed.orientation_count = 3;
}

static void position_nan(struct pair_query *query)
{
    query->placement[0].placed.position[2] = NAN;
}

static void component_infinite(struct pair_query *query)
{
    set_number(&query->placement[1], 3 + 4, -INFINITY);
}

static void velocity_infinite(struct pair_query *query)
{
    query->placement[0].velocity_count = 3;
    query->placement[0].placed.velocity[0] = INFINITY;
}

static void plane_and_space(struct pair_query *query)
{
    set_geometry(&query->placement[1], 2, 1, FMB_CUBOID, 6);
}

/* What later versions do. */
static void turned(struct pair_query *query)
{
    query->placement[0].placed.orientation_count = 4;
    query->placement[0].placed.orientation[0] = 1;
}

static void two_frames(struct pair_query *query)
{
    set_geometry(&query->placement[1], 3, 2, FMB_CUBOID, 24);
}

static void box_by_size(struct pair_query *query)
{
    set_geometry(&query->placement[0], 3, 1, 4, 6);
}

static void origin_not_0(struct pair_query *query)
{
    set_number(&query->placement[1], 1, 0.5);
}

static void duration_below_0(struct pair_query *query)
{
    query->duration = -tiny;
}

static void duration_nan(struct pair_query *query)
{
    query->duration = NAN;
}

static void duration_infinite(struct pair_query *query)
{
    query->duration = INFINITY;
}

static void method_5(struct pair_query *query)
{
    query->method = 5;
}

static void method_below_0(struct pair_query *query)
{
    query->method = INT32_MIN;
}

static void wants_times(struct pair_query *query)
{
    query->want = FMB_WANT_TIMES; /* which pairs always have */
}

static void wants_all(struct pair_query *query)
{
    query->want = -1;
}

static void wants_gap_of_fmb(struct pair_query *query)
{
    query->method = 2;
    query->want = FMB_WANT_GAP;
}

static void flat_for_fmb(struct pair_query *query)
{
    for (int axis = 0; axis < 3; axis++)
        set_number(&query->placement[0], 3 + 3 + axis, axis == 0);
    query->method = 2;
}

static void handle_not_held(struct pair_query *query)
{
    query->placement[0].placed.id = 1;
    part_by_handle(&query->placement[0], &unheard);
}

static void handle_without_id(struct pair_query *query)
{
    part_by_handle(&query->placement[1], &unheard);
}

static spoil_pair *const spoilt_pairs[] = {
    client_below_0,
    client_too_large,
    number_too_large,
    body_below_0,
    handle_and_frames,
    handle_and_numbers,
    neither_handle_nor_frames,
    no_shape,
    shape_5,
    dim_0,
    face_in_plane,
    numbers_11,
    numbers_0,
    numbers_of_face,
    velocity_2,
    orientation_3,
    position_nan,
    component_infinite,
    velocity_infinite,
    plane_and_space,
    turned,
    two_frames,
    box_by_size,
    origin_not_0,
    duration_below_0,
    duration_nan,
    duration_infinite,
    method_5,
    method_below_0,
    wants_times,
    wants_gap_of_fmb,
    wants_all,
    flat_for_fmb,
    handle_not_held,
    handle_without_id,
};

/* Two boxes that overlap by an eighth. */
static struct pair_query good_pair(struct refusing *refusing)
{
    struct pair_query query = {.client_id = A_CLIENT,
                               .sequence_number = refusing->next_number++,
                               .duration = 1,
                               .want = FMB_WANT_BOX};
    const struct solid a = part_box(3, zero, one), b = part_box(3, half, one);
    part_place(&a, 0, &query.placement[0]);
    part_place(&b, 0, &query.placement[1]);
    return query;
}

static void query_spoilt_pairs(struct refusing *refusing)
{
    for (int i = 0; i < COUNT(spoilt_pairs); i++) {
        struct pair_query query = good_pair(refusing);
        struct pair_result result;
        spoilt_pairs[i](&query);
        instance_query_pair(refusing->instance, &query, &result);
    }
}

/* ---- Scenes that are wrong ---- */

typedef void spoil_scene(struct scene_query *query);

static void which_3(struct scene_query *query)
{
    query->which = 3;
    query->index_count = 0;
}

static void split_of_listed(struct scene_query *query)
{
    query->split = 1;
}

static void split_too_far(struct scene_query *query)
{
    query->which = FMB_PAIRS_ACROSS;
    query->index_count = 0;
    query->split = query->placement_count + 1;
}

static void first_pair_too_far(struct scene_query *query)
{
    query->first_pair = query->index_count / 2 + 1;
}

static void first_pair_below_0(struct scene_query *query)
{
    query->first_pair = -1;
}

static void index_of_none(struct scene_query *query)
{
    query->pair[1][0] = (unsigned) query->placement_count;
}

static void index_below_0(struct scene_query *query)
{
    query->pair[1][1] = (unsigned) -1;
}

static void against_itself(struct scene_query *query)
{
    query->pair[0][0] = query->pair[0][1];
}

static void indices_odd(struct scene_query *query)
{
    query->index_count--;
}

static void indices_of_all(struct scene_query *query)
{
    query->which = FMB_PAIRS_ALL;
}

static void certificates(struct scene_query *query)
{
    query->want = FMB_WANT_CERTIFICATE;
}

static void all_by_sat(struct scene_query *query)
{
    query->which = FMB_PAIRS_ALL;
    query->index_count = 0;
    query->method = 3;
}

static void one_in_plane(struct scene_query *query)
{
    set_geometry(&query->placement[2], 2, 1, FMB_CUBOID, 6);
}

static void one_not_finite(struct scene_query *query)
{
    query->placement[3].placed.position[1] = NAN;
}

static void one_not_held(struct scene_query *query)
{
    query->placement[1].placed.id = 99;
    part_by_handle(&query->placement[1], &unheard);
}

static void margin_below_0(struct scene_query *query)
{
    query->margin = -1;
}

static void margin_for_sat(struct scene_query *query)
{
    query->method = 3;
    query->margin = 1;
}

static void gaps_of_fmb(struct scene_query *query)
{
    query->method = 2;
    query->want = FMB_WANT_GAP;
}

static void one_ignored(struct scene_query *query)
{
    query->ignored_count = 2;
    query->ignored[0][1] = 3;
}

static void ignored_odd(struct scene_query *query)
{
    query->ignored_count = 1;
}

static void time_runs_back(struct scene_query *query)
{
    query->duration = -1;
}

static void client_is_none(struct scene_query *query)
{
    query->client_id = INT64_MIN;
}

/* These three are not refused. */
static void nothing_listed(struct scene_query *query)
{
    query->index_count = 0;
}

static void first_pair_at_the_end(struct scene_query *query)
{
    query->first_pair = query->index_count / 2;
}

static void nothing_placed(struct scene_query *query)
{
    query->which = FMB_PAIRS_ALL;
    query->placement_count = query->index_count = 0;
}

static spoil_scene *const spoilt_scenes[] = {
    which_3,        split_of_listed, split_too_far,  first_pair_too_far,    first_pair_below_0,
    index_of_none,  index_below_0,   against_itself, indices_odd,           indices_of_all,
    certificates,   all_by_sat,      one_in_plane,   one_not_finite,        one_not_held,
    margin_below_0, margin_for_sat,  gaps_of_fmb,    one_ignored,           ignored_odd,
    time_runs_back, client_is_none,  nothing_listed, first_pair_at_the_end, nothing_placed,
};

/* Four boxes in a row that touch. */
static void set_good_scene(struct refusing *refusing)
{
    struct scene_query *query = &refusing->scene;
    memset(query, 0, sizeof *query);
    query->client_id = A_CLIENT;
    query->sequence_number = refusing->next_number++;
    query->duration = 1;
    query->which = FMB_PAIRS_LISTED;
    query->placement_count = 4;
    query->index_count = 2 * 3;
    for (int i = 0; i < 4; i++) {
        const struct solid box = part_box(3, (double[]){i, 0, 0}, one);
        part_place(&box, 0, &query->placement[i]);
    }
    for (unsigned i = 0; i < 3; i++) {
        query->pair[i][0] = i;
        query->pair[i][1] = i + 1;
    }
}

static void query_spoilt_scenes(struct refusing *refusing)
{
    for (int i = 0; i < COUNT(spoilt_scenes); i++) {
        set_good_scene(refusing);
        spoilt_scenes[i](&refusing->scene);
        instance_query_scene(refusing->instance, &refusing->scene, &refusing->scene_result);
    }
}

/* ---- Too much ---- */

/* A scene of so many placements of nothing: each is 65 bytes of 0, of no body and no dimension, but
 * for the length of its empty name. After the count of placements come those of indices and of
 * ignored ones, which are 0. */
static void query_placements_of_nothing(struct refusing *refusing, int32_t placements)
{
    enum { PLACEMENT = 65, NAME = 40, COUNTS = 12, LONGEST = QUERY_BYTES_MAX + 1000 };
    static unsigned char bytes[COUNTS + LONGEST];
    set_good_scene(refusing);
    nothing_placed(&refusing->scene);
    refusing->scene.utime = tape_utime(refusing->instance->tape);
    const size_t size = wire_write_scene_query(&refusing->scene, bytes),
                 more = PLACEMENT * (size_t) placements;
    memset(bytes + size, 0, more);
    big_endian_put_32(bytes + size - COUNTS, (uint32_t) placements);
    for (int32_t i = 0; i < placements; i++)
        bytes[size - COUNTS + 4 + PLACEMENT * (size_t) i + NAME + 3] = 1;
    instance_hear_scene(refusing->instance, bytes, size + more, &refusing->scene_result);
}

/* Four positions do not fit into a struct: the numbers that stand for two counts of 0 are the
 * fourth, and two more follow. */
static void query_in_four_dimensions(struct refusing *refusing)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    struct pair_query query = good_pair(refusing);
    struct pair_result result;
    set_geometry(&query.placement[1], 4, 1, FMB_CUBOID, 20);
    query.placement[1].body.dim = 3;
    query.utime = tape_utime(refusing->instance->tape);
    const size_t size = wire_write_pair_query(&query, bytes);
    memset(bytes + size, 0, 8);
    instance_hear_pair(refusing->instance, bytes, size + 8, &result);
}

/* ---- Definitions ---- */

/* Of a client without an id; from a place where there are no bodies; and two that cannot be read:
 * one is cut off, one has half a handle. */
static void query_spoilt_definitions(struct refusing *refusing)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    static struct definition_query query;
    static struct definition result;
    struct instance *instance = refusing->instance;
    query = (struct definition_query){.client_id = -1, .handle_count = 1, .handle = {unheard}};
    instance_hear_definition(instance, bytes, wire_write_definition_query(&query, bytes), &result);
    query.client_id = A_CLIENT;
    query.sequence_number = refusing->next_number++;
    query.first = 2;
    size_t size = wire_write_definition_query(&query, bytes);
    instance_hear_definition(instance, bytes, size, &result);
    instance_hear_definition(instance, bytes, size - 1, &result);
    size -= HANDLE_BYTES / 2;
    big_endian_put_32(bytes + size - HANDLE_BYTES / 2 - 4, HANDLE_BYTES / 2);
    instance_hear_definition(instance, bytes, size, &result);
}

/* ---- The ends of the doubles ---- */

/* Sizes of a box, and where the other one begins, which is as large. */
static const struct {
    double size, at, speed; /* 0: it does not move */
} extremes[] = {
    {1e300, 1e300, 0},
    {1e300, 0.5e300, 0},
    {1e-300, 1e-300, 0},
    {1e-300, 0, 1e300},
    {tiny, tiny, 0},
    {tiny, 2 * tiny, 0},
    {tiny, 0, tiny},
    {DBL_MIN, DBL_MIN, 0},
    {DBL_MAX, 0, 0},
    {DBL_MAX, DBL_MAX, -DBL_MAX},
    {1, DBL_MAX, -DBL_MAX},
    {1e-300, 1e300, -1e300},
    {DBL_MAX, -DBL_MAX, DBL_MAX},
    {1, -0.0, -0.0},
};

/* Each by every method that decides, as the doubles' ends let it. */
static void query_extremes(struct refusing *refusing)
{
    static const int32_t methods[] = {0, 1, 2, 3};
    for (int i = 0; i < COUNT(extremes); i++)
        for (int m = 0; m < COUNT(methods); m++) {
            struct pair_query query = good_pair(refusing);
            struct pair_result result;
            const double size = extremes[i].size, at = extremes[i].at, speed = extremes[i].speed;
            const struct solid a = part_box(3, zero, (double[]){size, size, size});
            struct solid b = part_corner(3, (double[]){at, 0, 0}, (double[]){size, size, size});
            b.moving = speed != 0 || signbit(speed);
            b.velocity[0] = speed;
            part_place(&a, 0, &query.placement[0]);
            part_place(&b, 0, &query.placement[1]);
            query.method = methods[m];
            query.duration = i % 3 == 2 ? 0.0 : 1;
            if (m < 1)
                query.want |= FMB_WANT_CERTIFICATE;
            instance_query_pair(refusing->instance, &query, &result);
        }
}

bool kind_refused(struct tape *tape)
{
    const struct instance_options options = {.prefix = "", .server_id = 1, .frames = 16};
    static struct refusing refusing;
    struct instance instance;
    if (!instance_open(&instance, tape, &options))
        return false;
    refusing = (struct refusing){.instance = &instance};
    query_spoilt_pairs(&refusing);
    query_spoilt_scenes(&refusing);
    query_in_four_dimensions(&refusing);
    query_placements_of_nothing(&refusing, QUERY_PLACEMENTS_MAX + 1);
    query_placements_of_nothing(&refusing, TOO_LONG); /* for a query, not yet for a datagram */
    query_spoilt_definitions(&refusing);
    query_extremes(&refusing);
    instance_beat(&instance);
    instance_close(&instance);
    return true;
}
