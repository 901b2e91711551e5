/* What fuzzing begins with: files in FOLDER/TARGET/. */
#ifndef SEEDS_H
#define SEEDS_H

#include "query.h"

#include <stddef.h>
#include <stdint.h>

/* Ends the program where the file cannot be written. */
void seeds_write(const char *target, const char *name, const unsigned char *bytes, size_t size);

/* One or more targets each. */
void seeds_messages(void);
void seeds_talks(void);
void seeds_replays(void);
void seeds_logs(void);
void seeds_meshes(void);
void seeds_robots(void);

/* ---- Queries, for messages, talks and replays ---- */

/* A body that spans the unit vectors, at x = y = z = at; moves along x where speed is not 0. Its
 * geometry is valid to the end of the program. */
struct query_placement seeds_placement(int64_t id, int shape, int dim, double at, double speed);

/* The same with other components; of a box the full size. */
struct query_placement seeds_body(int64_t id, int shape, int dim, const double *components);

struct handle seeds_handle(const struct query_placement *placement);

/* The same body by handle only. */
struct query_placement seeds_by_handle(struct query_placement placement);

/* Sequence numbers ascend from call to call. */
struct pair_query seeds_pair(struct query_placement a, struct query_placement b, int32_t method,
                             int32_t want);

/* Pairs of all shapes, methods and wants, turned and of several frames. */
enum { SEEDS_PAIRS = 12 };
struct pair_query seeds_pair_number(int i);
const char *seeds_pair_name(int i);

/* Placements of all shapes; 2D where their number is odd. Valid until the next call. */
const struct scene_query *seeds_scene(int placements, int32_t which, int32_t want);

#endif
