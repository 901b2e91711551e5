/* Queries of a made-up log, replayed onto a page. Each is answered by the service's own code; its
 * answer is the result of the replay and, unless the caller alters it, the recorded one. */
#ifndef SAMPLE_LOG_H
#define SAMPLE_LOG_H

#include "answer.h"
#include "page.h"

struct sample_log {
    struct page *page;
    struct answerer *answerer;
    struct answer_job *job;
    const char *log;                     /* path on the page */
    int64_t utime, event_number, offset; /* of the next query */
    /* Alters the recorded result of the next query, which makes its outcome DIFFERENT; NULL: none.
     * Reset by the query. */
    void (*alter_pair)(struct pair_result *then);
    void (*alter_scene)(struct scene_result *then);
    /* Of the next pair query: SAME, or one without a comparison. Reset by the query. */
    enum replay_outcome outcome;
};

/* On output: a page with this title, which begins on a fixed day. Aborts without memory. */
void sample_begin(struct sample_log *log, const char *title);

/* Writes the page and releases everything. Returns whether the writing succeeded. */
bool sample_end(struct sample_log *log, FILE *out);

/* Placements that have a handle are sent without their geometry, which the page still gets: so a
 * replay shows bodies that the log defines elsewhere. */
void sample_pair(struct sample_log *log, const struct pair_query *query);
void sample_scene(struct sample_log *log, const struct scene_query *query);

/* Seconds until the next query. */
void sample_wait(struct sample_log *log, double seconds);

/* A body at rest. components: dim * dim numbers, of a face 6; position: dim numbers. The geometry
 * stays valid until SAMPLE_BODIES_MAX others have been made. */
enum { SAMPLE_BODIES_MAX = 2 * QUERY_PLACEMENTS_MAX };
struct query_placement sample_body(int64_t id, int dim, enum fmb_shape shape,
                                   const double *components, const double *position);

/* A cube, square, tetrahedron or triangle along the axes, of this size. */
struct query_placement sample_solid(int64_t id, int dim, enum fmb_shape shape, double size,
                                    const double *position);

void sample_move(struct query_placement *placement, const double *velocity);

/* Makes the service hold the body, and gives the placement its handle. */
void sample_define(struct sample_log *log, struct query_placement *placement);

#endif
