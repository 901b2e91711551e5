#include "question.h"

#include "wire.h"

#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Where a scene is wrong. */
struct place {
    char *why;
    int status;
};

__attribute__((format(printf, 3, 4))) static bool refuse(struct place *place, int status,
                                                         const char *format, ...)
{
    va_list list;
    va_start(list, format);
    const int used = vsnprintf(place->why, FMB_CLIENT_WHY_MAX, format, list);
    va_end(list);
    if (used >= 0 && used < FMB_CLIENT_WHY_MAX)
        snprintf(place->why + used, (size_t) (FMB_CLIENT_WHY_MAX - used), ": %s",
                 fmb_status_text(status));
    place->status = status;
    return false;
}

static bool check_numbers(struct place *place, size_t placement, const char *field,
                          const double *numbers, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(numbers[i]))
            return refuse(place, FMB_NOT_FINITE, "placements[%zu].%s[%d]", placement, field, i);
    return true;
}

static bool check_placement(struct place *place, const struct fmb_client_scene *scene, size_t i)
{
    const struct fmb_client_placement *placement = &scene->placements[i];
    if (!query_id_ok(placement->body_id))
        return refuse(place, FMB_BAD_ID, "placements[%zu].body_id", i);
    if (!fmb_shape_name(placement->shape))
        return refuse(place, FMB_UNKNOWN_SHAPE, "placements[%zu].shape", i);
    const int vectors = fmb_component_count(placement->dim, placement->shape);
    if (vectors == 0)
        return refuse(place, FMB_WRONG_DIMENSION, "placements[%zu].dim", i);
    if (placement->dim != scene->placements[0].dim)
        return refuse(place, FMB_DIMENSIONS_DIFFER, "placements[%zu].dim", i);
    return check_numbers(place, i, "components", placement->components, vectors * placement->dim) &&
           check_numbers(place, i, "position", placement->position, placement->dim) &&
           check_numbers(place, i, "velocity", placement->velocity,
                         placement->moving ? placement->dim : 0);
}

static bool check_placements(struct place *place, const struct fmb_client_scene *scene)
{
    if (scene->placement_count > INT_MAX)
        return refuse(place, FMB_OVER_LIMIT, "placement_count");
    for (size_t i = 0; i < scene->placement_count; i++)
        if (!check_placement(place, scene, i))
            return false;
    return true;
}

static bool check_pairs(struct place *place, const struct fmb_client_scene *scene)
{
    const int which = (int) scene->which;
    if (which < FMB_CLIENT_LISTED || which > FMB_CLIENT_ACROSS)
        return refuse(place, FMB_UNKNOWN_WANT, "which");
    if (which == FMB_CLIENT_ACROSS && scene->split > scene->placement_count)
        return refuse(place, FMB_BAD_PAIR, "split");
    for (size_t i = 0; which == FMB_CLIENT_LISTED && i < scene->pair_count; i++) {
        const unsigned *pair = scene->pairs[i];
        if (pair[0] >= scene->placement_count || pair[1] >= scene->placement_count ||
            pair[0] == pair[1])
            return refuse(place, FMB_BAD_PAIR, "pairs[%zu]", i);
    }
    return true;
}

static bool check_rest(struct place *place, const struct fmb_client_scene *scene)
{
    const unsigned wants =
        FMB_CLIENT_WANT_BOX | FMB_CLIENT_WANT_CERTIFICATE | FMB_CLIENT_WANT_TIMES;
    if (!(scene->duration >= 0 && isfinite(scene->duration)))
        return refuse(place, FMB_BAD_DURATION, "duration");
    return (scene->want & ~wants) == 0 || refuse(place, FMB_UNKNOWN_WANT, "want");
}

int question_check(const struct fmb_client_scene *scene, char why[FMB_CLIENT_WHY_MAX])
{
    struct place place = {.why = why};
    why[0] = '\0';
    if (check_rest(&place, scene) && check_placements(&place, scene))
        check_pairs(&place, scene);
    return place.status;
}

void question_placement(const struct fmb_client_placement *of,
                        unsigned char geometry[GEOMETRY_FRAME_BYTES_MAX], struct placement *out)
{
    struct geometry_frame frame = {.shape = of->shape};
    const size_t axes = (size_t) of->dim * sizeof(double);
    memcpy(frame.components, of->components, sizeof frame.components);
    *out = (struct placement){.body_id = of->body_id, .dim = of->dim, .frame_count = 1};
    out->geometry = (struct geometry){geometry, geometry_write(of->dim, &frame, geometry)};
    memcpy(out->position, of->position, axes);
    out->velocity_count = of->moving ? of->dim : 0;
    if (of->moving)
        memcpy(out->velocity, of->velocity, axes);
}

size_t question_placement_bytes(const struct fmb_client_placement *placement)
{
    unsigned char geometry[GEOMETRY_FRAME_BYTES_MAX];
    struct placement whole;
    question_placement(placement, geometry, &whole);
    return wire_placement_bytes(&whole);
}

/* The first partner of placement a. */
static size_t partners(const struct fmb_client_scene *scene, size_t a)
{
    return scene->which == FMB_CLIENT_ACROSS ? scene->split : a + 1;
}

bool question_next_pair(const struct fmb_client_scene *scene, struct question_cursor *cursor,
                        unsigned out[2])
{
    if (scene->which == FMB_CLIENT_LISTED) {
        if (cursor->next == scene->pair_count)
            return false;
        memcpy(out, scene->pairs[cursor->next++], sizeof *scene->pairs);
        return true;
    }
    const size_t firsts = scene->which == FMB_CLIENT_ACROSS ? scene->split : scene->placement_count;
    if (cursor->b == 0)
        cursor->b = partners(scene, cursor->a);
    if (cursor->b >= scene->placement_count && ++cursor->a < firsts)
        cursor->b = partners(scene, cursor->a);
    if (cursor->a >= firsts || cursor->b >= scene->placement_count)
        return false;
    out[0] = (unsigned) cursor->a;
    out[1] = (unsigned) cursor->b++;
    return true;
}
