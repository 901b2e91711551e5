/* libfmb and libfmb-client for languages that call C without a compiler. Arguments are numbers,
 * flat arrays and opaque handles; no struct, no bool and no callback crosses this interface. fmb.py
 * uses it. fmb.h and fmb_client.h define what the numbers mean.
 *
 * Arrays are row-major and owned by the caller, who may change them after the call. dim is that of
 * the bodies, 2 or 3.
 *
 * Status: a function that returns int returns FMB_OK (0) or a value of enum fmb_status (positive)
 * or enum fmb_client_status (negative).
 *
 * Threads: a scene or a client may be used by one thread at a time. Bodies are only read, so
 * threads may share them. */
#ifndef FMB_FLAT_H
#define FMB_FLAT_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The number of this interface. It is raised when a function changes or is removed. fmb_flat_abi()
 * returns that of the library. */
enum { FMB_FLAT_ABI = 2 };
int fmb_flat_abi(void);

/* ---- Bodies ---- */

struct fmb_flat_body;

/* Makes a body.
 * In:  count    number of frames
 *      shapes   [count], values of placement_t.shapes
 *      counts   [count]: how many of the numbers each frame has
 *      numbers  frame after frame, in the order of placement_t.numbers
 * Out: *out     set only if the status is FMB_OK; to be freed after the scenes that use it
 * Returns a status of fmb_frame_make(), fmb_frame_make_vertices(), fmb_frame_make_hull(),
 * fmb_frame_inflate() or fmb_body_make_frames(); or NO_MEMORY. */
int fmb_flat_body_make(int dim, size_t count, const int32_t *shapes, const int64_t *counts,
                       const double *numbers, struct fmb_flat_body **out);
void fmb_flat_body_free(struct fmb_flat_body *body); /* may be NULL */

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
 * Out: *out    set unless the status is NO_MEMORY, for fmb_flat_why(); to be freed
 * Returns FMB_OK, FMB_NO_FRAMES (count is 0), FMB_DIMENSIONS_DIFFER, FMB_BAD_ID, FMB_BAD_NAME,
 * FMB_OVER_LIMIT (2^31 bodies), or NO_MEMORY. */
int fmb_flat_scene_make(size_t count, struct fmb_flat_body *const *bodies, const int64_t *ids,
                        const int64_t *groups, const char *const *names,
                        struct fmb_flat_scene **out);
void fmb_flat_scene_free(struct fmb_flat_scene *scene); /* may be NULL */

/* Sets the pairs of a scene that fmb_flat_decide() ignores whenever it decides no list; called
 * once.
 * In:  pairs  [count][2]
 * Returns FMB_OK, FMB_BAD_PAIR or NO_MEMORY. */
int fmb_flat_scene_ignore(struct fmb_flat_scene *scene, const int64_t *pairs, size_t count);

/* Returns the placements, an array of struct fmb_placement. */
const void *fmb_flat_placements(const struct fmb_flat_scene *scene);

/* Copies the poses of the first count elements of such an array, of valid poses, to those of the
 * scene. */
void fmb_flat_take(void *scene, const void *placements, size_t count);

/* In a child process after a fork during which another thread was using the scene: makes the scene
 * usable, without answers. If the thread was in fmb_flat_place() or fmb_flat_take(), the poses of
 * those placements have to be set again. Memory that the thread was using is not freed. */
void fmb_flat_scene_forked(struct fmb_flat_scene *scene);

/* Returns what was wrong in the last call that failed: "positions[3]: not a finite number". */
const char *fmb_flat_why(const struct fmb_flat_scene *scene);

/* Sets poses and velocities of placements first to first + count - 1; after an error, of none.
 * In:  positions     [count][dim], or NULL: unchanged
 *      orientations  [count][4], in 2D [count][2], or NULL: unchanged
 *      velocities    [count][dim], per second, or NULL: unchanged
 * Returns FMB_OK, FMB_NOT_FINITE, FMB_BAD_ORIENTATION, or FMB_BAD_PAIR (no such placements). */
int fmb_flat_place(struct fmb_flat_scene *scene, size_t first, size_t count,
                   const double *positions, const double *orientations, const double *velocities);

struct fmb_client;

