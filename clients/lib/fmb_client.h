/* libfmb-client: asks an fmbd on an LCM bus which frames meet, when, and in which boxes.
 *
 *     struct fmb_client_frame frame[2] = {
 *         {.body_id = 1, .shape = FMB_CUBOID, .dim = 2, .components = {1,0, 0,1}},
 *         {.body_id = 2, .shape = FMB_CUBOID, .dim = 2, .components = {1,0, 0,1},
 *          .origin = {0.5, 0}}};
 *     struct fmb_client_scene scene = {
 *         .frames = frame, .frame_count = 2, .which = FMB_CLIENT_ALL, .duration = 1};
 *     char why[FMB_CLIENT_WHY_MAX];
 *     struct fmb_client *client = fmb_client_open(NULL, why, sizeof why);
 *     fmb_client_ask(client, &scene, sink, NULL);
 *     fmb_client_close(client);
 *
 * What frames, verdicts, intervals and boxes are, fmb.h says; doubles go over the bus bit for bit,
 * and the answers are those of libfmb, bit for bit. Link with -lfmb-client -llcm (pkg-config
 * fmb-client); neither libfmb nor GMP is needed, and both may be there.
 *
 * A scene may have any number of frames and pairs. The library cuts it into queries of one datagram
 * each, keeps several under way, but no more than a usual receive buffer holds, asks again what was
 * lost, and pauses where the service is busy. It remembers for bodies with an id the keys that the
 * service told, up to 32,768 of them, and sends the key in place of the components: about half the
 * bytes. A key never stands for other components than those that were sent.
 *
 * Threads: a client is for one thread at a time; different clients have nothing in common, and may
 * be used by different threads at once. No function may be called from a callback of the same
 * client but those that take it as const. The stack holds up to 400 kB at a time.
 *
 * The library prints nothing and never ends the process; liblcm, under it, writes to stderr where
 * the bus refuses something, and aborts where it gets no memory itself. */
#ifndef FMB_CLIENT_H
#define FMB_CLIENT_H

#include "fmb.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A status is 0 (FMB_OK), one of enum fmb_status, which the service has said or would say, or one
 * of these. */
#define FMB_CLIENT_STATUS_MAP(X)                        \
    X(NO_ANSWER, -1, "fmbd gave no answer")             \
    X(NOBODY, -2, "no fmbd answered")                   \
    X(LATE, -3, "not answered within the time for all") \
    X(NO_MEMORY, -4, "out of memory")                   \
    X(NO_BUS, -5, "the bus has failed")                 \
    X(INSIDE, -6, "called from within a callback of the same client")

enum fmb_client_status {
#define X(name, number, text) FMB_CLIENT_##name = number,
    FMB_CLIENT_STATUS_MAP(X)
#undef X
};

/* Static, for people; of numbers from 0 on what fmb.h says. */
const char *fmb_client_status_text(int status);

/* ---- A client ---- */

struct fmb_client;
struct _lcm_t; /* lcm_t of lcm/lcm.h */

/* Those that are 0 have the default. */
struct fmb_client_options {
    const char *url; /* of the bus; NULL: LCM_DEFAULT_URL, or this host alone */
    /* One that is open already; url is not looked at then. Not owned. Asking and handling handle
     * what comes on it for others too: so never from a handler of any of its messages, and clients
     * that share one are for one thread at a time together. */
    struct _lcm_t *lcm;
    const char *prefix; /* of the service's channels */
    double timeout;     /* seconds until a query is sent again; 0: 0.5 */
    int tries;          /* how often a query is sent before it is given up; 0: 6 */
};

/* Room for a text of what went wrong: one or two lines without the last end of line. */
enum { FMB_CLIENT_WHY_MAX = 512 };

/* On input: options, which are copied, or NULL; room for size bytes in why (NULL if size is 0).
 * On output: a client with a random id, to be closed by the caller; or NULL, and why not: the bus
 * cannot be opened (and what to run where there is no route), a wrong option, no memory.
 * It takes some 13 MB of addresses, most of which are touched by large scenes only. */
struct fmb_client *fmb_client_open(const struct fmb_client_options *options, char *why,
                                   size_t size);
void fmb_client_close(struct fmb_client *client); /* may be NULL */

