/* The messages of a service, as events of a log: whose they are, before anything else is read. */
#ifndef MESSAGE_H
#define MESSAGE_H

#include "match.h"

bool message_is_query(enum log_kind kind);
bool message_is_result(enum log_kind kind);

/* On input: kind of the event, a query or a result. On output: NULL, and of *out all but the place,
 * its bytes those of the event; the item's kind is that of the query. Or a static text of what is
 * wrong; the kind is there then too. */
const char *message_read_ids(enum log_kind kind, const struct log_event *event,
                             struct match_item *out);

#endif
