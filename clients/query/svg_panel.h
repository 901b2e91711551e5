/* One scene of a picture (svg.h): its data, and its drawing. */
#ifndef SVG_PANEL_H
#define SVG_PANEL_H

#include "report.h"
#include "view.h"

#include <stdio.h>

struct panel_box {
    unsigned a, b;
    struct fmb_answer answer;
};

struct panel {
    int dim;
    double duration;
    size_t body_count, bodies_left_out;
    struct owned_scene scene;         /* from its end on */
    const struct fmb_placement *body; /* of the scene */
    enum fmb_verdict *verdict;        /* owned; [body], the worst of its pairs; 0: none */
    size_t box_count, box_capacity, boxes_left_out;
    struct panel_box *box;               /* owned */
    uint64_t count[FMB_OVERLAPPING + 1]; /* of pairs, [verdict]; [0]: not decided */
    struct view_bounds bounds;
};

/* Draws into an SVG group. bounds: the visible region, the panel's own or a larger one. */
void svg_panel_draw(const struct panel *panel, const struct view_bounds *bounds, struct paper paper,
                    FILE *out);

/* Returns the colour of a face as "#rrggbb", written into out. light: 0 to 1. */
const char *svg_panel_colour(enum fmb_verdict verdict, double light, char out[8]);

#endif
