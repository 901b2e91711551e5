/* Other libraries that decide whether convex solids meet, or how far apart they are: those that
 * were found when this was built. */
#ifndef PEERS_H
#define PEERS_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A motion during [0, 1], as [begin, end]. Positions and quaternions (w, x, y, z) are interpolated
 * linearly; the quaternions are at an acute angle, and the result is normalised. */
struct peer_motion {
    double centre[3]; /* of the solid, in coordinates of the body that has these poses */
    double position[2][3], orientation[2][4];
};

/* A cuboid, box or tetrahedron (2D: parallelogram, rectangle, triangle), or a hull, a sphere or a
 * capsule, in world coordinates. */
struct peer_solid {
    int dim;
    bool box;  /* its components are at right angles */
    int count; /* of vertices: 2^dim, or dim + 1 of a simplex */
    const double (
        *hull)[3];   /* [count]: its vertices, about centre; it has no others. NULL: no hull */
    double radius;   /* of a sphere (a hull of one vertex) or a capsule (of two); 0: none */
    const int *face; /* of a hull: the number of vertices of a face, their indices, the next face */
    int faces;
    double origin[3], component[3][3], vertex[8][3];
    /* Of a box: components are size times unit axis. A capsule has this size and axis, number 2. */
    double centre[3], size[3], axis[3][3];
    double velocity[3]; /* during [0, 1] */
    /* NULL, or the motion of a box or a hull, which then has no world coordinates. */
    const struct peer_motion *motion;
};

/* ---- All of them ---- */

enum { PEERS_MAX = 16 };

struct peers;

/* The solids must outlive the peers. Unless all of them are in 3D, no library is opened. If a
 * solid is a hull, or has a radius or a motion, only libraries that take such solids may be run. */
struct peers *peers_open(const struct peer_solid *solid, size_t count);
void peers_close(struct peers *peers);

/* What a peer answers: a sum. PEER_VERDICT: it is raced for verdicts; PEER_TURNING_VERDICT: it is
 * raced for verdicts of solids with a motion. */
enum { PEER_VERDICT = 1, PEER_DISTANCE = 2, PEER_DEPTH = 4, PEER_TURNING_VERDICT = 8 };

/* Which pairs it takes besides solids at rest in 3D: a sum. */
enum { PEER_MOVING = 1, PEER_HULLS = 2, PEER_TURNING = 4 };

/* NULL past the last. */
const char *peer_name(int peer);
int peer_answers(int peer);
bool peer_takes(int peer, int needs);

/* pair: [count], indices of solids. Writes the gaps: positive for separated, else overlapping or
 * touching; infinite where the peer gives the verdict only; NAN where it failed. */
void peer_run(const struct peers *peers, int peer, const unsigned (*pair)[2], size_t count,
              double *gap);

/* Prints lines on what the names mean. */
void peers_help(void);

/* ---- One library ---- */

struct peer {
    const char *name;
    int answers, takes;
    double (*gap)(void *bodies, size_t a, size_t b);
};

struct peer_library {
    const struct peer *peer;
    int count;
    const char *help;
    void *(*open)(const struct peer_solid *solid, size_t count);
    void (*close)(void *bodies);
};

extern const struct peer_library peer_library_bullet, peer_library_ccd, peer_library_fcl;

#ifdef __cplusplus
}
#endif

#endif
