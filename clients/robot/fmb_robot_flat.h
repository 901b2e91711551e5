/* libfmb-robot for languages that call C without a compiler, as fmb_flat.h is for the other
 * libraries, with its rules for arrays, statuses and threads. fmb.py uses it.
 *
 * A function that returns int returns 0, or -1 after an error, which is in the text of the robot or
 * the scene. */
#ifndef FMB_ROBOT_FLAT_H
#define FMB_ROBOT_FLAT_H

#include "fmb_robot.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The number of this interface; see FMB_FLAT_ABI. */
enum { FMB_ROBOT_FLAT_ABI = 1 };
int fmb_robot_flat_abi(void);

/* As fmb_robot_read() with these options. base: [6]. */
int fmb_robot_flat_read(const char *path, const char *srdf, const char *package_path,
                        const double *base, int sides, double excess, int objects,
                        struct fmb_robot **out);

/* A scene of a JSON file, or of a robot. */
struct fmb_robot_flat;

/* Reads the only scene of a JSON file, whose bodies may have links.
 * Out: *out  set in any case, for fmb_robot_flat_why(); to be freed */
int fmb_robot_flat_json(const char *path, struct fmb_robot_flat **out);

/* Makes the scene of a robot among bodies, as fmb_robot_scene().
 * In:  placements  [count], an array of struct fmb_placement: fmb_flat_placements()
 *      links       [count], of carried bodies; NULL for the others
 *      margin      of the world
 *      ignored     [ignored_count][2], indices of placements
 *      names       [name_count][2], pairs that are not tested
 * Out: *out        set in any case; to be freed before the robot and the bodies */
int fmb_robot_flat_make(const struct fmb_robot *robot, const void *placements,
                        const char *const *links, size_t count, double margin,
                        const int64_t *ignored, size_t ignored_count, const char *const *names,
                        size_t name_count, struct fmb_robot_flat **out);
void fmb_robot_flat_free(struct fmb_robot_flat *flat); /* may be NULL */
const char *fmb_robot_flat_why(struct fmb_robot_flat *flat);

/* Out: counts    dimension; numbers of placements, of their frames, of the numbers of these, and of
 *                ignored pairs
 *      settings  duration and margin */
void fmb_robot_flat_counts(const struct fmb_robot_flat *flat, int64_t counts[5],
                           double settings[2]);

/* Copies a scene, as fmb_flat_body_make() and fmb_flat_scene_make() take it. Each array may be
 * NULL, those of frames only together.
 * Out: frames      [placements], how many each has
 *      shapes      of all frames, in their order; so are counts and numbers
 *      ids         [placements]; so are groups
 *      names       [placements], NULL: none; so are links; valid as long as the scene
 *      velocities  [placements][dim]
 *      ignored     [ignored][2] */
void fmb_robot_flat_copy(const struct fmb_robot_flat *flat, int64_t *frames, int32_t *shapes,
                         int64_t *counts, double *numbers, int64_t *ids, int64_t *groups,
                         const char **names, const char **links, double *velocities,
                         int64_t *ignored);

/* Returns the placements, for fmb_flat_take(). */
const void *fmb_robot_flat_placements(const struct fmb_robot_flat *flat);

/* As fmb_robot_place(); then calls take with the scene and the placements that moved. take:
 * fmb_flat_take(). */
int fmb_robot_flat_place(struct fmb_robot_flat *flat, const double *q,
                         void (*take)(void *scene, const void *placements, size_t count),
                         void *scene);

#ifdef __cplusplus
}
#endif
#endif
