#include "panel.h"

#include "allocate.h"

#include <stdlib.h>
#include <string.h>

static void add_to_bounds(struct panel *panel, const struct scene_body *body)
{
    for (unsigned frame = 0; frame < body->body.frame_count; frame++)
        for (int end = 0; end < 2; end++) {
            struct outline outline = outline_make(body, frame, end ? panel->duration : 0);
            view_add(&panel->bounds, &outline, panel->dim);
        }
}

void panel_take_scene(struct panel *panel, const struct scene *scene, size_t bodies_max)
{
    memset(panel, 0, sizeof *panel);
    panel->dim = scene->dim;
    panel->duration = scene->duration;
    panel->body_count = scene->body_count < bodies_max ? scene->body_count : bodies_max;
    panel->bodies_left_out = scene->body_count - panel->body_count;
    panel->body = allocate(panel->body_count, sizeof *panel->body);
    panel->verdict = allocate(panel->body_count, sizeof *panel->verdict);
    panel->bounds = view_nothing();
    for (size_t i = 0; i < panel->body_count; i++) {
        panel->body[i] = scene_body_copy(&scene->body[i]);
        add_to_bounds(panel, &panel->body[i]);
    }
}

static void note_verdict(struct panel *panel, size_t body, enum fmb_verdict verdict)
{
    if (body < panel->body_count && verdict > panel->verdict[body])
        panel->verdict[body] = verdict;
}

void panel_take_outcome(struct panel *panel, const struct outcome *outcome, size_t boxes_max)
{
    const struct fmb_answer *answer = &outcome->answer;
    panel->count[answer->verdict]++;
    note_verdict(panel, outcome->pair.a, answer->verdict);
    note_verdict(panel, outcome->pair.b, answer->verdict);
    if (!answer->has_box)
        return;
    if (panel->box_count == boxes_max || outcome->pair.a >= panel->body_count ||
        outcome->pair.b >= panel->body_count) {
        panel->boxes_left_out++;
        return;
    }
    panel->box =
        allocate_grow(panel->box, &panel->box_capacity, panel->box_count + 1, sizeof *panel->box);
    panel->box[panel->box_count++] = (struct panel_box){outcome->pair, *answer};
}

void panel_clear(struct panel *panel)
{
    for (size_t i = 0; i < panel->body_count; i++)
        scene_body_clear(&panel->body[i]);
    free(panel->body);
    free(panel->verdict);
    free(panel->box);
    memset(panel, 0, sizeof *panel);
}

bool panel_is_step_of(const struct panel *panel, const struct panel *first)
{
    if (panel->dim != first->dim || panel->body_count != first->body_count)
        return false;
    for (size_t i = 0; i < panel->body_count; i++)
        if (panel->body[i].id != first->body[i].id)
            return false;
    return true;
}
