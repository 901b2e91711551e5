/* A pair as plain values: what tests draw, change, copy and print. A struct pair points to its
 * bodies; a question holds all of itself. */
#ifndef QUESTION_H
#define QUESTION_H

#include <stdbool.h>

#include "draw.h"
#include "fmb.h"
#include "placed_pair.h"

/* Tests write questions by position, and leave out what is 0. */
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"

enum { SOLID_LISTED_MAX = 12, SOLID_VERTICES_MAX = 1024 };

/* A placed body. */
struct solid {
    int dim;
    enum fmb_shape shape;
    double component[FMB_DIM_MAX][FMB_DIM_MAX]; /* [component][axis]; of a box the size, [i][i] */
    double origin[FMB_DIM_MAX];                 /* the position of the body */
    double velocity[FMB_DIM_MAX];
    bool moving; /* has its velocity; else 0 */
    double
        local[FMB_DIM_MAX]; /* the origin of the frame in body coordinates; of a box its centre */
    double orientation[4];  /* as in struct fmb_placement */
    int orientation_count;
    int frames; /* 0 and 1: one; more: a row of them, each sharing a face with the one before */
    bool by_vertices; /* of a simplex of one frame: local and components are its vertices */
    bool as_hull;     /* made as the hull of its vertices; these are rounded */
    /* Of a hull, from local on: its first vertices; and how many more lie on the ellipsoid of the
     * components about local, drawn from the seed: some inside of it, some equal to others. */
    int vertex_count, cloud;
    double vertex[SOLID_LISTED_MAX][FMB_DIM_MAX];
    uint64_t cloud_seed;
    double radius; /* of each of its frames */
    bool ending;   /* has this end, and no velocity; if false, the end is 0 */
    double end_origin[FMB_DIM_MAX], end_orientation[4];
};

enum { SOLID_FRAMES_MAX = 8 };

struct question {
    struct solid a, b;
    double duration;
};

/* Components of a shape: 3 or 2, of a hull those of its ellipsoid. Written once more here, so that
 * the oracle's tests need nothing of the engine. */
int solid_count(const struct solid *solid);

/* How many frames it has, at least 1. */
int solid_frames(const struct solid *solid);

/* Frame i of the row, as a solid of one frame: each cuboid and box, and every second simplex, is
 * the first one further along component 0; the simplices between are turned over, about the middle
 * of the face opposite to the origin. Rounded where its numbers are not small and whole. */
struct solid solid_frame(const struct solid *solid, int i);

/* Whether its frames are hulls. */
bool solid_is_hull(const struct solid *solid);

/* The vertices of a solid of one frame, in body coordinates; rounded, except those of a simplex by
 * vertices and those listed of a hull whose local is 0. In: capacity for VERTICES_MAX of them, of a
 * hull for SOLID_VERTICES_MAX. Returns how many. */
enum { VERTICES_MAX = 8 };
int solid_vertices(const struct solid *solid, double (*vertex)[FMB_DIM_MAX]);

/* The numbers of fmb_frame_make(), or of fmb_frame_make_vertices() or fmb_frame_make_hull(): origin
 * and components, or centre and size, or vertices. Returns how many. */
enum { SOLID_NUMBERS_MAX = FMB_DIM_MAX * SOLID_VERTICES_MAX };
int solid_numbers(const struct solid *solid, double number[SOLID_NUMBERS_MAX]);

/* The placement of the body. */
struct fmb_placement solid_placement(const struct solid *solid, const struct fmb_body *body);

/* Lists where the coordinates of both solids are, which are no hulls: components, origins, and the
 * velocities of those that move. Returns how many. */
enum { QUESTION_NUMBERS_MAX = 2 * (FMB_DIM_MAX + 2) * FMB_DIM_MAX };
int question_numbers(struct question *question, double *out[QUESTION_NUMBERS_MAX]);

/* In: solids of one frame, not by vertices, no hulls. Out: the pair, with bodies in body[0] and
 * body[1], with only the fields that the oracle reads: not enough for the engine. */
void question_pair(const struct question *question, struct fmb_body body[2], struct pair *pair);

/* Whether a and b are equal in all numbers. */
bool question_is_symmetric(const struct question *question);

/* The same question with a and b in each other's place. */
struct question question_swapped(const struct question *question);

/* The same question with time reversed. Each solid is at rest or has an end. */
struct question question_reversed(const struct question *question);

/* Any shape of the dimension but a box and a hull. */
enum fmb_shape question_draw_shape(struct draw *draw, int dim);

/* Who carries a velocity: A, B or both; or, one time in four, none. */
void question_draw_movers(struct draw *draw, struct question *question);

/* Prints it to standard output as a C initialiser, in hexadecimal: a reproducer that can be
 * pasted into a test. */
void question_print(const struct question *question);

#endif
