/* libfmb-client: queries an fmbd on an LCM bus: which bodies meet, when, in which boxes, and how
 * far apart the others are. The scenes are those of fmb.h, and so are the answers, bit for bit.
 *
 *     static const double size[3] = {1, 1, 1};
 *     struct fmb_body cube;
 *     fmb_body_make(3, FMB_BOX, size, 3, &cube);
 *     const struct fmb_placement placement[2] = {
 *         {.body = &cube, .id = 1},
 *         {.body = &cube, .id = 2, .position = {0.5, 0, 0}, .orientation_count = 4,
 *          .orientation = {1, 0, 0, 1}}};
 *     const struct fmb_scene scene = {
 *         .placements = placement, .placement_count = 2, .duration = 1};
 *     char why[FMB_CLIENT_WHY_MAX];
 *     struct fmb_client *client = fmb_client_open(NULL, why, sizeof why);
 *     fmb_client_query(client, &scene, sink, NULL);
 *     fmb_client_close(client);
 *
 * (sink is a function of the caller that receives the answers; clients/examples/scene.c is a
 * complete program.)
 *
 * Link with pkg-config's fmb-client: libfmb, GMP, liblcm and GLib.
 *
 * A scene may have any number of bodies and pairs. The library divides it into queries of one
 * datagram each, keeps several under way (no more than a default receive buffer holds), repeats
 * what was lost, and pauses where the service is busy. A body with an id is sent whole until a
 * result shows that the service holds it, and from then on by its handle, in any pose.
 *
 * Threads: a client may be used by one thread at a time. Different clients share nothing, and may
 * be used by different threads at once. A callback may only call functions that take the same
 * client as const.
 *
 * fork(): the child may only close its copy of a client; the parent's keeps working.
 *
 * The library prints nothing and never ends the process; liblcm and GLib, which it uses, abort when
 * they are out of memory. Any program on the bus can send results; see "Trust" in
 * service/README.md. */
#ifndef FMB_CLIENT_H
#define FMB_CLIENT_H

#include "fmb.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A status is FMB_OK (0), another value of enum fmb_status, from the service or by the same rules,
 * or one of these. */
#define FMB_CLIENT_STATUS_MAP(X)                                    \
    X(NO_ANSWER, -1, "fmbd gave no answer")                         \
    X(NO_SERVICE, -2, "no fmbd answered")                           \
    X(LATE, -3, "not answered within the time for the whole scene") \
    X(NO_MEMORY, -4, "out of memory")                               \
    X(NO_BUS, -5, "the bus has failed")                             \
    X(INSIDE, -6, "called from within a callback of the same client")

enum fmb_client_status {
#define X(name, number, text) FMB_CLIENT_##name = number,
    FMB_CLIENT_STATUS_MAP(X)
#undef X
};

/* The text of a status, for people; static. From 0 on that of fmb_status_text(). */
const char *fmb_client_status_text(int status);

/* ---- A client ---- */

struct fmb_client;

/* A field that is 0 or NULL has its default. */
struct fmb_client_options {
    /* Of the bus: udpm://[GROUP:PORT][?ttl=N&recv_buf_size=N]. NULL: LCM_DEFAULT_URL; if that is
     * not set, this host only. */
    const char *url;
    const char *prefix; /* of the service's channels; NULL: none */
    /* Longest time before a query is sent again, seconds; 0: 0.5. The first repeat comes after
     * milliseconds. Later ones come at the same interval while many queries are lost; otherwise the
     * interval doubles, up to this. */
    double timeout;
    int tries;     /* a query is given up after this many timeouts; 0: 6 */
    double within; /* time limit for each scene, seconds; 0: none but timeout and tries */
};

/* Bytes of an error text, final 0 included: one or two lines without a final line feed. */
enum { FMB_CLIENT_WHY_MAX = 512 };

/* Opens a client with a random id. The caller closes it with fmb_client_close().
 * On input: options, which are copied, or NULL; why has size bytes (NULL if size is 0).
 * Returns NULL if the bus cannot be opened, an option is wrong, or memory is exhausted; why is then
 * the reason, and what to run if there is no multicast route.
 * A client reserves some 10 MB of memory; only large scenes touch most of it. */
struct fmb_client *fmb_client_open(const struct fmb_client_options *options, char *why,
                                   size_t size);
void fmb_client_close(struct fmb_client *client); /* may be NULL */

/* Whether the prefix is valid: at most FMB_CLIENT_PREFIX_MAX letters, digits, '_' or '-'. */
enum { FMB_CLIENT_PREFIX_MAX = 32 };
bool fmb_client_prefix_ok(const char *prefix);

/* ---- Queries ---- */

/* The frames of a body have to fit into one datagram: each takes 1 byte, 8 for each of its numbers
 * and 4 if it is sent by its vertices (fmb_frame_numbers()), and all together at most this. (654
 * cuboids or 1295 boxes in 3D.) */
enum { FMB_CLIENT_BODY_BYTES_MAX = 63500 };