/* Whether a service can have this prefix: at most so many letters, digits, '_' or '-'. */
enum { FMB_CLIENT_PREFIX_MAX = 32 };
bool fmb_client_prefix_ok(const char *prefix);

/* ---- Asking ---- */

struct fmb_client_frame {
    int64_t body_id; /* of a rigid body, 1 to 2^53 - 1; 0: it has none, and always goes whole */
    int shape;       /* enum fmb_shape */
    int dim;         /* 2 or 3 */
    bool moving;     /* carries a velocity, zero included */
    /* One component after the other, each with dim axes: [component * dim + axis]. Numbers beyond
     * those that the shape has are not read, here and below. */
    double components[FMB_COMPONENTS_MAX];
    double origin[FMB_DIM_MAX];
    double velocity[FMB_DIM_MAX]; /* per second; read where moving */
};

enum fmb_client_which {
    FMB_CLIENT_LISTED = 0, /* the pairs listed */
    FMB_CLIENT_ALL = 1,    /* each frame with each that comes after it */
    FMB_CLIENT_ACROSS = 2, /* each of the first split frames with each of the others */
};

/* Bits of want. */
enum {
    FMB_CLIENT_WANT_BOX = 1,
    /* A proof of each verdict (fmb.h). Pairs are asked one by one then, which takes long. */
    FMB_CLIENT_WANT_CERTIFICATE = 2,
    FMB_CLIENT_WANT_TIMES = 4, /* contact intervals */
};

/* A question. Nothing of it is kept. */
struct fmb_client_scene {
    const struct fmb_client_frame *frames; /* [frame_count], all of one dimension */
    size_t frame_count;                    /* less than 2^31 */
    enum fmb_client_which which;
    const unsigned (*pairs)[2]; /* LISTED: [pair_count][a, b], different indices of frames */
    size_t pair_count;
    size_t split;    /* ACROSS: up to frame_count */
    double duration; /* seconds, finite, not negative */
    unsigned want;   /* sum of FMB_CLIENT_WANT_ bits; 0: verdicts alone */
    int method;      /* fmb_method.number; 0: the default, which is never wrong, and the fastest */
    double within;   /* seconds for all of it; 0: as long as timeout and tries let it take */
};

struct fmb_client_answer {
    unsigned a, b;            /* indices of frames, in the order asked */
    int status;               /* 0, or why there is no verdict */
    const char *text;         /* of that, for people; "" where 0. Lives as long as the callback */
    struct fmb_answer answer; /* all 0 where status is not; contact and box as wanted */
    /* Where wanted; NULL where it has no room in a datagram (60,000 characters). Lives as text. */
    const char *certificate;
};

typedef void fmb_client_sink(void *user, const struct fmb_client_answer *answer);

/* Asks the service, and gives the answers to sink; returns when that is done.
 *
 * On output: FMB_OK, and sink was called in the order of the pairs: of LISTED for each; of ALL and
 * ACROSS, in the order of (a, b), for each pair but those that are separated: so a pair that is
 * left out is. (With WANT_CERTIFICATE for each pair.) Those without an answer are given with their
 * status. Or a status of the whole
 * (UNKNOWN_SHAPE, WRONG_DIMENSION, DIMENSIONS_DIFFER, NOT_FINITE, BAD_ID, BAD_DURATION,
 * UNKNOWN_WANT, BAD_PAIR, OVER_LIMIT for 2^31 frames, NO_MEMORY, NO_BUS, INSIDE), sink was not
 * called, and fmb_client_why() names the place.
 *
 * Memory: 16 bytes a frame, and for ALL and ACROSS 80 for each pair that meets of those that have
 * to wait for their turn: the pairs of some 250 frames with all others.
 *
 * A query that was sent `tries` times in vain is given up (NO_ANSWER). If nothing else was heard
 * meanwhile either, all that is left is given up at once (NOBODY), this time and in later calls,
 * until an answer comes: once a second one query goes out, to find out. A result that does not fit
 * its question is ignored, and counted as malformed. */
int fmb_client_ask(struct fmb_client *client, const struct fmb_client_scene *scene,
                   fmb_client_sink *sink, void *user);

/* One pair, by a query that does not wait behind scenes, and by the default method; the interval
 * is always wanted. Returns out->status; text and certificate live until the next call. */
