#include "question.h"

#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Where a question is wrong. */
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

static bool check_numbers(struct place *place, size_t frame, const char *field,
                          const double *numbers, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(numbers[i]))
            return refuse(place, FMB_NOT_FINITE, "frames[%zu].%s[%d]", frame, field, i);
    return true;
}

static bool check_frame(struct place *place, const struct fmb_client_scene *scene, size_t i)
{
    const struct fmb_client_frame *frame = &scene->frames[i];
    if (!query_id_ok(frame->body_id))
        return refuse(place, FMB_BAD_ID, "frames[%zu].body_id", i);
    if (!fmb_shape_name(frame->shape))
        return refuse(place, FMB_UNKNOWN_SHAPE, "frames[%zu].shape", i);
    const int vectors = fmb_component_count(frame->dim, frame->shape);
    if (vectors == 0)
        return refuse(place, FMB_WRONG_DIMENSION, "frames[%zu].dim", i);
    if (frame->dim != scene->frames[0].dim)
        return refuse(place, FMB_DIMENSIONS_DIFFER, "frames[%zu].dim", i);
    return check_numbers(place, i, "components", frame->components, vectors * frame->dim) &&
           check_numbers(place, i, "origin", frame->origin, frame->dim) &&
           check_numbers(place, i, "velocity", frame->velocity, frame->moving ? frame->dim : 0);
}

static bool check_frames(struct place *place, const struct fmb_client_scene *scene)
{
    if (scene->frame_count > INT_MAX)
        return refuse(place, FMB_OVER_LIMIT, "frame_count");
    for (size_t i = 0; i < scene->frame_count; i++)
        if (!check_frame(place, scene, i))
            return false;
    return true;
}

static bool check_pairs(struct place *place, const struct fmb_client_scene *scene)
{
    const int which = (int) scene->which;
    if (which < FMB_CLIENT_LISTED || which > FMB_CLIENT_ACROSS)
        return refuse(place, FMB_UNKNOWN_WANT, "which");
    if (which == FMB_CLIENT_ACROSS && scene->split > scene->frame_count)
        return refuse(place, FMB_BAD_PAIR, "split");
    for (size_t i = 0; which == FMB_CLIENT_LISTED && i < scene->pair_count; i++) {
        const unsigned *pair = scene->pairs[i];
        if (pair[0] >= scene->frame_count || pair[1] >= scene->frame_count || pair[0] == pair[1])
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
    if (check_rest(&place, scene) && check_frames(&place, scene))
        check_pairs(&place, scene);
    return place.status;
}

static void fill_numbers(struct query_numbers *out, const double *numbers, int count)
{
    memset(out, 0, sizeof *out);
    out->count = count;
    memcpy(out->number, numbers, (size_t) count * sizeof *numbers);
}

void question_frame(const struct fmb_client_frame *frame, struct query_frame *out)
{
    const int dim = frame->dim;
    out->body_id = frame->body_id;
    out->key = 0;
    out->shape = frame->shape;
    out->dim = dim;
    fill_numbers(&out->origin, frame->origin, dim);
    fill_numbers(&out->components, frame->components, fmb_component_count(dim, frame->shape) * dim);
    fill_numbers(&out->velocity, frame->velocity, frame->moving ? dim : 0);
}

/* Frame a is asked against those from here on. */
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
    const size_t askers = scene->which == FMB_CLIENT_ACROSS ? scene->split : scene->frame_count;
    if (cursor->b == 0)
        cursor->b = partners(scene, cursor->a);
    if (cursor->b >= scene->frame_count && ++cursor->a < askers)
        cursor->b = partners(scene, cursor->a);
    if (cursor->a >= askers || cursor->b >= scene->frame_count)
        return false;
    out[0] = (unsigned) cursor->a;
    out[1] = (unsigned) cursor->b++;
    return true;
}
