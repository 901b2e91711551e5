/* One scene of a picture (svg.h): how it is drawn. */
#ifndef DRAW_H
#define DRAW_H

#include "panel.h"

#include <stdio.h>

/* Draws into an SVG group. bounds: what is to be seen, the panel's own or more. */
void draw_panel(const struct panel *panel, const struct view_bounds *bounds, struct paper paper,
                FILE *out);

/* The fill of a face as "#rrggbb". light from 0 to 1. */
const char *draw_colour(enum fmb_verdict verdict, double light, char out[8]);

#endif
