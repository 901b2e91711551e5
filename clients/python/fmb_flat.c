#include "fmb_flat.h"

#include "enclosure.h"
#include "fmb_client.h"
#include "frame_numbers.h"
#include "geometry.h"
#include "query.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int fmb_flat_abi(void)
{
    return FMB_FLAT_ABI;
}

/* ---- Bodies ---- */

/* Finishes a body, and frees it if there was an error. */
static int end_body(struct fmb_body *body, int status, const struct fmb_frame *frames, size_t count,
                    const struct fmb_body **out)
{
    if (status == FMB_OK)
        status = (int) fmb_body_make_frames(frames, count, body);
    if (status == FMB_OK)
        *out = body;
    else
        free(body);
    return status;
}

int fmb_flat_body_make(int dim, int shape, const double *numbers, size_t count,
                       const struct fmb_body **out)
{
    const struct geometry_shape of = geometry_shape(shape);
    const size_t before = of.has_radius && count > 0; /* the radius comes first */
    const size_t doubles =
        of.shape == FMB_HULL && dim > 0 ? fmb_hull_doubles(dim, count / (size_t) dim) : 0;
    struct fmb_frame frame;
    struct fmb_body *body = malloc(sizeof *body + doubles * sizeof(double));
    if (!body)
        return FMB_CLIENT_NO_MEMORY;
    double *vertices = (void *) (body + 1);
    const enum fmb_status status =
        frame_of_numbers(dim, of.shape, of.by_vertices, before ? numbers[0] : 0, numbers + before,
                         count - before, &vertices, &frame);
    return end_body(body, (int) status, &frame, 1, out);
}

int fmb_flat_body_join(const struct fmb_body *const *parts, size_t count,
                       const struct fmb_body **out)
{
    size_t total = 0;
    for (size_t i = 0; i < count; i++)
        total += parts[i]->frame_count;
    if (total > FMB_FRAMES_MAX)
        return FMB_OVER_LIMIT;
    struct fmb_body *body = malloc(sizeof *body + total * sizeof(struct fmb_frame));
    if (!body)
        return FMB_CLIENT_NO_MEMORY;
    struct fmb_frame *frames = (void *) (body + 1), *end = frames;
    for (size_t i = 0; i < count; i++)
        for (unsigned k = 0; k < parts[i]->frame_count; k++)
            *end++ = *fmb_body_frame(parts[i], k);
    return end_body(body, FMB_OK, frames, total, out);
}

void fmb_flat_body_free(const struct fmb_body *body)
{
    free((void *) body);
}

double fmb_flat_cylinder(double radius, double length, int sides, double *vertices)
{
    const struct cylinder cylinder = {.radius = radius, .length = length};
    return enclose_cylinder(&cylinder, sides, (double(*)[3]) vertices);
}

/* ---- Scenes ---- */

/* An array that grows. */
struct column {
    void *data;
    size_t capacity;
};

/* Columns of the answers. */
enum { PAIRS, VERDICTS, STATUSES, CONTACTS, BOXES, POINTS, GAPS, COLUMN_COUNT };

static const size_t column_width[COLUMN_COUNT] = {
    sizeof(unsigned[2]),   sizeof(unsigned char),          sizeof(int32_t),
    sizeof(double[2]),     sizeof(double[2][FMB_DIM_MAX]), sizeof(double[1 + FMB_DIM_MAX]),
    sizeof(struct fmb_gap)};

struct fmb_flat_scene {
    size_t placement_count;
    int dim;
    struct fmb_placement *placements;
    char *names;
    /* unsigned [][2]: indices of placements. own: the ignored pairs of fmb_flat_scene_make(). */
    struct column listed, ignored, own;
    size_t own_count;
    struct column memory; /* bytes: of a struct fmb_scene_state */
    /* For fmb_scene_again(): the last scene that was decided in `memory`, and its state; NULL if it
     * cannot be begun again. Only the first `moved` placements have changed since. */
    struct fmb_scene_state *state;
    struct fmb_scene begun;
    size_t moved;
    struct column column[COLUMN_COUNT];
    bool has[COLUMN_COUNT]; /* the last answers have this column */
    size_t count;           /* of the last answers */
    bool failed;            /* answers are missing: out of memory */
    char why[FMB_CLIENT_WHY_MAX];
};

