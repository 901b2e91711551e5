/* Answers queries: checks a query, finds its bodies in the cache or adds them, and decides.
 *
 * Uses neither LCM nor a clock: the same queries in the same order get the same results. A
 * definition query is answered by one call, a pair or scene query in steps (a job), so that the
 * caller can do other work between them. An answerer and its jobs may be used by one thread at a
 * time; answerers share no state. Functions without a word on errors cannot fail. Only create
 * functions allocate, apart from GMP and GLib (handle.h). */
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

/* Answers a definition query with as many bodies as fit into one result; its field next is where
 * the next page begins. Neither counts nor pins these bodies. The bodies of the result belong
 * to the cache, and are valid until a body is added. */
void answer_definition(struct answerer *answerer, const struct definition_query *query,
                       struct definition *result);

enum answer_kind { ANSWER_PAIR, ANSWER_SCENE, ANSWER_DEFINITION };

/* Refuses a query without a check, for example as FMB_BUSY. On input: the message, of any size. Of
 * a scene or definition query only the header is read. On output: the encoded result, of *out_size
 * bytes. Returns NULL; or a static text of what is wrong with the bytes. */
const char *answer_refused(struct answerer *answerer, enum answer_kind kind,
                           const unsigned char *bytes, size_t size, enum fmb_status status,
                           unsigned char out[QUERY_BYTES_MAX], size_t *out_size);

/* ---- Jobs ---- */

/* Answers one pair or scene query at a time. One answerer may have several jobs. The order of
 * calls: answer_job_begin(), answer_job_step() until it returns true or answer_job_stop(), then the
 * result. */
struct answer_job;

/* Allocates 5 MB of memory. Only large scenes touch most of it. Returns NULL if out of memory.
 * answer_job_destroy() accepts NULL, and a job in progress. */
struct answer_job *answer_job_create(void);
void answer_job_destroy(struct answer_job *job);

/* The message of the job, ANSWER_MESSAGE_MAX bytes: of the query in progress, or to be filled in
 * for the next one. */
enum { ANSWER_MESSAGE_MAX = 65536 };
unsigned char *answer_job_message(struct answer_job *job);

/* Begins to answer a message of size bytes, which is copied unless it is answer_job_message(); a
 * query in progress is abandoned. On input: ANSWER_PAIR or ANSWER_SCENE. Returns NULL; or a static
 * text of what is wrong with the bytes (wire.h), and the job is idle. */
const char *answer_job_begin(struct answer_job *job, enum answer_kind kind,
                             const unsigned char *bytes, size_t size);

/* Checks the query; or finds a few bodies; or makes a few frames; or decides one block of pairs in
 * doubles, or one pair of frames in exact arithmetic, or performs one step of a pair with a hull or
 * a radius, or of a certificate. Usually takes microseconds, a millisecond for the worst block, and
 * milliseconds for the worst pair (fmb.h). A query that is refused gets a status and a detail that
 * names the field, such as "b.numbers[4]: not a finite number"; it adds no body to the cache. On
 * input: a job that was begun; the same answerer in each step of a query, which must exist until
 * the query is complete or abandoned. Returns whether the result is complete. */
bool answer_job_step(struct answer_job *job, struct answerer *answerer);

/* Whether the remaining steps only decide one pair of frames, neither a hull nor with a radius. On
 * input: a pair query that two steps have not completed. */
bool answer_job_is_short(const struct answer_job *job);

/* Whether at least one pair of a scene has been answered. */
bool answer_job_has_answers(const struct answer_job *job);

/* Completes the result with the pairs answered so far; if there are none, its status is FMB_BUSY.
 * On input: a job after its first step that is not complete. */
void answer_job_stop(struct answer_job *job);

/* The placements of the query, as decoded; *count of them. Owned by the job, and valid until the
 * next answer_job_begin(). */
const struct query_placement *answer_job_placements(const struct answer_job *job, int32_t *count);

/* The result: of a pair, or of a scene. On input: a job whose result is complete. Its compute_ns is
 * 0. Owned by the job, and valid until the next answer_job_begin(). A certificate is present if it
 * was wanted and fits. */
const struct pair_result *answer_job_pair_result(const struct answer_job *job);
const struct scene_result *answer_job_scene_result(const struct answer_job *job);

/* Encodes the result, of either kind. On input: a job whose result is complete. On output: *status:
 * its status. Returns its size. */
size_t answer_job_write(struct answer_job *job, int64_t compute_ns,
                        unsigned char out[QUERY_BYTES_MAX], int32_t *status);

/* Number of pairs that got a verdict, including those that the broad phase separated, without
 * ignored pairs and pairs that the method cannot decide. On input: a job whose result is complete.
 */
int32_t answer_job_decided(struct answer_job *job);

#endif
