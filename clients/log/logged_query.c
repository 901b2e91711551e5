#include "logged_query.h"

#include "allocate.h"
#include "scene.h"
#include "wire.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

const char *logged_query_read(struct logged_query *out, enum log_kind kind,
                              const unsigned char *bytes, uint32_t size)
{
    const bool pair = kind == LOG_PAIR_QUERY;
    const bool whole = size <= QUERY_BYTES_MAX;
    if (!whole)
        memset(out, 0, sizeof *out);
    out->kind = kind;
    const char *error = pair && whole ? wire_read_pair_query(bytes, size, &out->pair)
                        : pair        ? wire_read_pair_header(bytes, size, &out->header)
                        : whole       ? wire_read_scene_query(bytes, size, &out->scene)
                                      : wire_read_scene_header(bytes, size, &out->header);
    out->placement = pair ? out->pair.placement : out->scene.placement;
    out->placement_count = error ? 0 : pair ? 2 : query_stored_placements(&out->scene);
    return error;
}

const char *logged_result_read(struct logged_result *out, enum log_kind kind, const void *bytes,
                               uint32_t size)
{
    out->kind = kind;
    return kind == LOG_PAIR_QUERY ? wire_read_pair_result(bytes, size, &out->pair)
                                  : wire_read_scene_result(bytes, size, &out->scene);
}

bool logged_status_is_transient(int32_t status)
{
    return status == FMB_BUSY || status == FMB_UNKNOWN_BODY;
}

static bool is_whole(const struct logged_query *query)
{
    const struct scene_query *scene = &query->scene;
    for (int32_t i = 0; i < query->placement_count; i++)
        if (query->placement[i].body.dim > FMB_DIM_MAX ||
            query->placement[i].placed.orientation_count > QUERY_ORIENTATION_MAX ||
            query->placement[i].velocity_count > FMB_DIM_MAX ||
            query->placement[i].placed.end_count >
                query->placement[i].body.dim + QUERY_ORIENTATION_MAX)
            return false;
    return query->kind == LOG_PAIR_QUERY || (scene->placement_count <= QUERY_PLACEMENTS_MAX &&
                                             scene->index_count <= 2 * QUERY_PAIRS_MAX &&
                                             scene->ignored_count <= 2 * QUERY_PAIRS_MAX);
}

static size_t bytes_of(const struct logged_query *query)
{
    const bool pair = query->kind == LOG_PAIR_QUERY;
    size_t bytes =
        pair ? WIRE_PAIR_QUERY_BYTES : WIRE_SCENE_QUERY_BYTES + wire_text_bytes(query->scene.label);
    for (int32_t i = 0; i < query->placement_count; i++)
        bytes += wire_placement_bytes(&query->placement[i]);
    if (!pair)
        bytes += WIRE_PAIR_BYTES / 2 *
                 ((size_t) query->scene.index_count + (size_t) query->scene.ignored_count);
    return bytes;
}

size_t logged_query_write(const struct logged_query *query, unsigned char out[QUERY_BYTES_MAX])
{
    if (!is_whole(query) || bytes_of(query) > QUERY_BYTES_MAX)
        return 0;
    return query->kind == LOG_PAIR_QUERY ? wire_write_pair_query(&query->pair, out)
                                         : wire_write_scene_query(&query->scene, out);
}

/* ---- As a scene: bodies ---- */

const struct fmb_body *body_of_view(const struct body_view *view, struct owned_scene *out)
{
    struct geometry_reader reader = geometry_begin(view);
    struct geometry_frame frame;
    struct given_frame *given = scene_alloc(out, (size_t) view->frame_count, sizeof *given);
    const struct fmb_body *body;
    size_t count = 0, bad;
    for (; geometry_next(&reader, &frame); count++) {
        double *numbers = scene_alloc(out, frame.count, sizeof *numbers);
        geometry_numbers(&frame, numbers);
        given[count] = (struct given_frame){frame.shape, frame.by_vertices, frame.count, numbers,
                                            frame.radius};
    }
    out->dim = view->dim;
    return reader.frames_left == 0 && reader.counts_left == 0 && reader.numbers_left == 0 &&
                   scene_make_body(out, given, count, &body, &bad) == FMB_OK
               ? body
               : NULL;
}

