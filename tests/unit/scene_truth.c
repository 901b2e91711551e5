#include "scene_truth.h"

#include "big_endian.h"
#include "geometry_write.h"
#include "pair_draw.h"
#include "wire.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

void scene_set_placement(const struct solid *solid, int64_t body_id, unsigned char *bytes,
                         struct query_placement *out)
{
    struct plain_frame frame[SOLID_FRAMES_MAX];
    const int dim = solid->dim, count = solid_frames(solid);
    *out = (struct query_placement){.placed.id = body_id,
                                    .body.dim = dim,
                                    .body.frame_count = count,
                                    .placed.orientation_count = solid->orientation_count,
                                    .velocity_count = solid->moving ? dim : 0};
    for (int i = 0; i < count; i++) {
        double number[SOLID_NUMBERS_MAX];
        const struct solid one = solid_frame(solid, i);
        const int numbers = solid_numbers(&one, number);
        frame[i] = (struct plain_frame){.shape = (int) one.shape};
        memcpy(frame[i].origin, number, (size_t) dim * sizeof *number);
        memcpy(frame[i].components, number + dim, (size_t) (numbers - dim) * sizeof *number);
        out->body.number_count += numbers;
    }
    out->body = geometry_write_frames(dim, frame, count, bytes);
    memcpy(out->placed.position, solid->origin, (size_t) dim * sizeof(double));
    memcpy(out->placed.orientation, solid->orientation, sizeof out->placed.orientation);
    if (solid->moving)
        memcpy(out->placed.velocity, solid->velocity, (size_t) dim * sizeof(double));
}

void scene_set(struct scene *scene, int32_t i, const struct solid *solid, int64_t body_id)
{
    scene_set_placement(solid, body_id, scene->geometry[i], &scene->query.placement[i]);
}

void scene_put_number(struct scene *scene, int32_t i, int k, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    big_endian_put_64(scene->geometry[i] + 4 + 4 + 1 + 4 + 4 + 8 * k, bits);
}

void scene_name(struct query_placement *placement, const struct handle *handle)
{
    placement->body = geometry_named(placement->body.dim, handle);
}

/* Some are turned, by a quaternion of small whole numbers; some become a row of frames. */
static void pose(struct draw *draw, struct solid *solid)
{
    const int numbers = solid->dim == 2 ? 2 : 4;
    if (solid->orientation_count == 0 && draw_int(draw, 0, 3) == 0) {
        solid->orientation_count = numbers;
        draw_integers(draw, numbers == 4 ? 3 : 2, -2, 2, solid->orientation);
        solid->orientation[numbers - 1] = draw_int(draw, 1, 2);
    }
    if (solid_frames(solid) == 1 && draw_int(draw, 0, 3) == 0)
        solid->frames = draw_int(draw, 2, 4);
}

static bool is_finite_body(const struct solid *solid)
{
    for (int i = 0; i < solid_frames(solid); i++) {
        double number[SOLID_NUMBERS_MAX];
        const struct solid one = solid_frame(solid, i);
        for (int n = solid_numbers(&one, number); n-- > 0;)
            if (!isfinite(number[n]))
                return false;
    }
    return true;
}

static void set_posed(struct draw *draw, struct scene *scene, int32_t i, const struct solid *solid)
{
    struct solid posed = *solid;
    pose(draw, &posed);
    scene_set(scene, i, is_finite_body(&posed) ? &posed : solid, 0);
}

void scene_draw_placements(struct draw *draw, int dim, int moving, int32_t count, struct scene *out)
{
    out->query.placement_count = count;
    for (int32_t i = 0; i < count; i += 2) {
        struct cell cell;
        struct question question;
        do
            cell = pair_draw_cell(draw);
        while (cell.dim != dim || (moving >= 0 && cell.moving != (moving > 0)));
        (draw_int(draw, 0, 15) ? pair_draw : pair_draw_stretched)(draw, &cell, &question);
        set_posed(draw, out, i, &question.a);
        if (i + 1 < count)
            set_posed(draw, out, i + 1, &question.b);
    }
}

