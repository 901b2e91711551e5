/* Queries that the service refuses, for every reason that it has, and numbers at the ends of the
 * doubles, which it does not refuse. */
#include "kinds.h"

#include "asker.h"
#include "parts.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define COUNT(array) ((int) (sizeof(array) / sizeof(array)[0]))

/* Frames of nothing of which a scene is longer than one may be. */
enum { A_CLIENT = 1618033, TOO_LONG = 2031 };

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

static void set_count(struct query_numbers *numbers, int32_t count)
{
    numbers->count = count;
}

static void set_dim(struct query_frame *frame, int32_t dim)
{
    frame->dim = dim;
    set_count(&frame->origin, dim);
}

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
    query->frame[0].body_id = INT64_MIN;
}

static void key_too_large(struct pair_query *query)
{
    query->frame[1].key = QUERY_ID_MAX + 1;
}

static void no_shape(struct pair_query *query)
{
    query->frame[0].shape = 0;
}

static void shape_4(struct pair_query *query)
{
    query->frame[1].shape = 4;
}

static void dim_0(struct pair_query *query)
{
    set_dim(&query->frame[0], 0);
}

static void dim_4(struct pair_query *query)
{
    set_dim(&query->frame[1], 4);
}

static void face_in_plane(struct pair_query *query)
{
    set_dim(&query->frame[1], 2);
    query->frame[1].shape = FMB_FACE;
}

static void components_8(struct pair_query *query)
{
    set_count(&query->frame[0].components, 8);
}

static void components_0(struct pair_query *query)
{
    set_count(&query->frame[1].components, 0);
}

static void components_of_face(struct pair_query *query)
{
    query->frame[0].shape = FMB_FACE; /* which has 6 of them */
}

static void velocity_2(struct pair_query *query)
{
    set_count(&query->frame[1].velocity, 2);
}

static void origin_nan(struct pair_query *query)
{
    query->frame[0].origin.number[2] = NAN;
}

static void component_infinite(struct pair_query *query)
{
    query->frame[1].components.number[4] = -INFINITY;
}

static void velocity_infinite(struct pair_query *query)
{
    set_count(&query->frame[0].velocity, 3);
    query->frame[0].velocity.number[0] = INFINITY;
}

static void plane_and_space(struct pair_query *query)
{
    set_dim(&query->frame[1], 2);
    set_count(&query->frame[1].components, 4);
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
    query->want = QUERY_WANT_TIMES; /* which pairs always have */
}

static void wants_all(struct pair_query *query)
{
    query->want = -1;
}

static void flat_for_fmb(struct pair_query *query)
{
    memcpy(&query->frame[0].components.number[3], query->frame[0].components.number,
           3 * sizeof(double));
    query->method = 2;
}

static void key_never_told(struct pair_query *query)
{
    query->frame[0].body_id = 1;
    query->frame[0].key = 123456789;
    set_count(&query->frame[0].components, 0);
}

static void key_of_nobody(struct pair_query *query)
{
    query->frame[1].key = 3;
    set_count(&query->frame[1].components, 0);
}

static spoil_pair *const spoilt_pairs[] = {
    client_below_0,
    client_too_large,
    number_too_large,
    body_below_0,
    key_too_large,
    no_shape,
    shape_4,
    dim_0,
    dim_4,
    face_in_plane,
    components_8,
    components_0,
    components_of_face,
    velocity_2,
    origin_nan,
    component_infinite,
    velocity_infinite,
    plane_and_space,
    duration_below_0,
    duration_nan,
    duration_infinite,
    method_5,
    method_below_0,
    wants_times,
    wants_all,
    flat_for_fmb,
    key_never_told,
    key_of_nobody,
};

/* Two boxes that overlap by an eighth. */
static struct pair_query good_pair(struct refusing *refusing)
{
    struct pair_query query = {.client_id = A_CLIENT,
                               .sequence_number = refusing->next_number++,
                               .duration = 1,
                               .want = QUERY_WANT_BOX};
    const struct solid a = part_box(3, zero, one), b = part_box(3, half, one);
    part_frame(&a, 0, &query.frame[0]);
    part_frame(&b, 0, &query.frame[1]);
    return query;
}