bool scene_takes(const struct body_view *view)
{
    struct owned_scene scene = {.dim = 0};
    const bool taken = body_of_view(view, &scene);
    scene_clear(&scene);
    return taken;
}

/* Returns a copy of a name or a label; NULL if a scene cannot have it. */
static const char *copy_text(const char *text, struct owned_scene *out)
{
    return text && query_name_ok(text) ? scene_text(out, text) : NULL;
}

/* grouped: whether the placements keep their groups. */
static void set_bodies(const struct logged_query *query, bool grouped, struct owned_scene *scene)
{
    const struct query_placement *placement = query->placement;
    const size_t count = (size_t) query->placement_count;
    struct fmb_placement *out = scene_alloc(scene, count, sizeof *out);
    scene->dim = FMB_DIM_MAX;
    for (size_t i = 0; i < count; i++) {
        out[i] = placement[i].placed;
        out[i].body = body_of_view(&placement[i].body, scene);
        assert(out[i].body);
        out[i].group = grouped ? out[i].group : 0;
        out[i].name = copy_text(out[i].name, scene);
    }
    scene_free_ids(out, count, true);
    scene->scene.placements = out;
    scene->scene.placement_count = count;
}

/* ---- As a scene: pairs ---- */

/* Lists the pairs of ALL or ACROSS from first_pair on that are not left out. */
static void list_pairs(const struct scene_query *query, struct owned_scene *out)
{
    struct fmb_scene *scene = &out->scene;
    struct pair_cursor cursor = {0};
    scene->which = (enum fmb_pairs) query->which;
    scene->split = (size_t) query->split;
    unsigned(*pair)[2] =
        scene_alloc(out, (size_t) query_pair_count(query) + 1, sizeof *pair); /* 1: the last */
    while (scene_next_pair(out, &cursor, pair[scene->pair_count])) {
        const unsigned *last = pair[scene->pair_count];
        scene->pair_count += query_pair_number(query, last[0], last[1]) >= query->first_pair;
    }
    scene->pairs = (const unsigned(*)[2]) pair;
}

static void set_pairs(const struct scene_query *query, struct owned_scene *out)
{
    struct fmb_scene *scene = &out->scene;
    const size_t ignored_count = (size_t) (query->ignored_count / 2);
    unsigned(*ignored)[2] = scene_alloc(out, ignored_count, sizeof *ignored);
    scene->ignored = memcpy(ignored, query->ignored, ignored_count * sizeof *ignored);
    scene->ignored_count = ignored_count;
    scene_begin_ignored(out);
    if (query->which == FMB_PAIRS_ALL && query->first_pair == 0)
        return;
    if (query->which == FMB_PAIRS_LISTED) {
        const size_t count = (size_t) (query->index_count / 2 - query->first_pair);
        unsigned(*pair)[2] = scene_alloc(out, count, sizeof *pair);
        scene->pairs = memcpy(pair, query->pair[query->first_pair], count * sizeof *pair);
        scene->pair_count = count;
    } else {
        list_pairs(query, out);
    }
    scene->which = FMB_PAIRS_LISTED;
    scene->ignored_count = 0;
}

void scene_of_query(const struct logged_query *query, struct owned_scene *out)
{
    *out = (struct owned_scene){.dim = 0};
    if (query->kind == LOG_PAIR_QUERY) {
        out->scene.duration = query->pair.duration;
        set_bodies(query, false, out);
        return;
    }
    out->scene.duration = query->scene.duration;
    out->scene.margin = query->scene.margin;
    out->scene.label = copy_text(query->scene.label, out);
    set_bodies(query, true, out);
    set_pairs(&query->scene, out);
}
