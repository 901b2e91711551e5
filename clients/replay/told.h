/* What the keys in a log stand for, at each of its queries: found by the parts that fmb replay
 * finds it by, in the same order, so that what is made of it agrees with what a replay says.
 *
 * For each event, in the order of the log: of a query told_look(), what one wants of its frames,
 * then match_query(); of a result match_result(). A query that told_look() does not know all keys
 * of fmb replay answers later, when all of the log has been read and matched. */
#ifndef TOLD_H
#define TOLD_H

#include "any_query.h"
#include "known_bodies.h"
#include "match.h"

struct told {
    struct match *match;
    struct known_bodies *known;
    /* Of told.c. */
    struct learner *learner;
    struct match_sink sink;
};

/* sink: called likewise, after what a result tells was learned. Copied. Never NULL: ends the
 * program where there is no memory. */
struct told *told_open(const struct match_sink *sink);
void told_close(struct told *told); /* may be NULL */

enum told_keys {
    TOLD_ALL,       /* all keys of its frames, if it has any, are known */
    TOLD_SOME,      /* not all */
    TOLD_DEFINITION /* no question (definition.h): not to be matched */
};

/* Learns what a definition says. mine: that is the user's own then (known_body.mine). */
enum told_keys told_look(struct told *told, struct any_query *query, bool mine);

/* Whether a frame came by key; what is no key is refused as such. */
bool told_is_by_key(const struct query_frame *frame);

/* What the key of a frame that came by key stands for. NULL: it is not known, or of another shape
 * or dimension than the frame says. */
struct known_body *told_body(struct told *told, const struct query_frame *frame);

#endif
