/* libfmb and libfmb-client for languages that call C without a compiler. Arguments are numbers,
 * flat arrays and opaque handles; no bool and no callback crosses this interface, and of structs
 * only pointers. fmb.py uses it. fmb.h and fmb_client.h define what the numbers mean.
 *
 * Arrays are row-major and owned by the caller, who may change them after the call. dim is the
 * dimension of the bodies, 2 or 3.
 *
 * Status: a function that returns int returns FMB_OK (0) or a value of enum fmb_status (positive)
 * or enum fmb_client_status (negative).
 *
 * Threads: a scene or a client may be used by one thread at a time. Bodies are only read, so
 * threads may share them. */
#ifndef FMB_FLAT_H
#define FMB_FLAT_H

#include "fmb.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The number of this interface. It is raised when a function changes or is removed. fmb_flat_abi()
 * returns the number of the library. */
enum { FMB_FLAT_ABI = 4 };
int fmb_flat_abi(void);

/* ---- Bodies ---- */

/* Makes a body of one frame.
 * In:  shape    a value of placement_t.shapes
 *      numbers  [count], in the order of placement_t.numbers
 * Out: *out     set only if the status is FMB_OK; to be freed after the scenes that use it
 * Returns a status of fmb_frame_make(), fmb_frame_make_vertices(), fmb_frame_make_hull() or
 * fmb_frame_inflate(); or NO_MEMORY. */
int fmb_flat_body_make(int dim, int shape, const double *numbers, size_t count,
                       const struct fmb_body **out);

/* Makes a body of the frames of others, in their order; parts: [count], which must outlive it.
 * Returns a status of fmb_body_make_frames(), or NO_MEMORY; *out as above. */
int fmb_flat_body_join(const struct fmb_body *const *parts, size_t count,
                       const struct fmb_body **out);

/* Frees a body that was made by the functions above. May be NULL. */
void fmb_flat_body_free(const struct fmb_body *body);

/* Makes a hull that contains a cylinder about z, centred at 0.
 * In:  radius, length  finite, 0 or more
 *      sides           a multiple of 4, from 4 to 512
 * Out: vertices        [2 * sides][3]
 * Returns how far it extends beyond the cylinder at most: radius (1 / cos(pi / sides) - 1). */
double fmb_flat_cylinder(double radius, double length, int sides, double *vertices);

/* ---- A scene: placed bodies, and the last answers ---- */

struct fmb_flat_scene;

/* Makes a scene of bodies at the origin, not rotated and at rest.
 * In:  bodies  [count], of one dimension; they must outlive the scene
 *      ids     [count], 0 to 2^53 - 1
 *      groups  [count]
 *      names   [count]; NULL for a body without a name
 *      ignored [ignored_count][2], pairs that fmb_flat_decide() ignores unless it is given a list
 * Out: *out    set unless the status is NO_MEMORY, for fmb_flat_why(); to be freed
 * Returns FMB_OK, FMB_NO_FRAMES (count is 0), FMB_DIMENSIONS_DIFFER, FMB_BAD_ID, FMB_BAD_NAME,
 * FMB_BAD_PAIR, FMB_OVER_LIMIT (2^31 bodies), or NO_MEMORY. */
int fmb_flat_scene_make(size_t count, const struct fmb_body *const *bodies, const int64_t *ids,
                        const int64_t *groups, const char *const *names, const int64_t *ignored,
                        size_t ignored_count, struct fmb_flat_scene **out);
void fmb_flat_scene_free(struct fmb_flat_scene *scene); /* may be NULL */

/* Returns the placements. */
const struct fmb_placement *fmb_flat_placements(const struct fmb_flat_scene *scene);

/* Copies poses and ends of the first count elements of such an array to the placements of the
 * scene. They must be valid. */
void fmb_flat_take(struct fmb_flat_scene *scene, const struct fmb_placement *placements,
                   size_t count);

/* Returns what was wrong in the last call that failed: "positions[3]: not a finite number". */
const char *fmb_flat_why(const struct fmb_flat_scene *scene);