/* Decides one pair, and keeps the answer in the scene, as the only one. Groups are not considered.
 * In:  client  NULL: in process, as fmb_decide(); or as fmb_client_query_pair()
 *      want    a sum of FMB_WANT_BOX, FMB_WANT_POINT and FMB_WANT_GAP; contacts are always given
 * Returns a status of these functions; FMB_BAD_PAIR if a or b is not a placement, or a == b. */
int fmb_flat_pair(struct fmb_flat_scene *scene, struct fmb_client *client, int64_t a, int64_t b,
                  double duration, unsigned want);

/* Decides pairs, and keeps the answers in the scene until the next call: of each pair of a list;
 * otherwise of those that touch, overlap, are near, or have no verdict. In process, if only the
 * first placements have moved since the last call and all else is equal, what the others need is
 * kept (fmb_scene_again()).
 * In:  client   NULL: in process; or as fmb_client_query()
 *      instant  not 0: the window is [0, 0] even if bodies move
 *      want     a sum of FMB_WANT_TIMES, FMB_WANT_BOX, FMB_WANT_POINT and FMB_WANT_GAP
 *      split    pairs of the first split placements with the others; negative: all pairs
 *      pairs    [pair_count][2], a list, with which split is not read; NULL: no list
 *      ignored  [ignored_count][2], besides those of the scene; none with a list
 *      label    of the scene, or NULL
 * Returns a status of fmb_scene_check() or fmb_client_query(); FMB_BAD_NAME (of the label); or
 * NO_MEMORY. */
int fmb_flat_decide(struct fmb_flat_scene *scene, struct fmb_client *client, double duration,
                    int instant, unsigned want, double margin, int64_t split, const int64_t *pairs,
                    size_t pair_count, const int64_t *ignored, size_t ignored_count,
                    const char *label);

/* As fmb_flat_decide() of all pairs, in process, without a label; but returns the number of
 * answers, or -1 after an error, whose status fmb_flat_decide() returns. */
int64_t fmb_flat_decide_all(struct fmb_flat_scene *scene, double duration, int instant,
                            unsigned want, double margin);

/* Returns the number of answers that the scene keeps. */
size_t fmb_flat_count(const struct fmb_flat_scene *scene);

/* Copies the answers. Each array may be NULL. Those that were not wanted are unchanged. There are
 * gaps, too, if the margin is not 0.
 * Out: pairs       [n][a, b]; of a list they are not set
 *      verdicts    [n], enum fmb_verdict; 0: none
 *      statuses    [n], FMB_OK, or why there is no verdict; of answers in process, which all have
 *                  one, they are not set
 *      contacts    [n][first, last], NAN unless they meet
 *      boxes       [n][lower, upper][dim], NAN unless they meet
 *      points      [n][time, coordinates], NAN unless they meet
 *      gaps        [n][lower, upper bound], NAN if there is none; the arrays below are then
 *                  undefined
 *      directions  [n][dim]
 *      times       [n], NAN unless there are witness points
 *      witnesses   [n][of a, of b][dim], NAN where there are none
 *      frames      [n][of a, of b], indices of the frames that have this gap */
void fmb_flat_answers(const struct fmb_flat_scene *scene, int64_t *pairs, uint8_t *verdicts,
                      int32_t *statuses, double *contacts, double *boxes, double *points,
                      double *gaps, double *directions, double *times, double *witnesses,
                      int64_t *frames);

/* As fmb_flat_answers(), into one memory.
 * In:  listed  not 0: of a list of pairs
 *      want    as it was wanted; with FMB_WANT_GAP if the margin was not 0
 * Out: data    aligned for doubles: pairs (unless listed), contacts, boxes, points, gaps,
 * directions, times, witnesses and frames, as wanted, then statuses and verdicts, without spaces */
void fmb_flat_pack(const struct fmb_flat_scene *scene, int listed, unsigned want, void *data);

/* ---- The bus ---- */

/* As fmb_client_open() with these options; to be closed with fmb_client_close(). */
struct fmb_client *fmb_flat_open(const char *url, const char *prefix, double timeout, int tries,
                                 double within, char *why, size_t size);

#ifdef __cplusplus
}
#endif
#endif
