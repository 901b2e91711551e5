/* What a query says, checked field by field: the first thing that is wrong ends it, and is named.
 */
#ifndef CHECK_H
#define CHECK_H

#include "query.h"

/* A query on its way. The place is that of the frame that is looked at: it is put into words where
 * something is wrong. */
struct checking {
    int32_t *status;  /* of the result */
    char *detail;     /* [QUERY_TEXT_MAX] of the result */
    const char *part; /* "a", "frames"; NULL: the query itself */
    int32_t index;    /* of several in the part, from 0; -1: it is one */
};

/* Says what is wrong and where: "b.components[4]: not a finite number". Always false. reason NULL:
 * the text of the status. */
bool check_refuse(struct checking *checking, enum fmb_status status, const char *field,
                  const char *reason);

/* False after refusing. wants: all bits that may be wanted. */
bool check_ids(struct checking *checking, int64_t client_id, int64_t sequence_number);
bool check_question(struct checking *checking, double duration, int32_t method, int32_t want,
                    int32_t wants);
bool check_frame(struct checking *checking, const struct query_frame *frame);

/* Whether the frame names its components by key. Inline: asked several times of each. */
static inline bool check_by_key(const struct query_frame *frame)
{
    return frame->components.count == 0 && frame->key != 0;
}

#endif
