/* Any text, read as scenes: what is accepted is a scene, reads as the same when it is written, and
 * its pairs can be decided, in either order with the same answer; what is refused gets one line
 * that says why. */
#include "fuzz.h"

#include "answers.h"
#include "json.h"
#include "log_draft.h"
#include "query.h"
#include "same_scene.h"
#include "scene_json.h"
#include "utf8.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The scenes of an input that are checked. Of scenes with more pairs or frames none is decided. */
enum { SCENES_MAX = 8, DECIDED_PAIRS_MAX = 3, DECIDED_FRAMES_MAX = 6 };

/* ---- What a scene is ---- */

static bool is_finite(double value)
{
    return value - value == 0;
}

static bool finite_numbers(const double *number, int count)
{
    bool good = true;
    for (int i = 0; i < count; i++)
        good = good && is_finite(number[i]);
    return good;
}

static bool is_hull(const struct fmb_frame *frame)
{
    bool by_vertices;
    const size_t count = fmb_frame_numbers(frame, &by_vertices, NULL, 0);
    double *number = fuzz_room(count * sizeof *number);
    fmb_frame_numbers(frame, &by_vertices, number, count);
    const bool good = count > 0 && count <= (size_t) frame->dim * FMB_HULL_VERTICES_MAX &&
                      by_vertices && finite_numbers(number, (int) count);
    free(number);
    return good;
}

/* The origin of a box is computed, and may be infinite. */
static bool is_frame(const struct fmb_frame *frame, int dim)
{
    const int shape = (int) frame->shape;
    if (!is_finite(frame->radius) || frame->radius < 0)
        return false;
    if (shape == FMB_HULL)
        return frame->dim == dim && is_hull(frame);
    bool good = frame->dim == dim && shape >= FMB_CUBOID && shape <= FMB_BOX &&
                (dim == 3 || shape != FMB_FACE) && frame->count == (shape == FMB_FACE ? 2 : dim) &&
                finite_numbers(shape == FMB_BOX ? frame->centre : frame->origin, dim);
    for (int i = 0; i < frame->count; i++)
        good = good && finite_numbers(frame->component[i], dim);
    for (int axis = 0; axis < dim && shape == FMB_BOX; axis++)
        good = good && frame->component[axis][axis] >= 0;
    return good;
}

static bool is_orientation(const double *orientation, int count, int dim)
{
    bool turned = false;
    for (int i = 0; i < count; i++)
        turned = turned || orientation[i] != 0;
    return count == 0 ||
           (count == (dim == 2 ? 2 : 4) && turned && finite_numbers(orientation, count));
}

static bool is_end(const struct fmb_placement *placement, int dim)
{
    bool rests = true;
    for (int axis = 0; axis < dim; axis++)
        rests = rests && placement->velocity[axis] == 0;
    return placement->end_count == 0 ||
           (rests && placement->end_count == dim + placement->orientation_count &&
            finite_numbers(placement->end_position, dim) &&
            is_orientation(placement->end_orientation, placement->orientation_count, dim));
}

static bool is_name(const char *name)
{
    return !name || (*name && utf8_is_text(name));
}

static bool is_placement(const struct fmb_placement *placement, int dim)
{
    const struct fmb_body *body = placement->body;
    bool good = placement->id >= 1 && placement->id < INT64_C(1) << 53 &&
                is_name(placement->name) && body->dim == dim && body->frame_count >= 1 &&
                finite_numbers(placement->position, dim) &&
                finite_numbers(placement->velocity, dim) &&
                is_orientation(placement->orientation, placement->orientation_count, dim) &&
                is_end(placement, dim);
    for (unsigned i = 0; good && i < body->frame_count; i++)
        good = is_frame(fmb_body_frame(body, i), dim);
    return good;
}

static int compare_ids(const void *a, const void *b)
{
    const int64_t left = *(const int64_t *) a, right = *(const int64_t *) b;
    return (left > right) - (left < right);
}

static bool unique_ids(const struct fmb_scene *scene)
{
    bool unique = true;
    int64_t *id = fuzz_room(scene->placement_count * sizeof *id);
    for (size_t i = 0; i < scene->placement_count; i++)
        id[i] = scene->placements[i].id;
    if (scene->placement_count > 0)
        qsort(id, scene->placement_count, sizeof *id, compare_ids);
    for (size_t i = 1; i < scene->placement_count; i++)
        unique = unique && id[i - 1] < id[i];
    free(id);
    return unique;
}

static bool is_pair(const struct fmb_scene *scene, const unsigned pair[2])
{
    const size_t count = scene->placement_count;
    return pair[0] < count && pair[1] < count && pair[0] != pair[1];
}

static void check_pairs(struct owned_scene *owner)
{
    const struct fmb_scene *scene = &owner->scene;
    FUZZ_CHECK(scene->which == FMB_PAIRS_ALL
                   ? scene->pair_count == 0
                   : scene->which == FMB_PAIRS_LISTED && scene->ignored_count == 0);
    for (size_t i = 0; i < scene->pair_count; i++)
        FUZZ_CHECK(is_pair(scene, scene->pairs[i]) &&
                   !pair_is_within_group(scene, scene->pairs[i][0], scene->pairs[i][1]));
    for (size_t i = 0; i < scene->ignored_count; i++)
        FUZZ_CHECK(is_pair(scene, scene->ignored[i]) &&
                   scene_leaves_out(owner, scene->ignored[i][0], scene->ignored[i][1]));
}

