/* Any text, read as scenes: what is accepted is a scene, printed it reads as the same, and its
 * pairs can be decided, either way round with the same answer; what is refused gets one line that
 * says why. In which pieces the text comes makes no difference. */
#include "fuzz.h"

#include "answers.h"
#include "json.h"
#include "number.h"
#include "pieces.h"
#include "same.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of an input so many scenes are looked at; of larger scenes no pair is decided. */
enum { SCENES_MAX = 8, DECIDED_PAIRS_MAX = 3 };

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

static bool is_body(const struct scene_body *body, int dim)
{
    const int shape = (int) body->body.shape;
    bool good = body->id >= 1 && body->id < INT64_C(1) << 53 && body->body.dim == dim &&
                shape >= FMB_CUBOID && shape <= (dim == 2 ? FMB_TETRAHEDRON : FMB_FACE) &&
                body->body.count == (shape == FMB_FACE ? 2 : dim) &&
                finite_numbers(body->origin, dim) && finite_numbers(body->velocity, dim);
    for (int i = 0; i < body->body.count; i++)
        good = good && finite_numbers(body->body.component[i], dim);
    for (int axis = 0; axis < dim && !body->moving; axis++)
        good = good && body->velocity[axis] == 0;
    return good;
}

static int compare_ids(const void *a, const void *b)
{
    const int64_t left = *(const int64_t *) a, right = *(const int64_t *) b;
    return (left > right) - (left < right);
}

static bool unique_ids(const struct scene *scene)
{
    bool unique = true;
    int64_t *id = fuzz_room(scene->body_count * sizeof *id);
    for (size_t i = 0; i < scene->body_count; i++)
        id[i] = scene->body[i].id;
    if (scene->body_count > 0)
        qsort(id, scene->body_count, sizeof *id, compare_ids);
    for (size_t i = 1; i < scene->body_count; i++)
        unique = unique && id[i - 1] < id[i];
    free(id);
    return unique;
}

static void check_scene(const struct scene *scene)
{
    FUZZ_CHECK(scene->dim == 2 || scene->dim == 3);
    FUZZ_CHECK(is_finite(scene->duration) && scene->duration >= 0);
    for (size_t i = 0; i < scene->body_count; i++)
        FUZZ_CHECK(is_body(&scene->body[i], scene->dim));
    FUZZ_CHECK(unique_ids(scene));
    FUZZ_CHECK(!scene->all_pairs || scene->pair_count == 0);
    for (size_t i = 0; i < scene->pair_count; i++) {
        const struct scene_pair pair = scene->pair[i];
        FUZZ_CHECK(pair.a < scene->body_count && pair.b < scene->body_count && pair.a != pair.b);
    }
}

/* ---- The same scene ---- */

static bool same_body(const struct scene_body *a, const struct scene_body *b)
{
    const size_t axes = FMB_DIM_MAX;
    bool same = a->id == b->id && a->moving == b->moving && a->body.dim == b->body.dim &&
                a->body.shape == b->body.shape && same_doubles(a->origin, b->origin, axes) &&
                same_doubles(a->velocity, b->velocity, axes);
    for (int i = 0; i < FMB_DIM_MAX; i++)
        same = same && same_doubles(a->body.component[i], b->body.component[i], axes);
    return same;
}

static bool same_scene(const struct scene *a, const struct scene *b)
{
    bool same = a->dim == b->dim && same_doubles(&a->duration, &b->duration, 1) &&
                a->body_count == b->body_count && a->all_pairs == b->all_pairs &&
                a->pair_count == b->pair_count;
    for (size_t i = 0; same && i < a->body_count; i++)
        same = same_body(&a->body[i], &b->body[i]);
    for (size_t i = 0; same && i < a->pair_count; i++)
        same = a->pair[i].a == b->pair[i].a && a->pair[i].b == b->pair[i].b;
    return same;
}

/* ---- Printed and read again ---- */

struct text {
    char *at;
    size_t used;
};

/* Of a body: four keys and an id, and 15 numbers. */
enum { BODY_BYTES = 160 + 16 * NUMBER_TEXT_MAX, PAIR_BYTES = 2 * NUMBER_TEXT_MAX };