void scene_draw_pairs(struct draw *draw, int32_t count, struct scene_query *out)
{
    const int last = out->placement_count - 1;
    out->index_count = 2 * count;
    for (int32_t i = 0; i < count; i++) {
        unsigned *pair = out->pair[i];
        pair[0] = (unsigned) draw_int(draw, 0, last);
        pair[1] = pair[0] ^ 1;
        while (draw_coin(draw) || pair[1] == pair[0] || (int) pair[1] > last)
            pair[1] = (unsigned) draw_int(draw, 0, last);
    }
}

int32_t scene_list(const struct scene_query *query, const unsigned (**out)[2])
{
    static unsigned list[QUERY_PLACEMENTS_MAX * QUERY_PLACEMENTS_MAX / 2][2];
    const bool across = query->which == FMB_PAIRS_ACROSS;
    const int32_t split = query->split, n = query->placement_count;
    int32_t count = 0;
    *out = (const unsigned(*)[2]) list;
    if (query->which == FMB_PAIRS_LISTED) {
        *out = query->pair;
        return query->index_count / 2;
    }
    for (int32_t a = 0; a < (across ? split : n); a++)
        for (int32_t b = across ? split : a + 1; b < n; b++) {
            list[count][0] = (unsigned) a;
            list[count++][1] = (unsigned) b;
        }
    return count;
}

/* A body, its frames beside it. */
struct truth_body {
    struct fmb_frame frame[SOLID_FRAMES_MAX];
    struct fmb_body body;
};

static struct fmb_placement place(const struct query_placement *placement, struct truth_body *body)
{
    struct fmb_placement out = placement->placed;
    struct geometry_reader reader = geometry_begin(&placement->body);
    struct geometry_frame frame;
    size_t count = 0;
    out.body = &body->body;
    for (; geometry_next(&reader, &frame); count++) {
        double number[FMB_FRAME_NUMBERS_MAX];
        geometry_numbers(&frame, number);
        assert_int_equal(
            fmb_frame_make(reader.dim, frame.shape, number, frame.count, &body->frame[count]),
            FMB_OK);
    }
    assert_int_equal(fmb_body_make_frames(body->frame, count, &body->body), FMB_OK);
    return out;
}

static bool wants_gaps(const struct scene_query *query)
{
    return query->want & FMB_WANT_GAP || query->margin > 0;
}

enum fmb_status scene_decide(const struct scene_query *query, const unsigned pair[2],
                             struct fmb_answer *answer)
{
    static struct truth_body body[2];
    const struct fmb_placement a = place(&query->placement[pair[0]], &body[0]);
    const struct fmb_placement b = place(&query->placement[pair[1]], &body[1]);
    const unsigned want = FMB_WANT_BOX | FMB_WANT_POINT | (wants_gaps(query) ? FMB_WANT_GAP : 0);
    return fmb_decide(fmb_method_by_number(query->method), &a, &b, query->duration, want, answer);
}

/* ---- Answers ---- */

void scene_begin(struct answer_job *job, const struct scene_query *query)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    assert_null(answer_job_begin(job, ANSWER_SCENE, bytes, wire_write_scene_query(query, bytes)));
}

void scene_answer(struct answer_job *job, struct answerer *answerer,
                  const struct scene_query *query, struct scene_result *out)
{
    scene_begin(job, query);
    while (!answer_job_step(job, answerer))
        continue;
    *out = *answer_job_scene_result(job);
}

/* ---- A result, read from its beginning ---- */

struct reading {
    const struct scene_query *query;
    const struct scene_result *result;
    int32_t verdict, contact; /* the next ones */
};

static void assert_times(const struct reading *reading, const struct fmb_answer *answer)
{
    const double *times = &reading->result->times[2 * reading->contact];
    if (answer->has_contact)
        assert_memory_equal(times, answer->contact, sizeof answer->contact);
    else
        assert_true(isnan(times[0]) && isnan(times[1]));
}

