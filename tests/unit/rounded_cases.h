/* Pairs of frames with a radius, worked out by hand. */
#ifndef ROUNDED_CASES_H
#define ROUNDED_CASES_H

#include <float.h>

#include "question.h"

/* clang-format off */
#define UNIT2 {{1, 0}, {0, 1}}
#define UNIT3 {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}
#define DISC 2, FMB_CUBOID, {{0}}
#define SQUARE 2, FMB_CUBOID, UNIT2
#define BALL 3, FMB_CUBOID, {{0}}
#define CUBE 3, FMB_CUBOID, UNIT3
#define ALONG_X 3, FMB_TETRAHEDRON, {{4, 0, 0}, {0}, {0}}
#define ALONG_Y 3, FMB_CUBOID, {{0}, {0, 4, 0}, {0}}
#define STILL {0}, false
#define FAR_BALL 3, FMB_HULL, {{0}}, {DBL_MAX, -DBL_MAX}, STILL, {DBL_MAX, -DBL_MAX}, .vertex_count = 1

struct rounded_case {
    const char *what;
    struct question question;
    enum fmb_verdict verdict;
    double contact[2]; /* where a body moves */
};

static const struct rounded_case rounded_cases[] = {
    {"balls, 3 4 5", {{BALL, {1, 0, 0}, STILL, .radius = 2}, {BALL, {4, 4, 0}, STILL, .radius = 3}, 1}, FMB_TOUCHING},
    {"a point and a ball, 2 3 6", {{BALL, {1, 1, 1}, STILL}, {BALL, {3, 4, 7}, STILL, .radius = 7}, 1}, FMB_TOUCHING},
    {"a point and a smaller ball", {{BALL, {1, 1, 1}, STILL}, {BALL, {3, 4, 7}, STILL, .radius = 7 - 0x1p-50}, 1}, FMB_SEPARATED},
    {"a point and a larger ball", {{BALL, {1, 1, 1}, STILL}, {BALL, {3, 4, 7}, STILL, .radius = 7 + 0x1p-50}, 1}, FMB_OVERLAPPING},
    {"radii whose sum is no double", {{BALL, {0}, STILL, .radius = 0x1p-60}, {BALL, {1, 4, 8}, STILL, .radius = 9}, 1}, FMB_OVERLAPPING},
    {"a ball at a vertex", {{CUBE, {0}, STILL}, {BALL, {3, 4, 7}, STILL, .radius = 7}, 1}, FMB_TOUCHING},
    {"a ball at an edge", {{CUBE, {0}, STILL}, {BALL, {-3, 0.5, 5}, STILL, .radius = 5}, 1}, FMB_TOUCHING},
    {"a ball on a face", {{CUBE, {0}, STILL}, {BALL, {0.5, 0.25, 1 + 0x1p-20}, STILL, .radius = 0x1p-20}, 1}, FMB_TOUCHING},
    {"a ball that the box of a cube would meet", {{CUBE, {0}, STILL}, {BALL, {3, 4, 7}, STILL, .radius = 6.5}, 1}, FMB_SEPARATED},
    {"a ball in a cube", {{CUBE, {0}, STILL}, {BALL, {0.5, 0.5, 0.5}, STILL, .radius = 0x1p-1074}, 1}, FMB_OVERLAPPING},
    {"a point in a ball", {{BALL, {0}, STILL}, {BALL, {0, 0, 1}, STILL, .radius = 2}, 1}, FMB_OVERLAPPING},
    {"equal centres", {{BALL, {1, 2, 3}, STILL, .radius = 1}, {BALL, {1, 2, 3}, STILL, .radius = 1}, 1}, FMB_OVERLAPPING},
    {"subnormal radii", {{BALL, {0}, STILL, .radius = 0x1p-1074}, {BALL, {0, 0, 3 * 0x1p-1074}, STILL, .radius = 0x1p-1073}, 1}, FMB_TOUCHING},
    {"the largest radius", {{BALL, {0}, STILL, .radius = DBL_MAX}, {BALL, {DBL_MAX, 0, 0}, STILL}, 1}, FMB_TOUCHING},
    {"balls beyond the doubles",
     {{FAR_BALL, .radius = 1}, {FAR_BALL, .radius = 2}, 1}, FMB_OVERLAPPING},
    {"cubes whose faces touch, with a radius", {{CUBE, {0}, STILL, .radius = 0x1p-1074}, {CUBE, {1, 0, 0}, STILL}, 1}, FMB_OVERLAPPING},
    {"rounded cubes, vertex at vertex", {{CUBE, {0}, STILL, .radius = 2}, {CUBE, {3, 4, 7}, STILL, .radius = 5}, 1}, FMB_TOUCHING},
    {"capsules across each other", {{ALONG_X, {-1, 0, 0}, STILL, .radius = 2}, {ALONG_Y, {1, -1, 5}, STILL, .radius = 3}, 1}, FMB_TOUCHING},
    {"capsules side by side", {{ALONG_X, {0}, STILL, .radius = 2}, {ALONG_X, {2, 3, 4}, STILL, .radius = 3}, 1}, FMB_TOUCHING},
    {"the end of a capsule at a face", {{CUBE, {0}, STILL, .radius = 1}, {ALONG_X, {4, 0.5, 0.5}, STILL, .radius = 2}, 1}, FMB_TOUCHING},
    {"a turned cuboid and a ball at its corner (3, 4, 0)",
     {{3, FMB_CUBOID, {{5, 0, 0}, {0, 5, 0}, {0, 0, 5}}, {0}, STILL, {0}, {2, 0, 0, 1}, 4}, {BALL, {6, 6, -6}, STILL, .radius = 7}, 1},
     FMB_TOUCHING},
    {"a rounded face and a point beside its edge",
     {{3, FMB_FACE, {{4, 0, 0}, {0, 4, 0}}, {0}, STILL, .radius = 13}, {BALL, {1, -5, 12}, STILL}, 1}, FMB_TOUCHING},
    {"a disc at a corner", {{SQUARE, {0}, STILL}, {DISC, {4, 5}, STILL, .radius = 5}, 1}, FMB_TOUCHING},
    {"a disc at an edge", {{SQUARE, {0}, STILL, .radius = 0.5}, {DISC, {0.5, 2.5}, STILL, .radius = 1}, 1}, FMB_TOUCHING},
    {"stadiums", {{2, FMB_CUBOID, {{4, 0}, {0}}, {0}, STILL, .radius = 1}, {2, FMB_CUBOID, {{0}, {0, 4}}, {7, 4}, STILL, .radius = 4}, 1}, FMB_TOUCHING},

    {"a ball grazes a point", {{BALL, {0}, STILL}, {BALL, {-6, 5, 0}, {3, 0, 0}, true, .radius = 5}, 4}, FMB_TOUCHING, {2, 2}},
    {"a ball grazes a point a third of a second later", {{BALL, {1, 0, 0}, STILL}, {BALL, {-5, 5, 0}, {3, 0, 0}, true, .radius = 5}, 4}, FMB_TOUCHING, {2, 2}},
    {"a ball passes a point by", {{BALL, {0}, STILL}, {BALL, {-6, 5, 0}, {3, 0, 0}, true, .radius = 5 - 0x1p-50}, 4}, FMB_SEPARATED},
    {"a ball slides on a cube", {{CUBE, {0}, STILL}, {BALL, {-3, 0.5, 2}, {1, 0, 0}, true, .radius = 1}, 8}, FMB_TOUCHING, {3, 4}},
    {"a ball slides on a cube as the window begins", {{CUBE, {0}, STILL}, {BALL, {0.5, 0.5, 2}, {0.25, 0, 0}, true, .radius = 1}, 8}, FMB_TOUCHING, {0, 2}},
    {"a capsule slides along a rounded edge",
     {{CUBE, {0}, STILL, .radius = 2}, {ALONG_X, {-8, 4, 5}, {2, 0, 0}, true, .radius = 3}, 8}, FMB_TOUCHING, {2, 4.5}},
    {"a ball flies through a point", {{BALL, {0}, STILL}, {BALL, {-13, 3, 0}, {2, 0, 0}, true, .radius = 5}, 16}, FMB_OVERLAPPING, {4.5, 8.5}},
    {"both fly", {{BALL, {-13, 0, 0}, {3, 1, 0}, true, .radius = 1}, {BALL, {0, 0, 3}, {1, 1, 0}, true, .radius = 4}, 16}, FMB_OVERLAPPING, {4.5, 8.5}},
    {"a ball flies in", {{CUBE, {0}, STILL}, {BALL, {9, 0.5, 0.5}, {-2, 0, 0}, true, .radius = 2}, 4}, FMB_OVERLAPPING, {3, 4}},
    {"a ball arrives", {{CUBE, {0}, STILL}, {BALL, {9, 0.5, 0.5}, {-2, 0, 0}, true, .radius = 2}, 3}, FMB_TOUCHING, {3, 3}},
    {"a ball leaves", {{CUBE, {0}, STILL}, {BALL, {4, 5, 0.5}, {3, 4, 0}, true, .radius = 5}, 3}, FMB_TOUCHING, {0, 0}},
    {"a ball leaves as fast as it can", {{CUBE, {0}, STILL}, {BALL, {4, 5, 0.5}, {4, -3, 0}, true, .radius = 5}, 3}, FMB_TOUCHING, {0, 0}},
    {"equal velocities", {{BALL, {0}, {1, 2, 3}, true, .radius = 2}, {BALL, {2, 3, 6}, {1, 2, 3}, true, .radius = 5}, 3}, FMB_TOUCHING, {0, 3}},
    {"no time", {{BALL, {0}, {1, 2, 3}, true, .radius = 2}, {BALL, {2, 3, 6}, STILL, .radius = 5}, 0}, FMB_TOUCHING, {0, 0}},
    {"a disc slides along a square", {{SQUARE, {0}, STILL}, {DISC, {-3, 2}, {1, 0}, true, .radius = 1}, 8}, FMB_TOUCHING, {3, 4}},
};
/* clang-format on */

#endif
