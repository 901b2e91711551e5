/* A picture of scenes: one panel each, in a grid.
 *
 * A panel shows the frames at the start of the window, coloured by the worst of their verdicts, and
 * at its end as dashed outlines; an arrow for each motion; the boxes of the intersections; and the
 * ids. 2D scenes are shown in their plane, 3D scenes in an axonometric projection, z up. Scenes of
 * the same bodies are taken for steps of time, and drawn from one point of view.
 *
 * Any finite numbers can be drawn, and infinite boxes: what is too large or too small is not
 * visible, and the file has ordinary numbers only. */
#ifndef SVG_H
#define SVG_H

#include "report.h"

enum { SVG_PANELS_MAX = 60, SVG_BODIES_MAX = 2000, SVG_BOXES_MAX = 2000 };

struct svg;

struct svg *svg_open(void);
void svg_close(struct svg *svg); /* may be NULL */

/* Returns the report that takes scenes; owned by svg. Beyond SVG_PANELS_MAX scenes, and within a
 * scene beyond SVG_BODIES_MAX bodies and SVG_BOXES_MAX boxes, nothing more is kept, and the picture
 * says so. */
struct report *svg_report(struct svg *svg);

void svg_write(const struct svg *svg, FILE *out);

#endif