static bool reserve(struct column *column, size_t count, size_t width)
{
    if (count <= column->capacity)
        return true;
    const size_t half_more = column->capacity + column->capacity / 2;
    const size_t capacity = count > half_more ? count : half_more;
    void *data = capacity < SIZE_MAX / width ? realloc(column->data, capacity * width) : NULL;
    if (!data)
        return false;
    column->data = data;
    column->capacity = capacity;
    return true;
}

/* Sets the text for a status, and returns the status. argument: NULL: none. */
static int refuse(struct fmb_flat_scene *scene, int status, const char *argument, size_t index)
{
    const char *text = fmb_client_status_text(status);
    if (argument)
        snprintf(scene->why, sizeof scene->why, "%s[%zu]: %s", argument, index, text);
    else
        snprintf(scene->why, sizeof scene->why, "%s", text);
    return status;
}

static int fill_scene(struct fmb_flat_scene *scene, const struct fmb_body *const *bodies,
                      const int64_t *ids, const int64_t *groups, const char *const *names)
{
    char *end = scene->names;
    for (size_t i = 0; i < scene->placement_count; i++) {
        struct fmb_placement *placement = &scene->placements[i];
        placement->body = bodies[i];
        placement->id = ids[i];
        placement->group = groups[i];
        if (placement->body->dim != scene->dim)
            return refuse(scene, FMB_DIMENSIONS_DIFFER, "bodies", i);
        if (!query_id_ok(ids[i]))
            return refuse(scene, FMB_BAD_ID, "ids", i);
        if (!names[i])
            continue;
        if (!query_name_ok(names[i]))
            return refuse(scene, FMB_BAD_NAME, "names", i);
        placement->name = strcpy(end, names[i]);
        end += strlen(names[i]) + 1;
    }
    return FMB_OK;
}

/* Converts indices of placements. */
static int convert(struct fmb_flat_scene *scene, struct column *column, const char *argument,
                   const int64_t *pairs, size_t count)
{
    if (!reserve(column, count, sizeof(unsigned[2])))
        return refuse(scene, FMB_CLIENT_NO_MEMORY, NULL, 0);
    unsigned *out = column->data;
    for (size_t i = 0; i < 2 * count; i++) {
        if ((uint64_t) pairs[i] >= scene->placement_count) {
            snprintf(scene->why, sizeof scene->why, "%s[%zu]: there is no body %" PRId64, argument,
                     i / 2, pairs[i]);
            return FMB_BAD_PAIR;
        }
        out[i] = (unsigned) pairs[i];
    }
    return FMB_OK;
}

int fmb_flat_scene_make(size_t count, const struct fmb_body *const *bodies, const int64_t *ids,
                        const int64_t *groups, const char *const *names, const int64_t *ignored,
                        size_t ignored_count, struct fmb_flat_scene **out)
{
    struct fmb_flat_scene *scene = calloc(1, sizeof *scene);
    if (!scene)
        return FMB_CLIENT_NO_MEMORY;
    *out = scene;
    if (count == 0 || count > INT_MAX)
        return refuse(scene, count ? FMB_OVER_LIMIT : FMB_NO_FRAMES, NULL, 0);
    size_t bytes = 1;
    for (size_t i = 0; i < count; i++)
        bytes += names[i] ? strlen(names[i]) + 1 : 0;
    scene->placement_count = count;
    scene->dim = bodies[0]->dim;
    scene->placements = calloc(count, sizeof *scene->placements);
    scene->names = malloc(bytes);
    if (!scene->placements || !scene->names)
        return refuse(scene, FMB_CLIENT_NO_MEMORY, NULL, 0);
    const int status = fill_scene(scene, bodies, ids, groups, names);
    scene->own_count = ignored_count;
    return status != FMB_OK ? status
                            : convert(scene, &scene->own, "ignored", ignored, ignored_count);
}

void fmb_flat_scene_free(struct fmb_flat_scene *scene)
{
    if (!scene)
        return;
    free(scene->placements);
    free(scene->names);
    free(scene->listed.data);
    free(scene->ignored.data);
    free(scene->own.data);
    free(scene->memory.data);
    for (int c = 0; c < COLUMN_COUNT; c++)
        free(scene->column[c].data);
    free(scene);
}

const char *fmb_flat_why(const struct fmb_flat_scene *scene)
{
    return scene->why;
}

