/* The data of a page: queries with their results, and the shapes of bodies. */
#ifndef PAGE_EVENT_H
#define PAGE_EVENT_H

#include "json_write.h"
#include "replayed.h"

/* JSON text in memory, escaped for a <script> element. */
struct page_json {
    struct json_writer json; /* the writer of the elements, each on its own line */
    char *bytes;             /* owned; `used` of them, as of the last page_json_flush() */
    size_t used;
};

/* Open a text, and bring bytes up to date. Exit with status 1 if memory is exhausted. */
void page_json_open(struct page_json *out);
void page_json_flush(struct page_json *page);
void page_json_close(struct page_json *page);

/* Bodies in body coordinates, each stored once: a rigid body has the same frames in every query. */
struct page_shapes {
    struct page_json json; /* {"dim": ..., "frames": [[shape, numbers...], ...]}, ... */
    size_t count;
    struct page_shape *shape; /* owned: hash table by encoding; NULL: empty */
};

/* Opens an empty set. Exits with status 1 if memory is exhausted. */
void page_shapes_open(struct page_shapes *out);
void page_shapes_close(struct page_shapes *shapes);

/* Limit on the pairs of one query. Pairs that differ are kept first, then those in contact, then
 * the others. */
enum { PAGE_PAIRS_MAX = 1000 };

/* Writes an object. log: the index of its log. Members:
 *
 *     n o t log is   number of the event, offset (bytes), time (microseconds since 1970), index of
 *                    the log, enum replay_outcome
 *     kind           0 of a pair; of a scene 1 for listed pairs, 2 for all, 3 across
 *     T want         duration in seconds, wants
 *     margin         of a scene, if it has one
 *     first split    of a scene
 *     total          number of pairs of the query
 *     frames         [[id, shape, position, orientation, velocity], ...], the last two empty where
 *                    there are none: index of the shape; or [id, -1, handle], the log does not
 *                    define it; or [id, -2], it cannot be drawn
 *     more_frames    number of placements without space, if any
 *     then now       results or null: {status, says, detail, method, ns}, of scenes {end, count}
 *                    too: end_pair, pairs of each verdict
 *     certificate    1 if the certificates of then and now differ
 *     pairs          [[a, b, then, now], ...], indices of placements; no now where it is the same
 *     more           number of answered pairs that were left out, if any
 *
 * Then and now of a pair: null where the result does not answer it, a verdict, or [verdict, first,
 * last] or [verdict, first, last, lower ends of the box..., upper ends...]. first and last are null
 * where there is no interval, and ends of boxes where they are infinite. Where there is a gap, its
 * bounds, time and witness points come last, as an array. */
void page_event_write(const struct replayed *replayed, size_t log, struct page_shapes *shapes,
                      struct json_writer *out);

#endif
