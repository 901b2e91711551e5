/* The queries of the benchmark of the bus. */
#ifndef WORKLOAD_H
#define WORKLOAD_H

#include "bus_bench.h"
#include "bench_scene.h"

/* The pair of clients/demo/cube.json: a cuboid at rest, a tetrahedron that moves; verdict and
 * interval. */
void workload_pair(struct bus_bench *bench, enum form form, struct datagram *out);

/* A scene of cuboids and tetrahedra in 3D, half of them each, with pairs of one of each in random
 * order, half of which are in contact. */
struct workload_scene {
    struct scene scene;
    struct pairs pairs;
};
struct workload_scene workload_scene_draw(int bodies, size_t pairs, uint64_t seed);
void workload_scene_free(struct workload_scene *scene);

/* The query of a scene: as many of the pairs as query and result have space for. Returns the number
 * of pairs of the query. */
size_t workload_scene(struct bus_bench *bench, const struct workload_scene *scene, enum form form,
                      struct datagram *out);

#endif
