/* A picture of scenes: one panel each, in a grid.
 *
 * The frames at the start of the window, coloured by the worst of their verdicts, and as dashed
 * outlines at its end; arrows for the way they go; the boxes of the intersections; the ids. 2D
 * scenes as they lie in the plane, 3D ones in an axonometric projection, z up. Scenes of the same
 * bodies are taken for steps of time and drawn from one point of view, so that they can be
 * compared.
 *
 * Any finite numbers can be drawn, and boxes that are infinite: what is too large or too small to
 * be seen is not seen, but the file holds ordinary numbers only. */
#ifndef SVG_H
#define SVG_H

#include "report.h"

enum { SVG_PANELS_MAX = 60, SVG_BODIES_MAX = 2000, SVG_BOXES_MAX = 2000 };

struct svg;

struct svg *svg_open(void);
void svg_close(struct svg *svg); /* may be NULL */

/* Takes in scenes; owned by svg. Beyond SVG_PANELS_MAX scenes, and within a scene beyond
 * SVG_BODIES_MAX bodies and SVG_BOXES_MAX boxes, nothing more is kept, and the picture says so. */
struct report *svg_report(struct svg *svg);

void svg_write(const struct svg *svg, FILE *out);

#endif