/* Sets poses and motions of placements first to first + count - 1; changes none after an error.
 * Setting velocities removes the ends of these placements; setting ends removes their velocities. A
 * part of the end that was never set equals the pose at the start.
 * In:  positions         [count][dim], or NULL: unchanged
 *      orientations      [count][4], in 2D [count][2], or NULL: unchanged
 *      velocities        [count][dim], per second, or NULL: unchanged
 *      end_positions     [count][dim], or NULL: unchanged
 *      end_orientations  [count][4], in 2D [count][2], or NULL: unchanged
 * Returns FMB_OK, FMB_NOT_FINITE, FMB_BAD_ORIENTATION, FMB_WRONG_COUNT (velocities and ends), or
 * FMB_BAD_PAIR (no such placements). */
int fmb_flat_place(struct fmb_flat_scene *scene, size_t first, size_t count,
                   const double *positions, const double *orientations, const double *velocities,
                   const double *end_positions, const double *end_orientations);

struct fmb_client;

/* Decides one pair, and keeps the answer in the scene, as the only one. Groups are not considered.
 * In:  client  NULL: in process, as fmb_decide(); or as fmb_client_query_pair()
 *      want    a sum of FMB_WANT_BOX, FMB_WANT_POINT and FMB_WANT_GAP; contacts are always given
 * Returns a status of these functions; FMB_BAD_PAIR if a or b is not a placement, or a == b. */
int fmb_flat_pair(struct fmb_flat_scene *scene, struct fmb_client *client, int64_t a, int64_t b,
                  double duration, unsigned want);

/* Decides pairs, and keeps answers in the scene until the next call: with a list, of each of its
 * pairs; without a list, of the pairs that touch, overlap, are near, or have no verdict. In
 * process, if only the first placements have changed since the last call, the preparation of the
 * others is reused (fmb_scene_again()).
 * In:  client   NULL: in process; or as fmb_client_query()
 *      instant  not 0: the window is [0, 0] even if bodies move
 *      want     a sum of FMB_WANT_TIMES, FMB_WANT_BOX, FMB_WANT_POINT and FMB_WANT_GAP
 *      split    pairs of the first split placements with the others; negative: all pairs
 *      pairs    [pair_count][2], a list, with which split is not read; NULL: no list
 *      ignored  [ignored_count][2], in addition to those of the scene; not with a list
 *      label    of the scene, or NULL
 * Returns a status of fmb_scene_check() or fmb_client_query(); FMB_BAD_NAME (of the label); or
 * NO_MEMORY. */
int fmb_flat_decide(struct fmb_flat_scene *scene, struct fmb_client *client, double duration,
                    int instant, unsigned want, double margin, int64_t split, const int64_t *pairs,
                    size_t pair_count, const int64_t *ignored, size_t ignored_count,
                    const char *label);

/* As fmb_flat_decide() of all pairs, in process, without a label. Returns the number of answers; -1
 * after an error, for whose status fmb_flat_decide() has to be called. */
int64_t fmb_flat_decide_all(struct fmb_flat_scene *scene, double duration, int instant,
                            unsigned want, double margin);

/* Returns the number of answers that the scene keeps. */
size_t fmb_flat_count(const struct fmb_flat_scene *scene);

/* Copies the n answers to data, which is aligned for doubles: the arrays below that were wanted,
 * in this order and without space between them. A margin other than 0 requests gaps too.
 *
 *     pairs       int64 [n][a, b]; absent after a list, and after fmb_flat_pair()
 *     contacts    double [n][first, last], NAN unless they meet
 *     boxes       double [n][lower, upper][dim], NAN unless they meet
 *     points      double [n][time, coordinates], NAN unless they meet
 *     gaps        double [n][lower, upper bound], NAN if there is none; the row of that pair
 *                 is then undefined in the next four arrays
 *     directions  double [n][dim]
 *     times       double [n], NAN unless there are witness points
 *     witnesses   double [n][of a, of b][dim], NAN unless there are witness points
 *     frames      int64 [n][of a, of b], indices of the frames that have this gap
 *     statuses    int32 [n], FMB_OK, or why there is no verdict
 *     verdicts    uint8 [n], enum fmb_verdict; 0: none
 */
void fmb_flat_pack(const struct fmb_flat_scene *scene, void *data);

#ifdef __cplusplus
}
#endif
#endif