int fmb_client_ask_pair(struct fmb_client *client, const struct fmb_client_frame pair[2],
                        double duration, unsigned want, struct fmb_client_answer *out);

/* What was wrong with the last question: "frames[3].origin[1]: not a finite number"; or "". */
const char *fmb_client_why(const struct fmb_client *client);

/* What was done so far. */
struct fmb_client_counts {
    uint64_t queries;       /* different ones */
    uint64_t answered;      /* of them; refusals are answers too */
    uint64_t repeated;      /* queries sent again */
    uint64_t malformed;     /* results that could not be read, or did not fit their question */
    uint64_t unsent;        /* queries that the bus did not take */
    uint64_t outages;       /* how often nobody answered any more */
    uint64_t bytes;         /* of queries sent */
    uint64_t whole, by_key; /* frames in them: with components, and with a key */
};

struct fmb_client_counts fmb_client_counts(const struct fmb_client *client);

/* ---- Listening ---- */

/* A result that passes on the bus, whoever asked. Pointers live as long as the callback. */
struct fmb_client_pair_result {
    int64_t utime; /* of the query, microseconds since 1970 */
    int64_t client_id, sequence_number, server_id;
    int64_t body_id[2];
    int status;
    const char *text; /* as in fmb_client_answer */
    int dim;          /* of the box; 0 where there is none */
    struct fmb_answer answer;
    const char *certificate; /* NULL: none */
    int64_t compute_ns;
};

struct fmb_client_scene_result {
    int64_t utime, client_id, sequence_number, server_id;
    int status;
    const char *text;
    /* Those of ALL and ACROSS name the pairs that meet alone: all others are separated. Which kind
     * a result without any verdict is of cannot be told: it counts as one that names. */
    bool names_pairs;
    int64_t end_pair; /* up to this pair of the query it answers */
    int64_t overlapping, touching;
    int64_t separated, undecided; /* 0 where names_pairs */
    int64_t lost; /* queries of this client that the service missed, or saw overtaken, so far */
    int64_t compute_ns;
};

/* Counts of a heartbeat, in the order of status_t.lcm, which says what they are; the last three
 * are in its list `more`. */
#define FMB_CLIENT_COUNTERS(X) \
    X(uptime_us)               \
    X(restarts)                \
    X(receive_buffer)          \
    X(received)                \
    X(answered)                \
    X(unsent)                  \
    X(pairs)                   \
    X(malformed)               \
    X(sequence_gaps)           \
    X(repeated)                \
    X(bodies)                  \
    X(capacity)                \
    X(hits)                    \
    X(misses)                  \
    X(replacements)            \
    X(evictions)               \
    X(compute_p50_ns)          \
    X(compute_p99_ns)          \
    X(compute_max_ns)          \
    X(scenes)                  \
    X(waiting)                 \
    X(most_waiting)

struct fmb_client_heartbeat {
    int64_t utime, server_id;
    const char *version;
#define X(name) int64_t name;
    FMB_CLIENT_COUNTERS(X)
#undef X
    int64_t results[FMB_STATUS_COUNT]; /* [status]: results sent */
};

/* Callbacks; those that are NULL are not listened for. */
struct fmb_client_watcher {
    void (*pair)(void *user, const struct fmb_client_pair_result *result);
    void (*scene)(void *user, const struct fmb_client_scene_result *result);
    void (*heartbeat)(void *user, const struct fmb_client_heartbeat *heartbeat);
    /* A message on a channel that is listened to could not be read, and what is wrong with it. */
    void (*malformed)(void *user, const char *what);
    void *user;
};

/* From now on the callbacks are called, from within fmb_client_handle() and fmb_client_ask(). On
 * output: 0; NO_BUS where it cannot be listened to; INSIDE. */
int fmb_client_watch(struct fmb_client *client, const struct fmb_client_watcher *watcher);

/* Readable when fmb_client_handle() has something to do: for the caller's poll(). */
int fmb_client_fileno(const struct fmb_client *client);

/* Waits up to so many seconds for a message (0: not at all; negative: for as long as it takes, or
 * until a signal), and takes those that are there, up to a limit. On output: how many, or NO_BUS,
 * INSIDE. */
int fmb_client_handle(struct fmb_client *client, double timeout);

#ifdef __cplusplus
}
#endif
#endif
