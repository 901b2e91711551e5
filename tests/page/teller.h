/* Makes up a log of queries for a page: answers each as the service does, takes that for the result
 * of now, and for the one of then too, unless the test says what was different. */
#ifndef TELLER_H
#define TELLER_H

#include "answer.h"
#include "page.h"

struct teller {
    struct page *page;
    struct answerer answerer;
    const char *log;
    int64_t utime, event_number, offset; /* of the next query */
    /* Changes what was recorded of the next query, and is forgotten then; or NULL. */
    void (*spoil_pair)(struct pair_result *then);
    void (*spoil_scene)(struct scene_result *then);
    enum replay_outcome outcome; /* of the next query: SAME, or BUSY, UNKNOWN, ALONE */
};

/* On output: a page with this title; utime is a fixed day. */
void teller_begin(struct teller *teller, const char *title);

/* Writes the page. Returns whether all was well. */
bool teller_end(struct teller *teller, FILE *out);

void teller_pair(struct teller *teller, const struct pair_query *query);
void teller_scene(struct teller *teller, const struct scene_query *query);

/* Seconds until the next query. */
void teller_wait(struct teller *teller, double seconds);

/* A frame at rest. components: dim * dim numbers, of a face 6. */
struct query_frame teller_frame(int64_t id, int dim, enum fmb_shape shape, const double *components,
                                const double *origin);

/* A cube, a square, or a tetrahedron or triangle of this size. */
struct query_frame teller_solid(int64_t id, int dim, enum fmb_shape shape, double size,
                                const double *origin);

void teller_move(struct query_frame *frame, const double *velocity);

#endif