/* The arrays of fmb_flat_place(). */
struct rows {
    const double *positions, *orientations, *velocities, *end_positions, *end_orientations;
};

static void set_orientation(const double *orientations, size_t i, int count, double out[4])
{
    memcpy(out, orientations + i * (size_t) count, (size_t) count * sizeof *out);
}

/* Sets the end of a placement whose other fields are set. A part of the end that was never set
 * equals the pose at the start. */
static void set_end(const struct rows *rows, size_t i, int dim, struct fmb_placement *out)
{
    const int turns = dim == 2 ? 2 : 4;
    if (out->end_count == 0) {
        memcpy(out->end_position, out->position, sizeof out->end_position);
        memset(out->velocity, 0, sizeof out->velocity);
    }
    if (out->end_count <= dim)
        memcpy(out->end_orientation, out->orientation, sizeof out->end_orientation);
    if (rows->end_positions)
        memcpy(out->end_position, rows->end_positions + i * (size_t) dim,
               (size_t) dim * sizeof(double));
    if (rows->end_orientations) {
        if (out->orientation_count == 0)
            out->orientation[0] = 1;
        out->orientation_count = turns;
        set_orientation(rows->end_orientations, i, turns, out->end_orientation);
    }
    out->end_count = dim + out->orientation_count;
}

/* Returns a placement with the pose, and with the velocity or the end, of row i of the arrays. */
static struct fmb_placement with_row(const struct fmb_flat_scene *scene, size_t placement, size_t i,
                                     const struct rows *rows)
{
    struct fmb_placement out = scene->placements[placement];
    const size_t dim = (size_t) scene->dim;
    if (rows->positions)
        memcpy(out.position, rows->positions + i * dim, dim * sizeof(double));
    if (rows->orientations) {
        out.orientation_count = dim == 2 ? 2 : 4;
        set_orientation(rows->orientations, i, out.orientation_count, out.orientation);
    }
    if (rows->velocities) {
        memcpy(out.velocity, rows->velocities + i * dim, dim * sizeof(double));
        memset(out.end_position, 0, sizeof out.end_position);
        memset(out.end_orientation, 0, sizeof out.end_orientation);
        out.end_count = 0;
    } else if (rows->end_positions || rows->end_orientations || out.end_count > 0) {
        set_end(rows, i, scene->dim, &out);
    }
    return out;
}

static bool is_finite(const double *vector)
{
    return isfinite(vector[0]) && isfinite(vector[1]) && isfinite(vector[2]);
}

static void set_moved(struct fmb_flat_scene *scene, size_t end)
{
    scene->moved = end > scene->moved ? end : scene->moved;
}

/* Returns the name of the array that makes the engine refuse a placement. */
static const char *wrong_array(const struct fmb_placement *placed)
{
    struct fmb_placement begin = *placed;
    begin.end_count = 0;
    return !is_finite(placed->position)            ? "positions"
           : !is_finite(placed->velocity)          ? "velocities"
           : fmb_placement_check(&begin) != FMB_OK ? "orientations"
           : !is_finite(placed->end_position)      ? "end_positions"
                                                   : "end_orientations";
}

int fmb_flat_place(struct fmb_flat_scene *scene, size_t first, size_t count,
                   const double *positions, const double *orientations, const double *velocities,
                   const double *end_positions, const double *end_orientations)
{
    const struct rows rows = {positions, orientations, velocities, end_positions, end_orientations};
    if (first > scene->placement_count || count > scene->placement_count - first)
        return refuse(scene, FMB_BAD_PAIR, "placements", first);
    if (velocities && (end_positions || end_orientations))
        return refuse(scene, FMB_WRONG_COUNT, "velocities", 0);
    for (size_t i = 0; i < count; i++) {
        const struct fmb_placement placed = with_row(scene, first + i, i, &rows);
        const enum fmb_status status = fmb_placement_check(&placed);
        if (status != FMB_OK)
            return refuse(scene, (int) status, wrong_array(&placed), i);
    }
    for (size_t i = 0; i < count; i++)
        scene->placements[first + i] = with_row(scene, first + i, i, &rows);
    set_moved(scene, first + count);
    return FMB_OK;
}

const struct fmb_placement *fmb_flat_placements(const struct fmb_flat_scene *scene)
{
    return scene->placements;
}

