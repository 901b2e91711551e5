/* The latest queries, or results, of a log: so many bytes of them, found by their ids. */
#ifndef RECENT_H
#define RECENT_H

#include "match.h"

struct recent_item {
    struct match_item item; /* its bytes are copies */
    bool matched;           /* recent_match() was called for it */
    /* Of recent.c. */
    uint32_t bucket, next, before, length;
};

struct recent;

/* Keeps so many bytes of items, at least several times the longest, as long as they are not
 * matched; of those that are, it may be a megabyte. On an item that has to go for others calls
 * gone, which must not call back. Never NULL. */
struct recent *recent_open(size_t bytes, void (*gone)(void *user, const struct recent_item *item),
                           void *user);
void recent_close(struct recent *recent); /* may be NULL; gone is not called */

/* Returns the copy, which is good until it goes. */
struct recent_item *recent_put(struct recent *recent, const struct match_item *item);

/* One of this kind with these ids, utime included; NULL: there is none. Of those that are not
 * matched yet the oldest, of those that are the one that was matched last: either is found at once,
 * however many have the same ids. */
struct recent_item *recent_unmatched(const struct recent *recent, enum log_kind kind,
                                     const struct query_header *ids);
struct recent_item *recent_matched(const struct recent *recent, enum log_kind kind,
                                   const struct query_header *ids);

/* On input: one that is not matched yet. */
void recent_match(struct recent *recent, struct recent_item *item);

/* Lets all go. */
void recent_flush(struct recent *recent);

#endif
