#include "logged_query.h"

#include "allocate.h"
#include "pair_number.h"
#include "scene.h"
#include "utf8.h"
#include "wire.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

static const char *read_header(struct logged_query *out, const unsigned char *bytes, uint32_t size)
{
    if (out->kind == LOG_PAIR_QUERY) {
        memset(&out->pair, 0, sizeof out->pair);
        return wire_read_pair_header(bytes, size, &out->pair.header);
    }
    memset(&out->scene, 0, sizeof out->scene);
    return wire_read_scene_header(bytes, size, &out->scene.header);
}

const char *logged_query_read(struct logged_query *out, enum log_kind kind,
                              const unsigned char *bytes, uint32_t size)
{
    out->kind = kind;
    if (size > QUERY_BYTES_MAX)
        return read_header(out, bytes, size);
    return kind == LOG_PAIR_QUERY ? wire_read_pair_query(bytes, size, &out->pair)
                                  : wire_read_scene_query(bytes, size, &out->scene);
}

const struct query_header *logged_query_header(const struct logged_query *query)
{
    return query->kind == LOG_PAIR_QUERY ? &query->pair.header : &query->scene.header;
}

struct placement *logged_query_placements(struct logged_query *query, int32_t *count)
{
    *count = query->kind == LOG_PAIR_QUERY ? 2 : query_stored_placements(&query->scene);
    return query->kind == LOG_PAIR_QUERY ? query->pair.placement : query->scene.placement;
}

static bool placements_are_whole(const struct placement *placement, int32_t count)
{
    for (int32_t i = 0; i < count; i++)
        if (placement[i].dim > FMB_DIM_MAX ||
            placement[i].orientation_count > QUERY_ORIENTATION_MAX ||
            placement[i].velocity_count > FMB_DIM_MAX)
            return false;
    return true;
}

static bool is_whole(const struct logged_query *query)
{
    const struct scene_query *scene = &query->scene;
    if (query->kind == LOG_PAIR_QUERY)
        return placements_are_whole(query->pair.placement, 2);
    return scene->placement_count <= QUERY_PLACEMENTS_MAX &&
           scene->index_count <= 2 * QUERY_PAIRS_MAX &&
           scene->ignored_count <= 2 * QUERY_PAIRS_MAX &&
           placements_are_whole(scene->placement, scene->placement_count);
}