void fmb_flat_take(struct fmb_flat_scene *scene, const struct fmb_placement *from, size_t count)
{
    for (size_t i = 0; i < count && i < scene->placement_count; i++) {
        struct fmb_placement *to = &scene->placements[i];
        memcpy(to->position, from[i].position, sizeof to->position);
        memcpy(to->orientation, from[i].orientation, sizeof to->orientation);
        to->orientation_count = from[i].orientation_count;
        memcpy(to->end_position, from[i].end_position, sizeof to->end_position);
        memcpy(to->end_orientation, from[i].end_orientation, sizeof to->end_orientation);
        to->end_count = from[i].end_count;
    }
    set_moved(scene, count);
}

/* ---- Deciding ---- */

static bool reserve_answers(struct fmb_flat_scene *scene, size_t count)
{
    bool ok = true;
    for (int c = 0; c < COLUMN_COUNT; c++)
        ok = ok && (!scene->has[c] || reserve(&scene->column[c], count, column_width[c]));
    return ok;
}

/* Appends rows to the columns, which have space for them. from: [column], the rows. */
static void add_rows(struct fmb_flat_scene *scene, const void *const from[COLUMN_COUNT],
                     size_t count)
{
    for (int c = 0; c < COLUMN_COUNT; c++)
        if (scene->has[c] && count > 0)
            memcpy((char *) scene->column[c].data + scene->count * column_width[c], from[c],
                   count * column_width[c]);
    scene->count += count;
}

/* Whether the scene was decided last, and differs at most in its first placements. */
static bool is_again(const struct fmb_flat_scene *flat, const struct fmb_scene *scene)
{
    const struct fmb_scene *begun = &flat->begun;
    return flat->state && flat->moved < flat->placement_count &&
           begun->duration == scene->duration && begun->instant == scene->instant &&
           begun->want == scene->want && begun->margin == scene->margin &&
           begun->which == scene->which && begun->split == scene->split &&
           scene->which != FMB_PAIRS_LISTED && begun->ignored == scene->ignored &&
           begun->ignored_count == scene->ignored_count;
}

/* Begins a scene, or the last one again. */
static enum fmb_status begin(struct fmb_flat_scene *flat, const struct fmb_scene *scene,
                             struct fmb_scene_state **out)
{
    struct fmb_scene_limits limits;
    if (is_again(flat, scene)) {
        *out = flat->state;
        return fmb_scene_again(flat->state, flat->moved);
    }
    flat->state = NULL;
    fmb_scene_limits_of(scene, &limits);
    if (!reserve(&flat->memory, fmb_scene_bytes(&limits), 1))
        return (enum fmb_status) FMB_CLIENT_NO_MEMORY;
    return fmb_scene_begin(scene, &limits, flat->memory.data, out);
}

static int decide_steps(struct fmb_flat_scene *flat, const struct fmb_scene *scene)
{
    struct fmb_scene_state *state;
    struct fmb_scene_answers answers;
    const int status = (int) begin(flat, scene, &state);
    flat->state = NULL;
    for (bool done = status != FMB_OK; !done;) {
        done = fmb_scene_step(state, &answers);
        if (!reserve_answers(flat, flat->count + answers.count)) {
            fmb_scene_end(state);
            return FMB_CLIENT_NO_MEMORY;
        }
        const void *from[COLUMN_COUNT] = {answers.pairs,    answers.verdicts, NULL,
                                          answers.contacts, answers.boxes,    answers.points,
                                          answers.gaps};
        add_rows(flat, from, answers.count);
    }
    if (status == FMB_OK && scene->ignored == flat->own.data) {
        flat->state = state;
        flat->begun = *scene;
        flat->moved = 0;
    }
    return status;
}

/* An fmb_client_sink. If memory runs out, this answer and all later ones are dropped. */
static void append(void *user, const struct fmb_client_answer *of)
{
    struct fmb_flat_scene *scene = user;
    static const double none[2][FMB_DIM_MAX] = {{NAN, NAN, NAN}, {NAN, NAN, NAN}};
    static const struct fmb_gap no_gap = {.bounds = {NAN, NAN}};
    const struct fmb_answer *answer = &of->answer;
    const unsigned pair[2] = {of->a, of->b};
    const unsigned char verdict = (unsigned char) answer->verdict;
    const int32_t status = of->status;
    const void *const from[COLUMN_COUNT] = {pair,
                                            &verdict,
                                            &status,
                                            answer->has_contact ? answer->contact : none[0],
                                            answer->has_box ? answer->box : none,
                                            answer->has_point ? answer->point : none[0],
                                            answer->has_gap ? &answer->gap : &no_gap};
    scene->failed = scene->failed || !reserve_answers(scene, scene->count + 1);
    if (!scene->failed)
        add_rows(scene, from, 1);
}

