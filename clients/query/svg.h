/* A picture of scenes: one panel each, in a grid.
 *
 * A panel shows the frames at the start of the window, coloured by the worst of their verdicts, and
 * at its end as dashed outlines; an arrow for each motion; the boxes of the intersections; and the
 * ids. 2D scenes are shown in their plane, 3D scenes in an axonometric projection, z up. Scenes of
 * the same bodies are considered steps in time, and share one point of view.
 *
 * Finite numbers of any size and infinite boxes can be drawn. What is too large or too small is not
 * visible, and the file has numbers of usual size only. */
#ifndef SVG_H
#define SVG_H

#include "report.h"

enum { SVG_PANELS_MAX = 60, SVG_BODIES_MAX = 2000, SVG_BOXES_MAX = 2000 };

struct svg;

struct svg *svg_open(void);
void svg_close(struct svg *svg); /* may be NULL */

/* Returns the report that receives the scenes; owned by svg. Its end takes the memory of a scene
 * that is drawn, and leaves an empty one. Scenes beyond SVG_PANELS_MAX, and within a scene bodies
 * beyond SVG_BODIES_MAX and boxes beyond SVG_BOXES_MAX, are not drawn, but counted in the picture.
 */
struct report *svg_report(struct svg *svg);

void svg_write(const struct svg *svg, FILE *out);

#endif
