/* Answers queries: checks a query, finds its bodies in the cache or adds them, and decides.
 *
 * Uses neither LCM nor a clock: the same queries in the same order get the same results. A pair of
 * bodies of one frame, or a definition query, is answered by one call. Scenes, and pairs of bodies
 * of several frames, are answered in steps (jobs), so that the caller can do other work between
 * them. An answerer and its jobs may be used by one thread at a time; answerers share no state.
 * Functions without a word on errors cannot fail. Only create functions allocate, apart
 * from GMP and the hasher (handle.h). */
#ifndef ANSWER_H
#define ANSWER_H

#include "cache.h"
#include "query.h"

#include <stdbool.h>

struct answerer;

struct answerer_options {
    size_t frames; /* capacity of the cache, see cache_create() */
    int64_t server_id;
    uint64_t secret[2]; /* random; see cache_create() */
};

/* Returns NULL if out of memory. The caller destroys it after its jobs; answerer_destroy() accepts
 * NULL. */
struct answerer *answerer_create(const struct answerer_options *options);
void answerer_destroy(struct answerer *answerer);

/* The cache of the answerer, which owns it. */
struct cache *answerer_cache(struct answerer *answerer);

/* Answers a pair query. On input: a decoded query, unchecked. On output: the result is complete
 * except for compute_ns (0). A query that is refused gets a status and a detail that names the
 * field, such as "b.numbers[4]: not a finite number"; it adds no body to the cache. A certificate
 * is present if it was wanted and fits; it is valid until the next call. One call decides at most
 * one pair of frames. Returns false, and does nothing else, if a body has several frames: the query
 * needs a pair job. */
bool answer_pair(struct answerer *answerer, const struct pair_query *query,
                 struct pair_result *result);

/* Answers a definition query with as many bodies as fit into one result; its field next is where
 * the next page begins. Neither counts nor pins these bodies. The geometries of the result belong
 * to the cache, and are valid until a body is added. */
void answer_definition(struct answerer *answerer, const struct definition_query *query,
                       struct definition *result);

/* Write the result of a query that is refused without a check, for example as FMB_BUSY. */
void answer_pair_refused(const struct answerer *answerer, const struct pair_query *query,
                         enum fmb_status status, struct pair_result *result);
void answer_scene_refused(const struct answerer *answerer, const struct query_header *query,
                          enum fmb_status status, struct scene_result *result);
void answer_definition_refused(const struct answerer *answerer, const struct query_header *query,
                               enum fmb_status status, struct definition *result);

/* ---- Pairs in steps ---- */

/* Answers one pair query at a time, of any bodies. One answerer may have several jobs. The order of
 * calls: pair_job_begin(), pair_job_step() until it returns true, pair_job_end(). */
struct pair_job;

/* Allocates 1.5 MB of memory. Only bodies of many frames touch most of it. Returns NULL if out of
 * memory. pair_job_destroy() accepts NULL, and a job in progress. */
struct pair_job *pair_job_create(void);
void pair_job_destroy(struct pair_job *job);

/* Begins to answer a message of size bytes, which is copied: checks it, and finds the bodies that
 * it gives by handle. On input: a job that is not in progress. Returns NULL, and the job is in
 * progress until pair_job_end(), even if the query was refused; or a static text of what is wrong
 * with the bytes (wire_read_pair_query()). */
const char *pair_job_begin(struct pair_job *job, struct answerer *answerer,
                           const unsigned char *bytes, size_t size);

/* Makes a few frames of its bodies; or decides one block of pairs of frames in doubles, or one pair
 * of frames in exact arithmetic. Returns whether the result is complete. On input: a job in
 * progress. */
bool pair_job_step(struct pair_job *job);

/* Ends the job and releases its bodies. Returns its result, as of answer_pair() but without a
 * certificate; if it is not complete, its status is FMB_BUSY. Owned by the job, and valid until its
 * next query. */
struct pair_result *pair_job_end(struct pair_job *job, struct answerer *answerer);

/* ---- Scenes ---- */

/* Answers one scene query at a time. One answerer may have several jobs. The order of calls:
 * scene_job_begin(), scene_job_step() until it returns true or scene_job_stop(),
 * scene_job_result(). */
struct scene_job;

/* Allocates 4 MB of memory. Only large scenes touch most of it. Returns NULL if out of memory.
 * scene_job_destroy() accepts NULL, and a job in progress. */
struct scene_job *scene_job_create(void);
void scene_job_destroy(struct scene_job *job);

/* Begins to answer a message of size bytes, which is copied; a query in progress is abandoned.
 * Returns NULL; or a static text of what is wrong with the bytes (wire_read_scene_query()), and the
 * job is idle. */
const char *scene_job_begin(struct scene_job *job, const unsigned char *bytes, size_t size);

/* Checks the query; or finds a few bodies; or makes a few frames; or decides one block of pairs in
 * doubles, or one pair of frames in exact arithmetic. Usually takes microseconds, a millisecond for
 * the worst block, and milliseconds for the worst pair (fmb.h). On input: a job that was begun; the
 * same answerer in each step of a query, which must exist until the query is complete or abandoned.
 * Returns whether the result is complete. */
bool scene_job_step(struct scene_job *job, struct answerer *answerer);

/* Whether at least one pair has been answered. */
bool scene_job_has_answers(const struct scene_job *job);

/* Completes the result with the pairs answered so far; if there are none, its status is FMB_BUSY.
 * On input: a job after its first step that is not complete. */
void scene_job_stop(struct scene_job *job);

/* The query, as decoded. Owned by the job, and valid until the next scene_job_begin(). */
const struct scene_query *scene_job_query(const struct scene_job *job);

/* The result. On input: a job whose result is complete. compute_ns is 0 and may be set. Owned by
 * the job, and valid until the next scene_job_begin(). */
struct scene_result *scene_job_result(struct scene_job *job);

/* Number of pairs that got a verdict, including those that the broad phase separated, without
 * ignored pairs and pairs that the method cannot decide. On input: as for scene_job_result(). */
int32_t scene_job_decided(struct scene_job *job);

#endif