/* Drops the last answers; the next ones have these columns. */
static void begin_answers(struct fmb_flat_scene *scene, bool pairs, bool statuses, unsigned want)
{
    scene->count = 0;
    scene->failed = false;
    scene->has[PAIRS] = pairs;
    scene->has[VERDICTS] = true;
    scene->has[STATUSES] = statuses;
    scene->has[CONTACTS] = want & FMB_WANT_TIMES;
    scene->has[BOXES] = want & FMB_WANT_BOX;
    scene->has[POINTS] = want & FMB_WANT_POINT;
    scene->has[GAPS] = want & FMB_WANT_GAP;
}

int fmb_flat_pair(struct fmb_flat_scene *scene, struct fmb_client *client, int64_t a, int64_t b,
                  double duration, unsigned want)
{
    const uint64_t count = scene->placement_count;
    struct fmb_client_answer answer = {.status = FMB_BAD_PAIR};
    begin_answers(scene, false, true, want | FMB_WANT_TIMES);
    if ((uint64_t) a < count && (uint64_t) b < count && a != b) {
        const struct fmb_placement pair[2] = {scene->placements[a], scene->placements[b]};
        if (client)
            fmb_client_query_pair(client, pair, duration, want, &answer);
        else
            answer.status = (int) fmb_decide(fmb_method_default(), &pair[0], &pair[1], duration,
                                             want, &answer.answer);
    }
    append(scene, &answer);
    if ((uint64_t) a >= count || (uint64_t) b >= count)
        snprintf(scene->why, sizeof scene->why, "there is no body %" PRId64,
                 (uint64_t) a >= count ? a : b);
    else if (answer.status != FMB_OK)
        snprintf(scene->why, sizeof scene->why, "%s",
                 client && answer.text ? answer.text : fmb_client_status_text(answer.status));
    return scene->failed ? refuse(scene, FMB_CLIENT_NO_MEMORY, NULL, 0) : answer.status;
}

/* Sets `ignored` to the given pairs and the ignored pairs of the scene. */
static int convert_ignored(struct fmb_flat_scene *flat, size_t own, const int64_t *pairs,
                           size_t count)
{
    int status = convert(flat, &flat->ignored, "ignored", pairs, count);
    if (status == FMB_OK && !reserve(&flat->ignored, own + count, sizeof(unsigned[2])))
        status = refuse(flat, FMB_CLIENT_NO_MEMORY, NULL, 0);
    if (status == FMB_OK && own > 0)
        memcpy((unsigned(*)[2]) flat->ignored.data + count, flat->own.data,
               own * sizeof(unsigned[2]));
    return status;
}

static int decide_on_bus(struct fmb_flat_scene *flat, struct fmb_client *client,
                         const struct fmb_scene *scene)
{
    const int status = fmb_client_query(client, scene, append, flat);
    if (status != FMB_OK)
        snprintf(flat->why, sizeof flat->why, "%s", fmb_client_why(client));
    return flat->failed ? refuse(flat, FMB_CLIENT_NO_MEMORY, NULL, 0) : status;
}

