/* Writes proofs of paths for fmb-check-path, which describes their form: JSON lines, compressed.
 * Robot, world and rows in numbers that are exact, then for each edge and pair the intervals, each
 * with its direction in as few bits as prove it. Bodies are parts: frames of placements. */
#ifndef PATH_PROOF_H
#define PATH_PROOF_H

#include "path.h"

#include <zlib.h>

struct path_proof {
    gzFile file;
    int64_t lines;
    bool failed;
};

/* Begins a proof on a stream, which remains the caller's. */
bool path_proof_begin(FILE *file, struct path_proof *out);

/* In this order: the robot and the bodies; all rows, of the values of all joints; the pairs. */
void path_proof_bodies(struct path_proof *proof, const struct fmb_robot_path *path);
void path_proof_row(struct path_proof *proof, const struct fmb_robot_path *path,
                    const double *value);
void path_proof_pairs(struct path_proof *proof, const struct fmb_robot_path *path);

/* Then every edge, with its answer. The path has `recorded` set. */
void path_proof_edge(struct path_proof *proof, struct fmb_robot_path *path, size_t number,
                     const struct fmb_robot_edge *answer);

/* Ends the proof. Returns false after an error of any of these. */
bool path_proof_end(struct path_proof *proof);

/* Compares the robot, the bodies and the pairs of a proof with those of a path. Out: *rows: how
 * many it has. Returns NULL; or what is wrong, and *line: where, or 0 if the file cannot be read.
 */
const char *path_proof_compare(const char *file, const struct fmb_robot_path *path, size_t *rows,
                               size_t *line);

#endif
