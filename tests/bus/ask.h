/* What the benchmark of the bus asks. */
#ifndef ASK_H
#define ASK_H

#include "bus_bench.h"
#include "scene.h"

/* The pair of clients/demo/cube.json: a cuboid at rest, a tetrahedron that moves; verdict and
 * interval. Held by the service, or made to be new each time. */
void ask_pair(struct bus_bench *bench, enum form form, struct datagram *out);

/* A scene of cuboids and tetrahedra in 3D, half of them each, with pairs of one of each, listed in
 * random order, half of which are in contact. */
struct ask_scene {
    struct scene scene;
    struct pairs pairs;
    bool moving;
};
struct ask_scene ask_scene_draw(int bodies, bool moving, size_t pairs, uint64_t seed);
void ask_scene_free(struct ask_scene *scene);

/* The query of a scene. On input: which is QUERY_PAIRS_LISTED or QUERY_PAIRS_ALL; want its bits.
 * Of the pairs listed, as many as query and result have room for, at most as many as there are.
 * Returns how many pairs it asks. */
size_t ask_scene(struct bus_bench *bench, const struct ask_scene *scene, enum form form,
                 int32_t which, int32_t want, struct datagram *out);

#endif