int fmb_flat_decide(struct fmb_flat_scene *flat, struct fmb_client *client, double duration,
                    int instant, unsigned want, double margin, int64_t split, const int64_t *pairs,
                    size_t pair_count, const int64_t *ignored, size_t ignored_count,
                    const char *label)
{
    begin_answers(flat, !pairs, client, margin > 0 ? want | FMB_WANT_GAP : want);
    if (label && !query_name_ok(label)) {
        snprintf(flat->why, sizeof flat->why, "label: %s", fmb_status_text(FMB_BAD_NAME));
        return FMB_BAD_NAME;
    }
    int status = convert(flat, &flat->listed, "pairs", pairs, pairs ? pair_count : 0);
    const size_t own = pairs ? 0 : flat->own_count, more = ignored ? ignored_count : 0;
    if (status == FMB_OK && more > 0)
        status = convert_ignored(flat, own, ignored, more);
    if (status != FMB_OK)
        return status;
    const struct fmb_scene scene = {.placements = flat->placements,
                                    .placement_count = flat->placement_count,
                                    .duration = duration,
                                    .instant = instant,
                                    .want = want,
                                    .margin = margin,
                                    .which = pairs        ? FMB_PAIRS_LISTED
                                             : split >= 0 ? FMB_PAIRS_ACROSS
                                                          : FMB_PAIRS_ALL,
                                    .split = !pairs && split >= 0 ? (size_t) split : 0,
                                    .pairs = flat->listed.data,
                                    .pair_count = pairs ? pair_count : 0,
                                    .ignored = more > 0 ? flat->ignored.data : flat->own.data,
                                    .ignored_count = own + more,
                                    .label = label};
    if (client)
        return decide_on_bus(flat, client, &scene);
    if (!is_again(flat, &scene)) /* fmb_scene_again() checks what moved */
        status = (int) fmb_scene_check(&scene, flat->why, sizeof flat->why);
    if (status == FMB_OK) {
        status = decide_steps(flat, &scene);
        if (status != FMB_OK)
            refuse(flat, status, NULL, 0);
    }
    return status;
}

int64_t fmb_flat_decide_all(struct fmb_flat_scene *scene, double duration, int instant,
                            unsigned want, double margin)
{
    const int status =
        fmb_flat_decide(scene, NULL, duration, instant, want, margin, -1, NULL, 0, NULL, 0, NULL);
    return status == FMB_OK ? (int64_t) scene->count : -1;
}

size_t fmb_flat_count(const struct fmb_flat_scene *scene)
{
    return scene->count;
}

/* Appends vectors of dim numbers of each answer to the doubles at *to. from: the first vector; rows
 * are stride bytes apart and have `vectors` vectors each. */
static void put(const struct fmb_flat_scene *scene, const void *from, size_t stride, int vectors,
                int dim, void **to)
{
    double *out = *to;
    for (size_t k = 0; k < scene->count; k++) {
        const double *row = (const void *) ((const char *) from + k * stride);
        for (int v = 0; v < vectors; v++, out += dim)
            memcpy(out, row + v * FMB_DIM_MAX, (size_t) dim * sizeof(double));
    }
    *to = out;
}

static void put_gaps(const struct fmb_flat_scene *scene, void **to)
{
    struct fmb_gap *gap = scene->column[GAPS].data;
    const int dim = scene->dim;
    for (size_t k = 0; k < scene->count; k++)
        if (!gap[k].has_witness) {
            gap[k].time = NAN;
            for (int i = 0; i < FMB_DIM_MAX; i++)
                gap[k].witness[0][i] = gap[k].witness[1][i] = NAN;
        }
    put(scene, gap->bounds, sizeof *gap, 1, 2, to);
    put(scene, gap->direction, sizeof *gap, 1, dim, to);
    put(scene, &gap->time, sizeof *gap, 1, 1, to);
    put(scene, gap->witness, sizeof *gap, 2, dim, to);
    int64_t *frames = *to;
    for (size_t k = 0; k < scene->count; k++)
        for (int i = 0; i < 2; i++)
            *frames++ = gap[k].frame[i];
    *to = frames;
}

void fmb_flat_pack(const struct fmb_flat_scene *scene, void *data)
{
    const size_t n = scene->count;
    const unsigned *pair = scene->column[PAIRS].data;
    int64_t *pairs = data;
    if (n == 0)
        return;
    for (size_t i = 0; scene->has[PAIRS] && i < 2 * n; i++)
        *pairs++ = pair[i];
    data = pairs;
    for (int c = CONTACTS; c < GAPS; c++)
        if (scene->has[c])
            put(scene, scene->column[c].data, column_width[c], c == BOXES ? 2 : 1,
                c == CONTACTS ? 2 : scene->dim + (c == POINTS), &data);
    if (scene->has[GAPS])
        put_gaps(scene, &data);
    if (scene->has[STATUSES])
        memcpy(data, scene->column[STATUSES].data, n * sizeof(int32_t));
    else
        memset(data, 0, n * sizeof(int32_t));
    memcpy((int32_t *) data + n, scene->column[VERDICTS].data, n);
}