static void assert_box(const struct reading *reading, const struct fmb_answer *answer)
{
    const int dim = reading->result->dim;
    const double *box = &reading->result->boxes[2 * dim * reading->contact];
    assert_true(answer->has_box);
    for (int side = 0; side < 2; side++)
        assert_memory_equal(box + side * dim, answer->box[side], (size_t) dim * sizeof *box);
}

static void assert_point(const struct reading *reading, const struct fmb_answer *answer)
{
    const int numbers = 1 + reading->result->dim;
    assert_true(answer->has_point);
    assert_memory_equal(&reading->result->points[numbers * reading->contact], answer->point,
                        (size_t) numbers * sizeof(double));
}

static bool is_near(const struct scene_query *query, const struct fmb_answer *answer)
{
    return query->margin > 0 && answer->verdict == FMB_SEPARATED &&
           answer->gap.bounds[0] <= query->margin;
}

static void assert_gap(const struct reading *reading, const struct fmb_answer *answer, bool close)
{
    const struct fmb_gap *gap = &reading->result->gap[reading->verdict];
    if (close || reading->query->want & FMB_WANT_GAP)
        assert_true(query_same_gap(gap, &answer->gap));
    else
        assert_true(isnan(gap->bounds[0]) && isnan(gap->bounds[1]));
}

static void assert_pair(struct reading *reading, const unsigned pair[2])
{
    const struct scene_result *result = reading->result;
    struct fmb_answer answer;
    scene_decide(reading->query, pair, &answer);
    const bool contact = answer.verdict >= FMB_TOUCHING;
    const bool near = is_near(reading->query, &answer);
    if (result->names_pairs && !contact && !near)
        return;
    if (result->has_gaps)
        assert_gap(reading, &answer, contact || near);
    assert_true(reading->verdict < result->verdict_count);
    if (result->names_pairs)
        assert_memory_equal(result->pair[reading->verdict], pair, sizeof result->pair[0]);
    assert_int_equal(result->verdict[reading->verdict++], answer.verdict);
    if (!contact)
        return;
    if (result->has_times)
        assert_times(reading, &answer);
    if (result->has_boxes)
        assert_box(reading, &answer);
    if (result->has_points)
        assert_point(reading, &answer);
    reading->contact++;
}

static bool is_ignored(const struct scene_query *query, const unsigned pair[2])
{
    const int64_t group = query->placement[pair[0]].placed.group;
    if (group != 0 && group == query->placement[pair[1]].placed.group)
        return true;
    for (int32_t i = 0; i < query->ignored_count / 2; i++) {
        const unsigned *ignored = query->ignored[i];
        if ((ignored[0] == pair[0] && ignored[1] == pair[1]) ||
            (ignored[0] == pair[1] && ignored[1] == pair[0]))
            return true;
    }
    return false;
}

void scene_assert(const struct scene_query *whole, const struct scene_result *result)
{
    struct reading reading = {whole, result, 0, 0};
    const struct fmb_method *method = fmb_method_by_number(whole->method);
    const unsigned(*pair)[2];
    const int32_t count = scene_list(whole, &pair);
    assert_string_equal(result->detail, "");
    assert_int_equal(result->status, FMB_OK);
    assert_int_equal(result->method, method->number);
    assert_int_equal(result->names_pairs, whole->which != FMB_PAIRS_LISTED);
    assert_int_equal(result->has_times, (whole->want & FMB_WANT_TIMES) != 0);
    assert_int_equal(result->has_boxes, whole->want & FMB_WANT_BOX && method->boxes);
    assert_int_equal(result->has_points, whole->want & FMB_WANT_POINT && method->certain);
    assert_int_equal(result->has_gaps, wants_gaps(whole));
    assert_true(whole->first_pair <= result->end_pair && result->end_pair <= count);
    assert_true(result->end_pair > whole->first_pair || whole->first_pair == count);
    for (int32_t i = whole->first_pair; i < result->end_pair; i++)
        if (!is_ignored(whole, pair[i]))
            assert_pair(&reading, pair[i]);
    assert_int_equal(reading.verdict, result->verdict_count);
    assert_int_equal(reading.contact, result->contact_count);
}
