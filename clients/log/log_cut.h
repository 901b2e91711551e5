/* Cuts logs: copies the events that are chosen into a new log, so that a replay of that says of
 * each of its queries what a replay of all says of it.
 *
 * What is copied is the same bytes with the same log time; LCM numbers the events anew, from 0.
 * Results go with their queries (match.h), wherever they stand: only those whose query is nowhere
 * are chosen by their own time. Events that are no queries and no results have no bodies. What is
 * no event, or damaged, is left out.
 *
 * Keys. A frame by key is good for nothing without the query and the result that told the key.
 * Where both are copied, the frame is too, as it is. Where they are not, the components are written
 * back into it, and the key is left: a service takes such a frame for a whole one, and fmb replay
 * for what it was, one by key. A scene that would be longer than a datagram with all its components
 * is left as it is, and behind definitions (definition.h) of its keys, which have its log time.
 * What a key stands for is found as fmb replay finds it (told.h); of keys that it does not find the
 * frames stay as they are.
 *
 * The logs are read twice: once to know what belongs together, and once to copy. Memory stays the
 * same whatever their size; what is to be remembered goes into temporary files. */
#ifndef LOG_CUT_H
#define LOG_CUT_H

#include "log_choice.h"
#include "log_kind.h"

struct log_cut_options {
    char *const *log; /* [log_count], one after the other, as one */
    int log_count;
    const char *prefix; /* of the service's channels, "" for none */
    const char *output; /* none of the logs */
    bool force;         /* output may be there already */
    struct log_choice choice;
};

struct log_cut_counts {
    int64_t events, bytes; /* of the logs */
    int64_t kept_events, kept_bytes;
    int64_t kept[LOG_KINDS]; /* [kind] */
    /* Components that were written back: frames, into queries; and definitions, which are not among
     * what is kept, of so many frames. */
    int64_t frames, queries, definitions, defined;
    int64_t unknown_frames, unknown_queries; /* kept, by keys that the logs do not tell */
    int64_t damages, damaged_bytes;
};

/* Where it is told what is found. */
struct log_cut_sink {
    void (*damage)(void *user, int log, const struct log_damage *damage);
    /* So many bytes of so many have been gone through. */
    void (*progress)(void *user, int64_t bytes, int64_t of);
    void *user;
};

/* False: a file cannot be opened, read or written, which has been said on stderr; an output that
 * was begun is not whole then. */
bool log_cut(const struct log_cut_options *options, const struct log_cut_sink *sink,
             struct log_cut_counts *counts);

#endif