static void check_scene(struct owned_scene *owner)
{
    const struct fmb_scene *scene = &owner->scene;
    FUZZ_CHECK(owner->dim == 2 || owner->dim == 3);
    FUZZ_CHECK(is_finite(scene->duration) && scene->duration >= 0);
    FUZZ_CHECK(is_finite(scene->margin) && scene->margin >= 0);
    for (size_t i = 0; i < scene->placement_count; i++)
        FUZZ_CHECK(is_placement(&scene->placements[i], owner->dim) &&
                   (scene->duration > 0 || scene->placements[i].end_count == 0));
    FUZZ_CHECK(unique_ids(scene));
    check_pairs(owner);
}

/* ---- Written and read again ---- */

/* The reader is that of another input. */
static void check_written(struct owned_scene *scene)
{
    char *text = NULL, path[LOG_DRAFT_PATH_MAX];
    size_t size = 0;
    struct owned_scene again;
    FILE *out = open_memstream(&text, &size);
    FUZZ_CHECK(out);
    scene_json_write(out, scene);
    FUZZ_CHECK(fclose(out) == 0);
    const int file = log_draft_file((const uint8_t *) text, size, path);
    struct json_reader *reader = json_open(file);
    FUZZ_CHECK(json_next(reader, &again) == JSON_SCENE);
    FUZZ_CHECK(same_scene(scene, &again));
    scene_clear(&again);
    FUZZ_CHECK(json_next(reader, &again) == JSON_END);
    json_close(reader);
    close(file);
    free(text);
}

/* ---- Decided ---- */

struct decided {
    const struct fmb_scene *scene;
    uint64_t count;
};

static void check_answer(void *user, const struct fmb_client_answer *of)
{
    struct decided *decided = user;
    const struct fmb_scene *scene = decided->scene;
    const unsigned want = FMB_WANT_BOX | FMB_WANT_POINT | (scene->margin > 0 ? FMB_WANT_GAP : 0);
    struct fmb_answer answer;
    const bool ends = scene->placements[of->a].end_count || scene->placements[of->b].end_count;
    decided->count++;
    FUZZ_CHECK(of->status == FMB_OK ? fmb_verdict_name((int) of->answer.verdict) != NULL
                                    : of->status == FMB_CANNOT_DECIDE && ends);
    FUZZ_CHECK((int) fmb_decide(fmb_method_default(), &scene->placements[of->b],
                                &scene->placements[of->a], scene->duration, want,
                                &answer) == of->status);
    if (of->status != FMB_OK)
        return;
    query_remove_far_gap(scene->margin, &answer);
    FUZZ_CHECK(query_same_answer(&of->answer, &answer));
}

static void check_decided(struct owned_scene *owner)
{
    struct fmb_scene *scene = &owner->scene;
    struct decided decided = {.scene = scene};
    uint64_t frames = 0;
    for (size_t i = 0; i < scene->placement_count; i++)
        frames += scene->placements[i].body->frame_count;
    if (scene_count_pairs(owner) > DECIDED_PAIRS_MAX || frames > DECIDED_FRAMES_MAX)
        return;
    scene->want = FMB_WANT_BOX | FMB_WANT_POINT;
    answers_local(owner, check_answer, &decided);
    FUZZ_CHECK(decided.count == scene_count_pairs(owner));
}

/* ---- Read ---- */

struct scenes {
    size_t count;
    struct owned_scene scene[SCENES_MAX];
    enum json_outcome outcome; /* that ended them */
    char error[512];
};

static void check_error(const char *error)
{
    FUZZ_CHECK(error[0] && strlen(error) < sizeof((struct scenes *) 0)->error);
    for (; *error; error++)
        FUZZ_CHECK(*error >= 0x20 && *error <= 0x7e);
}

static struct scenes read_scenes(const uint8_t *bytes, size_t size)
{
    char path[LOG_DRAFT_PATH_MAX];
    struct scenes out = {.outcome = JSON_SCENE};
    struct owned_scene beyond;
    const int file = log_draft_file(bytes, size, path);
    struct json_reader *reader = json_open(file);
    while (out.count < SCENES_MAX &&
           (out.outcome = json_next(reader, &out.scene[out.count])) == JSON_SCENE)
        out.count++;
    while (out.outcome == JSON_SCENE) {
        out.outcome = json_next(reader, &beyond);
        scene_clear(&beyond);
    }
    FUZZ_CHECK(out.outcome == JSON_BAD || (out.outcome == JSON_END && out.count > 0));
    if (out.outcome == JSON_BAD) {
        check_error(json_error(reader));
        strcpy(out.error, json_error(reader));
    }
    json_close(reader);
    close(file);
    return out;
}

static void clear_scenes(struct scenes *scenes)
{
    for (size_t i = 0; i < scenes->count; i++)
        scene_clear(&scenes->scene[i]);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct scenes scenes = read_scenes(data, size);
    for (size_t i = 0; i < scenes.count; i++) {
        check_scene(&scenes.scene[i]);
        check_written(&scenes.scene[i]);
        check_decided(&scenes.scene[i]);
    }
    clear_scenes(&scenes);
    return 0;
}
