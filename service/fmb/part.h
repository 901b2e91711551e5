/* A frame as vertices, edges and faces, in doubles with bounds: what box.c cuts, and cuts with. A
 * face (FMB_FACE) has no faces of its own to cut with: edges pierce it. */
#ifndef FMB_PART_H
#define FMB_PART_H

#include "prepared.h"
#include "range.h"
#include "weighed.h"

enum { PART_VERTICES = 8, PART_FACES = 4, PART_DIRECTIONS = 6, PART_EDGES = 12 };

struct part_edge {
    int direction;  /* its number */
    int start, end; /* vertices */
};

/* A frame: its vertices and edges, and its faces, which cut those of the other one. */
struct part {
    enum fmb_shape shape;
    int dim, components, vertices, directions, edges, faces;
    struct weighed component[FMB_DIM_MAX];
    struct weighed direction[PART_DIRECTIONS];
    struct part_edge edge[PART_EDGES];
    double vertex[PART_VERTICES][FMB_DIM_MAX]; /* with the origin at 0 */
    /* In the world, [0] at the start and [1] at the end of the window. */
    struct range place[2][PART_VERTICES][FMB_DIM_MAX];
    double displacement[FMB_DIM_MAX]; /* v T, rounded; what it surely is: */
    struct range way[FMB_DIM_MAX];
    struct range extent[FMB_DIM_MAX]; /* of all places */
    double slack[FMB_DIM_MAX];        /* error of a point between vertices, in time too */
    /* Points x of the frame have normal . x between 0 and its volume, whatever its sign. */
    struct weighed normal[PART_FACES];
    double low, high;
};

/* On input: a frame of a body in range, checked; the window, in seconds. False if a place is
 * too far away for doubles. */
bool part_set(const struct world_frame *frame, double duration, struct part *part);

#endif
