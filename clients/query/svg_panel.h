/* Draws one scene of a picture (svg.h). */
#ifndef SVG_PANEL_H
#define SVG_PANEL_H

#include "panel.h"

#include <stdio.h>

/* Draws into an SVG group. bounds: the visible region, the panel's own or a larger one. */
void svg_panel_draw(const struct panel *panel, const struct view_bounds *bounds, struct paper paper,
                    FILE *out);

/* Returns the colour of a face as "#rrggbb", written into out. light: 0 to 1. */
const char *svg_panel_colour(enum fmb_verdict verdict, double light, char out[8]);

#endif