static void print(struct text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void print(struct text *text, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    text->used += (size_t) vsprintf(text->at + text->used, format, list);
    va_end(list);
}

static void print_vector(struct text *text, const double *number, int dim)
{
    char room[NUMBER_TEXT_MAX];
    for (int axis = 0; axis < dim; axis++)
        print(text, "%s%s", axis ? "," : "[", number_exact(number[axis], room));
    print(text, "]");
}

static void print_body(struct text *text, const struct scene_body *body)
{
    print(text, "{\"id\":%" PRId64 ",\"shape\":\"%s\",\"origin\":", body->id,
          fmb_shape_name((int) body->body.shape));
    print_vector(text, body->origin, body->body.dim);
    for (int i = 0; i < body->body.count; i++) {
        print(text, i ? "," : ",\"components\":[");
        print_vector(text, body->body.component[i], body->body.dim);
    }
    print(text, "]");
    if (body->moving) {
        print(text, ",\"velocity\":");
        print_vector(text, body->velocity, body->body.dim);
    }
    print(text, "}");
}

static struct text print_scene(const struct scene *scene)
{
    char room[NUMBER_TEXT_MAX];
    struct text text = {
        .at = fuzz_room(256 + scene->body_count * BODY_BYTES + scene->pair_count * PAIR_BYTES)};
    print(&text, "{\"dim\":%d,\"duration\":%s,\"bodies\":[", scene->dim,
          number_exact(scene->duration, room));
    for (size_t i = 0; i < scene->body_count; i++) {
        print(&text, "%s", i ? "," : "");
        print_body(&text, &scene->body[i]);
    }
    print(&text, scene->all_pairs ? "]" : "],\"pairs\":[");
    for (size_t i = 0; i < scene->pair_count; i++)
        print(&text, "%s[%" PRId64 ",%" PRId64 "]", i ? "," : "", scene->body[scene->pair[i].a].id,
              scene->body[scene->pair[i].b].id);
    print(&text, scene->all_pairs ? "}" : "]}");
    return text;
}

/* The reader is that of another input. */
static void check_printed(const struct scene *scene)
{
    struct text text = print_scene(scene);
    struct scene again;
    pieces_begin((const uint8_t *) text.at, text.used, text.used);
    struct json_reader *reader = json_open(-1);
    FUZZ_CHECK(json_next(reader, &again) == JSON_SCENE);
    FUZZ_CHECK(same_scene(scene, &again));
    scene_clear(&again);
    FUZZ_CHECK(json_next(reader, &again) == JSON_END);
    json_close(reader);
    free(text.at);
}

/* ---- Decided ---- */

static bool same_answer(const struct fmb_answer *a, const struct fmb_answer *b)
{
    return a->verdict == b->verdict && a->has_contact == b->has_contact &&
           a->has_box == b->has_box && same_doubles(a->contact, b->contact, 2) &&
           same_doubles(a->box[0], b->box[0], FMB_DIM_MAX) &&
           same_doubles(a->box[1], b->box[1], FMB_DIM_MAX);
}

static void check_outcome(void *user, const struct scene *scene, const struct outcome *outcome)
{
    const struct fmb_pair pair = scene_fmb_pair(scene, outcome->pair);
    const struct fmb_pair turned = {pair.b, pair.a, pair.duration};
    struct fmb_answer answer;
    uint64_t *count = user;
    ++*count;
    FUZZ_CHECK(!outcome->error && fmb_verdict_name((int) outcome->answer.verdict));
    FUZZ_CHECK(fmb_decide(fmb_method_default(), &turned, FMB_WANT_BOX, &answer) == FMB_OK);
    FUZZ_CHECK(same_answer(&outcome->answer, &answer));
}

static void check_decided(const struct scene *scene)
{
    const struct answers_question question = {.box = true};
    uint64_t count = 0;
    if (scene_count_pairs(scene) > DECIDED_PAIRS_MAX)
        return;
    answers_local(&question, scene, check_outcome, &count);
    FUZZ_CHECK(count == scene_count_pairs(scene));
}

/* ---- Read ---- */

struct scenes {
    size_t count;
    struct scene scene[SCENES_MAX];
    enum json_outcome outcome; /* that ended them */
    char error[512];
};

static void check_error(const char *error)
{
    FUZZ_CHECK(error[0] && strlen(error) < sizeof((struct scenes *) 0)->error);
    for (; *error; error++)
        FUZZ_CHECK(*error >= 0x20 && *error <= 0x7e);
}

static struct scenes read_scenes(const uint8_t *bytes, size_t size, size_t piece)
{
    struct scenes out = {.outcome = JSON_SCENE};
    struct scene beyond;
    pieces_begin(bytes, size, piece);
    struct json_reader *reader = json_open(-1);
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
    return out;
}

static void clear_scenes(struct scenes *scenes)
{
    for (size_t i = 0; i < scenes->count; i++)
        scene_clear(&scenes->scene[i]);
}

static void check_same(const struct scenes *a, const struct scenes *b)
{
    FUZZ_CHECK(a->count == b->count && a->outcome == b->outcome);
    FUZZ_CHECK(strcmp(a->error, b->error) == 0);
    for (size_t i = 0; i < a->count; i++)
        FUZZ_CHECK(same_scene(&a->scene[i], &b->scene[i]));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint8_t *bytes = fuzz_copy(data, size);
    struct scenes scenes = read_scenes(bytes, size, size + 1);
    struct scenes pieces = read_scenes(bytes, size, 1 + size % 7);
    check_same(&scenes, &pieces);
    for (size_t i = 0; i < scenes.count; i++) {
        check_scene(&scenes.scene[i]);
        check_printed(&scenes.scene[i]);
        check_decided(&scenes.scene[i]);
    }
    clear_scenes(&scenes);
    clear_scenes(&pieces);
    free(bytes);
    return 0;
}