struct fmb_client_answer {
    unsigned a, b;            /* indices of placements, in the order of the pair */
    int status;               /* FMB_OK, or why there is no verdict */
    const char *text;         /* text of the status, "" if FMB_OK. Valid during the callback */
    struct fmb_answer answer; /* all 0 unless FMB_OK; contact, box, point and gap as wanted */
    /* NULL if not wanted, or if the pair has none (fmb.h). Valid during the callback. */
    const char *certificate;
};

typedef void fmb_client_sink(void *user, const struct fmb_client_answer *answer);

/* Queries the service, passes the answers to sink, and returns when all are delivered. Keeps no
 * pointer to the scene. What fmb_scene_begin() refuses is refused here too, with the same status,
 * except FMB_WANT_CERTIFICATE: then each pair is a separate query, which is slower.
 *
 * Returns FMB_OK: sink was called in the order of the pairs. With LISTED and with WANT_CERTIFICATE,
 * for each pair. Otherwise, with ALL and ACROSS, in the order of (a, b), for each pair that
 * touches, overlaps or is near: pairs left out are ignored, within a group, or separated and
 * farther apart than the margin. Pairs without an answer are passed with their status. Or returns a
 * status of the whole scene, and sink was not called: one of fmb_scene_check(), BAD_NAME, BAD_ID,
 * OVER_LIMIT (2^31 placements, a body of too many frames, or a label of more than 64 bytes),
 * NO_MEMORY, NO_BUS or INSIDE. fmb_client_why() then names the place.
 *
 * Memory: 44 bytes for each placement, 4 for each ignored pair; with ALL and ACROSS also 192
 * bytes for each of these pairs that waits for earlier ones: at most those of some 500 placements
 * with all others. The client keeps a copy of the frames of up to 16,384 bodies, or of twice
 * as many as a scene has, and of those of the last scene.
 *
 * A query without a result after timeout * tries seconds is given up (NO_ANSWER). If no result of
 * any query came in that time, all remaining pairs are given up (NO_SERVICE): start an fmbd. From
 * then on, until a result comes, each call sends one query and waits one timeout for its result
 * before it gives up the others too. A result that does not match its query is ignored, and counted
 * as malformed. */
int fmb_client_query(struct fmb_client *client, const struct fmb_scene *scene,
                     fmb_client_sink *sink, void *user);

/* Queries one pair by the default method; the contact interval is always included. Groups are not
 * considered. The service does not queue it after this client's scenes. Returns out->status. text
 * and certificate are valid until the next call. */
int fmb_client_query_pair(struct fmb_client *client, const struct fmb_placement pair[2],
                          double duration, unsigned want, struct fmb_client_answer *out);

/* Returns what is wrong with the last scene: "placements[3]: not a finite number"; or
 * "". Valid until the next call that is not const. */
const char *fmb_client_why(const struct fmb_client *client);

/* Counts since fmb_client_open(). */
struct fmb_client_counts {
    uint64_t queries;          /* sent, repeats not counted */
    uint64_t answered;         /* queries with a result, refusals included */
    uint64_t repeated;         /* queries sent again */
    uint64_t malformed;        /* results that could not be decoded, or did not match their query */
    uint64_t unsent;           /* queries that could not be sent */
    uint64_t outages;          /* times that the service stopped answering */
    uint64_t bytes;            /* of queries sent, repeats counted */
    uint64_t whole, by_handle; /* placements sent with frames, and with a handle */
};

void fmb_client_get_counts(const struct fmb_client *client, struct fmb_client_counts *out);

/* ---- Listening ---- */

/* status_t.lcm defines the counters. */
struct fmb_client_counter {
    const char *name; /* "received"; static */
    int64_t value;
};

/* Pointers are valid during the callback. */
struct fmb_client_heartbeat {
    int64_t utime, server_id;
    const char *version;
    /* [counter_count]: all that this version knows, with a value of 0 if the service does not send
     * it. */
    const struct fmb_client_counter *counters;
    size_t counter_count;
};

/* Returns the value of the counter with this name, or 0 if there is none. */
int64_t fmb_client_get_counter(const struct fmb_client_heartbeat *heartbeat, const char *name);

struct fmb_client_watcher {
    void (*heartbeat)(void *user, const struct fmb_client_heartbeat *heartbeat);
    /* NULL: none. A heartbeat or a result could not be decoded. what: the reason. */
    void (*malformed)(void *user, const char *what);
    void *user;
};

/* Sets the callbacks, which fmb_client_handle() and fmb_client_query() call from now on. Returns 0;
 * NO_BUS if the bus cannot be received; INSIDE. */
int fmb_client_watch(struct fmb_client *client, const struct fmb_client_watcher *watcher);

/* A descriptor for the caller's poll(), readable when fmb_client_handle() has something to do. -1
 * before the first query or fmb_client_watch(). */
int fmb_client_fileno(const struct fmb_client *client);

/* Waits up to timeout seconds for a message (0: not at all; negative: until a message or a signal
 * comes), and handles the pending ones, up to a limit. Returns the number of datagrams read, or
 * NO_BUS, INSIDE. */
int fmb_client_handle(struct fmb_client *client, double timeout);

#ifdef __cplusplus
}
#endif
#endif
