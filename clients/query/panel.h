/* One scene of a picture (svg.h): the data that are kept until it is drawn (svg_panel.h). */
#ifndef PANEL_H
#define PANEL_H

#include "report.h"
#include "view.h"

struct panel_box {
    struct scene_pair pair;
    struct fmb_answer answer;
};

struct panel {
    int dim;
    double duration;
    size_t body_count, bodies_left_out;
    struct scene_body *body;   /* owned */
    enum fmb_verdict *verdict; /* owned; [body], the worst of its pairs; 0: none */
    size_t box_count, box_capacity, boxes_left_out;
    struct panel_box *box;               /* owned */
    uint64_t count[FMB_OVERLAPPING + 1]; /* of pairs, [verdict]; [0]: not decided */
    struct view_bounds bounds;
};

void panel_take_scene(struct panel *panel, const struct scene *scene, size_t bodies_max);
void panel_take_outcome(struct panel *panel, const struct outcome *outcome, size_t boxes_max);
void panel_clear(struct panel *panel);

/* Returns whether both have the same bodies, by id, and so may be steps of time. */
bool panel_is_step_of(const struct panel *panel, const struct panel *first);

#endif