static size_t bytes_of(const struct logged_query *query)
{
    const bool pair = query->kind == LOG_PAIR_QUERY;
    const struct placement *placement = pair ? query->pair.placement : query->scene.placement;
    const int32_t count = pair ? 2 : query->scene.placement_count;
    size_t bytes =
        pair ? WIRE_PAIR_QUERY_BYTES : WIRE_SCENE_QUERY_BYTES + wire_text_bytes(query->scene.label);
    for (int32_t i = 0; i < count; i++)
        bytes += wire_placement_bytes(&placement[i]);
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

int64_t logged_query_pairs_until(const struct scene_query *query, int32_t end_pair)
{
    struct query_marks *marks = allocate_unset(sizeof *marks);
    const int64_t pairs = query_pairs_decided(query, end_pair, marks);
    free(marks);
    return pairs;
}

/* ---- As a scene: bodies ---- */

/* The caller frees what *out owns, even if this returns false. */
static bool read_body(const struct geometry *geometry, struct scene_body *out)
{
    struct geometry_reader reader = geometry_begin(geometry);
    const size_t count = (size_t) reader.frames_left;
    size_t read = 0, bad;
    out->given = allocate(count, sizeof *out->given);
    while (read < count && geometry_next(&reader, &out->given[read]))
        read++;
    return read == count && reader.counts_left == 0 && reader.numbers_left == 0 &&
           scene_body_make(reader.dim, count, out, &bad) == FMB_OK;
}

bool scene_takes(const struct geometry *geometry)
{
    struct scene_body body = {.id = 0};
    const bool taken = read_body(geometry, &body);
    scene_body_clear(&body);
    return taken;
}

/* Copies a name or a label, unless a scene cannot have it. */
static void copy_text(const char *text, char out[SCENE_NAME_MAX + 1])
{
    if (text && strlen(text) <= SCENE_NAME_MAX && utf8_is_text(text))
        strcpy(out, text);
}

static void set_body(const struct placement *placement, struct scene_body *out)
{
    const bool taken = read_body(&placement->geometry, out);
    assert(taken);
    (void) taken;
    memcpy(out->position, placement->position, sizeof out->position);
    memcpy(out->velocity, placement->velocity, sizeof out->velocity);
    memcpy(out->orientation, placement->orientation, sizeof out->orientation);
    out->orientation_count = placement->orientation_count;
    out->group = placement->group;
    copy_text(placement->name, out->name);
}

static int compare(const void *left, const void *right)
{
    const int64_t a = *(const int64_t *) left, b = *(const int64_t *) right;
    return (a > b) - (a < b);
}

/* Returns the lowest id from *id on that is not in sorted[count]. *next: index of the first element
 * that is *id or more. Advances both for the next call. */
static int64_t free_id(const int64_t *sorted, size_t count, size_t *next, int64_t *id)
{
    for (; *next < count && sorted[*next] <= *id; ++*next)
        if (sorted[*next] == *id)
            ++*id;
    return (*id)++;
}

/* Whether an earlier placement has the same id. Quadratic, but scenes are small. */
static bool is_repeated(const struct placement *placement, size_t i)
{
    for (size_t before = 0; before < i; before++)
        if (placement[before].body_id == placement[i].body_id)
            return true;
    return false;
}

static void set_ids(const struct placement *placement, struct scene *scene)
{
    int64_t *sorted = allocate(scene->body_count, sizeof *sorted), id = 1;
    size_t next = 0;
    for (size_t i = 0; i < scene->body_count; i++)
        sorted[i] = placement[i].body_id;
    qsort(sorted, scene->body_count, sizeof *sorted, compare);
    for (size_t i = 0; i < scene->body_count; i++)
        scene->body[i].id = placement[i].body_id == 0 || is_repeated(placement, i)
                                ? free_id(sorted, scene->body_count, &next, &id)
                                : placement[i].body_id;
    free(sorted);
}

static void set_bodies(const struct placement *placement, size_t count, struct scene *scene)
{
    scene->dim = count > 0 ? placement[0].dim : FMB_DIM_MAX;
    scene->body_count = count;
    scene->body = allocate(count, sizeof *scene->body);
    for (size_t i = 0; i < count; i++)
        set_body(&placement[i], &scene->body[i]);
    set_ids(placement, scene);
}

/* ---- As a scene: pairs ---- */

struct list {
    struct scene *scene;
    size_t capacity;
    int32_t skip; /* number of pairs still to skip */
};

static void add(struct list *list, size_t a, size_t b)
{
    struct scene *scene = list->scene;
    if (list->skip > 0) {
        list->skip--;
        return;
    }
    if (scene_ignores(scene, (struct scene_pair){a, b}))
        return;
    scene->pair =
        allocate_grow(scene->pair, &list->capacity, scene->pair_count + 1, sizeof *scene->pair);
    scene->pair[scene->pair_count++] = (struct scene_pair){a, b};
}

static void set_ignored(const struct scene_query *query, struct scene *scene)
{
    scene->ignored_count = (size_t) (query->ignored_count / 2);
    scene->ignored = allocate(scene->ignored_count, sizeof *scene->ignored);
    for (size_t k = 0; k < scene->ignored_count; k++)
        scene->ignored[k] = (struct scene_pair){query->ignored[k][0], query->ignored[k][1]};
    scene_sort_ignored(scene);
}

static void set_pairs(const struct scene_query *query, struct scene *scene)
{
    struct list list = {.scene = scene, .skip = query->first_pair};
    const struct pair_numbers numbers = {query->which == FMB_PAIRS_ACROSS, scene->body_count,
                                         (size_t) query->split};
    scene->all_pairs = query->which == FMB_PAIRS_ALL && query->first_pair == 0;
    set_ignored(query, scene);
    if (query->which == FMB_PAIRS_LISTED)
        for (int32_t k = 0; k < query->index_count / 2; k++)
            add(&list, query->pair[k][0], query->pair[k][1]);
    else if (!scene->all_pairs)
        for (size_t a = 0, b = 0; pair_find(numbers, &a, &b); b++)
            add(&list, a, b);
    scene->ignored_count = scene->all_pairs ? scene->ignored_count : 0;
}

void scene_of_query(const struct logged_query *query, struct scene *out)
{
    *out = (struct scene){.all_pairs = true};
    if (query->kind == LOG_PAIR_QUERY) {
        out->duration = query->pair.duration;
        set_bodies(query->pair.placement, 2, out);
        out->body[0].group = out->body[1].group = 0; /* which a pair query does not look at */
        return;
    }
    out->duration = query->scene.duration;
    out->margin = query->scene.margin;
    copy_text(query->scene.label, out->label);
    set_bodies(query->scene.placement, (size_t) query->scene.placement_count, out);
    set_pairs(&query->scene, out);
}
