/* Query in, result out: checks a query, finds or keeps its bodies, and decides.
 *
 * Uses neither LCM nor a clock: the same queries in the same order get the same results. Pair and
 * definition queries are answered by one call; a scene in steps, so that the caller can do other
 * work between them. */
#ifndef ANSWER_H
#define ANSWER_H

#include "cache.h"
#include "query.h"

#include <stdbool.h>

struct answerer;

struct answerer_options {
    size_t frames; /* capacity of the cache, see cache_create() */
    int64_t server_id;
    uint64_t secret[2]; /* random */
};

/* Allocates all memory that answers need, except GMP's. NULL: out of memory. */
struct answerer *answerer_create(const struct answerer_options *options);
void answerer_destroy(struct answerer *answerer); /* may be NULL */

struct cache *answerer_cache(struct answerer *answerer);

/* Answers a pair query. The result is complete except for compute_ns (0). A query that is refused
 * gets a status and a detail that names the place: "b.numbers[4]: not a finite number"; it leaves
 * the cache unchanged. A certificate is present if it was wanted and fits; it is valid until the
 * next call. One call decides at most one pair of frames. Returns false, and nothing is done, if a
 * body has several frames: the query needs a pair job. */
bool answer_pair(struct answerer *answerer, const struct pair_query *query,
                 struct pair_result *result);

/* Answers a definition query with as many bodies as fit into one result; next is where the next
 * page begins. Neither counts these bodies nor marks them as used. The geometries of the result
 * belong to the cache, and are valid until a body is added. */
void answer_definition(struct answerer *answerer, const struct definition_query *query,
                       struct definition *result);

/* The result of a query that is refused unchecked, for example as busy. */
void answer_pair_refused(const struct answerer *answerer, const struct pair_query *query,
                         enum fmb_status status, struct pair_result *result);
void answer_scene_refused(const struct answerer *answerer, const struct query_header *query,
                          enum fmb_status status, struct scene_result *result);
void answer_definition_refused(const struct answerer *answerer, const struct query_header *query,
                               enum fmb_status status, struct definition *result);

/* ---- Pairs in steps ---- */

/* A pair query of any bodies in progress. One answerer may have several. */
struct pair_job;

/* Takes 1.5 MB of memory. Only bodies of many frames touch most of it. NULL: out of memory. */
struct pair_job *pair_job_create(void);
void pair_job_destroy(struct pair_job *job); /* may be NULL, or in progress */

/* Begins to answer a message, which is copied: checks it and finds or keeps its bodies. On input: a
 * job that is not in progress. Returns NULL, and the job is in progress until its result is taken;
 * or what is wrong with the bytes (wire_read_pair_query()). */
const char *pair_job_begin(struct pair_job *job, struct answerer *answerer,
                           const unsigned char *bytes, size_t size);

/* Does the next part of the work: one block of pairs of frames in doubles, or one pair of frames in
 * exact arithmetic. Returns whether the result is complete. */
bool pair_job_step(struct pair_job *job);

/* The result as of answer_pair(); it ends the job. Where it is not complete, its status is BUSY.
 * Valid until the next query. */
struct pair_result *pair_job_end(struct pair_job *job, struct answerer *answerer);

/* ---- Scenes ---- */

/* A scene in progress. One answerer may have several. */
struct scene_job;

/* Takes 4 MB of memory. Only large scenes touch most of it. NULL: out of memory. */
struct scene_job *scene_job_create(void);
void scene_job_destroy(struct scene_job *job); /* may be NULL, or in progress */

/* Begins to answer a message, which is copied; a query in progress is abandoned. The answerer of
 * the steps has to exist until the job is complete or destroyed. Returns NULL; or what is wrong
 * with the bytes (wire_read_scene_query()), and the job is idle. */
const char *scene_job_begin(struct scene_job *job, const unsigned char *bytes, size_t size);

/* Does the next part of the work: a few bodies, one block of pairs in doubles, or one pair of
 * frames in exact arithmetic. Usually takes microseconds, a millisecond for the worst block.
 * Returns whether the result is complete. On input: a job that has begun. */
bool scene_job_step(struct scene_job *job, struct answerer *answerer);

/* Whether at least one pair has been answered. */
bool scene_job_has_answers(const struct scene_job *job);

/* Completes the result with the pairs answered so far; if there are none, its status is BUSY. On
 * input: a job that has made a step and is not complete. */
void scene_job_stop(struct scene_job *job);

const struct scene_query *scene_job_query(const struct scene_job *job);

/* The complete result; compute_ns is 0 and may be set. */
struct scene_result *scene_job_result(struct scene_job *job);

#endif
