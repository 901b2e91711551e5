/* One query and its answers, as the page keeps them. */
#ifndef PAGE_EVENT_H
#define PAGE_EVENT_H

#include "page_shapes.h"
#include "replayed.h"

/* Of one query: beyond these, pairs that differ go before those that meet, and these before the
 * rest. */
enum { PAGE_PAIRS_MAX = 1000 };

/* Adds an object to the JSON. log: the index of its log. What stands in it:
 *
 *     n o t log is   number of the event, offset (bytes), time (microseconds since 1970), index of
 *                    the log, enum replay_outcome
 *     kind           0 of a pair, else 1 + QUERY_PAIRS_
 *     T want         duration in seconds, wants
 *     first split    of a scene
 *     total          how many pairs it asks for
 *     frames         [[id, shape, origin..., velocity...], ...]: index of the shape; or
 *                    [id, -1, key], its components are not known; or [id, -2], it is no frame
 *     more_frames    how many there was no room for, where any
 *     then now       results or null: {status, says, detail, method, ns}, of scenes {end, count}
 *                    too: end_pair, pairs of each verdict
 *     certificate    1 where that of then is another one than that of now
 *     pairs          [[a, b, then, now], ...], indices of frames; no now where it is the same
 *     more           how many pairs that have answers are left out, where any
 *
 * Then and now of a pair: null where the result says nothing of it, a verdict, or [verdict, first,
 * last] or [verdict, first, last, lower ends of the box..., upper ends...]. first and last are null
 * where there is no interval, and ends of boxes where they are infinite. */
void page_event_write(const struct replayed *replayed, size_t log, struct page_shapes *shapes,
                      struct page_json *out);

#endif
