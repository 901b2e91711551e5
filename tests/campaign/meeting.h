/* Two frames brought into contact, and what is known of the contact: the plane that parts them. The
 * hard families are made of this: what begins as an exact contact is stretched, scaled, carried
 * off, moved apart or into each other by next to nothing, and set in motion. */
#ifndef MEETING_H
#define MEETING_H

#include "cell.h"
#include "draw.h"
#include "question.h"
#include "solids.h"

struct meeting {
    struct question question;
    /* The plane that parts them: its normal, of any length, from A to B, and two vectors in it (one
     * in 2D, the other 0). */
    double normal[FMB_DIM_MAX];
    double along[2][FMB_DIM_MAX];
};

/* What meets: the dimension of the feature of one frame and of the other. */
struct features {
    int one, other; /* 0 a vertex, 1 an edge, 2 a face; one >= other */
    bool parallel;  /* two edges in 3D: they are parallel. Where the features leave no other way
                       (2D edges, an edge or a face on a face) they are so anyhow */
};

/* ---- Contacts (meet.c) ---- */

/* Exactly touching: the features named, of A and B or of B and A, lie in the parting plane, and a
 * point strictly within the one is one strictly within the other. Components are integers up to
 * most, those of a random one of the two times ratio, a power of two; most ratio <= 2^35. All
 * numbers are exact: multiples of 1/4, below 64 most ratio. Neither frame is flat; none is a
 * FACE. */
struct meeting meet_exactly(struct draw *draw, const struct cell *cell, struct features features,
                            double most, double ratio);

/* Any features that the dimension has; 3, 9, 1000 or 2^24 for most; and a meeting with both. */
struct features meeting_draw_features(struct draw *draw, int dim);
double meeting_draw_most(struct draw *draw);
struct meeting meet_anyhow(struct draw *draw, const struct cell *cell);

/* Ordinary doubles that touch but for rounding: components uniform in [-size, size], a face or two
 * edges of theirs (2D: an edge) in the parting plane. */
struct meeting meet_nearly(struct draw *draw, const struct cell *cell, double size);

/* The same for two frames that have their components: moves B. */
void meeting_bring_together(struct draw *draw, struct meeting *meeting);

/* ---- Changes that keep an exact contact exact as long as the numbers fit into 53 bits ---- */

/* All vectors along the axis times a power of two. */
void meeting_stretch(struct meeting *meeting, int axis, double factor);
/* To each vector's number on one axis, times (a small integer) that of another is added. */
void meeting_shear(struct meeting *meeting, int axis, int from, double times);
/* A few shears. */
void meeting_tilt(struct draw *draw, struct meeting *meeting);
/* All numbers times a power of two. */
void meeting_scale(struct meeting *meeting, double factor);
/* Both origins by so much. */
void meeting_carry(struct meeting *meeting, const double by[FMB_DIM_MAX]);
/* So that B's origin is 0, where a small step away from it is not rounded. */
void meeting_carry_home(struct meeting *meeting);

/* ---- Changes that end it ---- */

/* Moves B by a distance: > 0 away from A, along the normal, each number rounded away from A as
 * well; < 0 towards A, centre to centre, so that the interiors meet. */
void meeting_part(struct meeting *meeting, double distance);
/* Moves B by so many ulps on one axis, away from A (> 0) or into it (< 0), as far as one axis
 * can. */
void meeting_nudge(struct draw *draw, struct meeting *meeting, int ulps);

/* The largest number of a component, and the smallest length of one: what gaps are relative to. */
double meeting_size(const struct meeting *meeting);

/* ---- Motion ---- */

/* Gives both velocities, and moves A's origin back so that the two are as they were, relative to
 * each other, at a time in the window. An exact contact stays a touching one. */
enum motion {
    MOTION_TOGETHER, /* the same velocity: all the time */
    MOTION_ALONG,    /* relative velocity in the parting plane: sliding, or grazing in an instant */
    MOTION_ARRIVING, /* towards each other: as the window ends */
    MOTION_LEAVING,  /* away: as it begins */
    MOTION_KINDS
};
void meeting_move(struct draw *draw, struct meeting *meeting, enum motion motion);

/* Nothing for a static cell; any motion for a moving one. */
void meeting_move_anyhow(struct draw *draw, const struct cell *cell, struct meeting *meeting);

#endif