static void ask_spoilt_pairs(struct refusing *refusing)
{
    for (int i = 0; i < COUNT(spoilt_pairs); i++) {
        struct pair_query query = good_pair(refusing);
        struct pair_result result;
        spoilt_pairs[i](&query);
        instance_ask_pair(refusing->instance, &query, &result);
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
    query->which = QUERY_PAIRS_ACROSS;
    query->index_count = 0;
    query->split = query->frame_count + 1;
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
    query->pair[1][0] = (unsigned) query->frame_count;
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
    query->which = QUERY_PAIRS_ALL;
}

static void certificates(struct scene_query *query)
{
    query->want = QUERY_WANT_CERTIFICATE;
}

static void all_by_sat(struct scene_query *query)
{
    query->which = QUERY_PAIRS_ALL;
    query->index_count = 0;
    query->method = 3;
}

static void one_in_plane(struct scene_query *query)
{
    set_dim(&query->frame[2], 2);
    set_count(&query->frame[2].components, 4);
}

static void one_not_finite(struct scene_query *query)
{
    query->frame[3].origin.number[1] = NAN;
}

static void one_unknown(struct scene_query *query)
{
    query->frame[1].body_id = 99;
    query->frame[1].key = 99;
    set_count(&query->frame[1].components, 0);
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

static void no_frames(struct scene_query *query)
{
    query->which = QUERY_PAIRS_ALL;
    query->frame_count = query->index_count = 0;
}

static spoil_scene *const spoilt_scenes[] = {
    which_3,        split_of_listed, split_too_far,  first_pair_too_far,    first_pair_below_0,
    index_of_none,  index_below_0,   against_itself, indices_odd,           indices_of_all,
    certificates,   all_by_sat,      one_in_plane,   one_not_finite,        one_unknown,
    time_runs_back, client_is_none,  nothing_listed, first_pair_at_the_end, no_frames,
};

/* Four boxes in a row that touch. */
static void set_good_scene(struct refusing *refusing)
{
    struct scene_query *query = &refusing->scene;
    memset(query, 0, sizeof *query);
    query->client_id = A_CLIENT;
    query->sequence_number = refusing->next_number++;
    query->duration = 1;
    query->which = QUERY_PAIRS_LISTED;
    query->frame_count = 4;
    query->index_count = 2 * 3;
    for (int i = 0; i < 4; i++) {
        const struct solid box = part_box(3, (double[]){i, 0, 0}, one);
        part_frame(&box, 0, &query->frame[i]);
    }
    for (unsigned i = 0; i < 3; i++) {
        query->pair[i][0] = i;
        query->pair[i][1] = i + 1;
    }
}

static void ask_spoilt_scenes(struct refusing *refusing)
{
    for (int i = 0; i < COUNT(spoilt_scenes); i++) {
        set_good_scene(refusing);
        spoilt_scenes[i](&refusing->scene);
        instance_ask_scene(refusing->instance, &refusing->scene, &refusing->scene_result);
    }
}

/* ---- Too much ---- */

static void write_count(int32_t count, unsigned char out[4])
{
    for (int i = 0; i < 4; i++)
        out[i] = (unsigned char) ((uint32_t) count >> (24 - 8 * i));
}

/* A scene of so many frames of nothing: each is 32 bytes of 0, of no shape and no dimension. What
 * stands behind the number of frames is the number of indices, which is 0. */
static void ask_frames_of_nothing(struct refusing *refusing, int32_t frames)
{
    enum { FRAME = 32, COUNTS = 8, LONGEST = QUERY_BYTES_MAX + 1000 };
    static unsigned char bytes[COUNTS + LONGEST];
    set_good_scene(refusing);
    no_frames(&refusing->scene);
    refusing->scene.utime = tape_utime(refusing->instance->tape);
    const size_t size = wire_write_scene_query(&refusing->scene, bytes),
                 more = FRAME * (size_t) frames;
    memset(bytes + size, 0, more);
    write_count(frames, bytes + size - COUNTS);
    instance_hear_scene(refusing->instance, bytes, size + more, &refusing->scene_result);
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
static void ask_extremes(struct refusing *refusing)
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
            part_frame(&a, 0, &query.frame[0]);
            part_frame(&b, 0, &query.frame[1]);
            query.method = methods[m];
            query.duration = i % 3 == 2 ? 0.0 : 1;
            if (m < 1)
                query.want |= QUERY_WANT_CERTIFICATE;
            instance_ask_pair(refusing->instance, &query, &result);
        }
}

bool kind_refused(struct tape *tape)
{
    const struct instance_options options = {
        .prefix = "", .server_id = 1, .first_key = 1000, .bodies = 16};
    static struct refusing refusing;
    struct instance instance;
    if (!instance_open(&instance, tape, &options))
        return false;
    refusing = (struct refusing){.instance = &instance};
    ask_spoilt_pairs(&refusing);
    ask_spoilt_scenes(&refusing);
    ask_frames_of_nothing(&refusing, QUERY_FRAMES_MAX + 1);
    ask_frames_of_nothing(&refusing, TOO_LONG); /* for a query, not yet for a datagram */
    ask_extremes(&refusing);
    instance_beat(&instance);
    instance_close(&instance);
    return true;
}
