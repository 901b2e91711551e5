/* The LCM bus: receives through its own socket, publishes through liblcm.
 *
 * liblcm's receiver costs a thread, a pipe and three context switches a message, and two kinds of
 * malformed datagrams crash it. So this module receives messages itself: LCM's short datagrams
 * ("LC02", sequence number, channel, final 0, payload), each a whole message. Fragments, messages
 * on other channels and malformed datagrams are dropped and counted. Receiving allocates no memory.
 * liblcm starts no thread unless a program subscribes through it or takes its descriptor.
 *
 * A bus may be used by one thread at a time; buses share no state. After fork() the child may only
 * close it; the parent's bus keeps working. */
#ifndef BUS_H
#define BUS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct bus;

enum {
    BUS_CHANNEL_MAX = 64,         /* bytes of a channel name, final 0 included: LCM's limit */
    BUS_PREFIX_MAX = 32,          /* characters of a prefix */
    BUS_WHY_MAX = 512,            /* bytes of an error text, final 0 included */
    BUS_PAYLOAD_MAX = 65507 - 10, /* bytes: UDP's limit minus header and shortest channel name */
    BUS_BATCH = 64,               /* most datagrams that one call of bus_receive() reads */
    BUS_LISTENERS_MAX = 16,       /* most calls of bus_listen() */
    BUS_SPIN_NS = 50000           /* active waiting, nanoseconds; see bus_wait() */
};

/* Whether this is a prefix of channel names: at most BUS_PREFIX_MAX letters, digits, '_' or '-'. */
bool bus_prefix_ok(const char *prefix);

/* Writes the channel name, prefix followed by name; truncated if it exceeds LCM's limit. */
void bus_channel(char out[BUS_CHANNEL_MAX], const char *prefix, const char *name);

/* Opens a bus that receives nothing until bus_listen() is called. The caller closes it.
 * On input: url: udpm://[GROUP:PORT][?ttl=N&recv_buf_size=N], as for LCM. NULL or "": the
 * environment's LCM_DEFAULT_URL; if that is not set, LCM's default group on this host alone
 * (ttl=0). Without recv_buf_size, 4 MB are requested, beyond the system's limit if the process is
 * privileged.
 * On output: the bus; or NULL, and why has one or two lines, without a final line feed: what is
 * wrong, and what to run. */
struct bus *bus_open(const char *url, char why[BUS_WHY_MAX]);
void bus_close(struct bus *bus); /* may be NULL */

/* Begins to receive a channel (NULL: every channel), including messages that this bus publishes.
 * A message that was sent before the call is delivered whole, or counted as foreign, or not
 * received. The name is copied. At most BUS_LISTENERS_MAX calls; each gets the next listener
 * number, from 0. On output: true; or false, and why as for bus_open(): not a channel name, too
 * many calls, or the socket cannot be opened or bound. A call that fails adds no listener. */
bool bus_listen(struct bus *bus, const char *channel, char why[BUS_WHY_MAX]);

/* A message. Pointers are valid during the callback; bytes may have any alignment. */
struct bus_message {
    const char *channel;        /* zero-terminated */
    int listener;               /* the lowest listener number that receives the channel */
    const unsigned char *bytes; /* [size] payload */
    size_t size;                /* 0 to BUS_PAYLOAD_MAX */
    int64_t utime;              /* time of reading the batch, microseconds since 1970 */
};

/* The handler may publish. It must not call bus_receive(), bus_wait() or bus_close(). */
typedef void bus_handler(void *user, const struct bus_message *message);

/* Reads pending datagrams, at most BUS_BATCH, and calls the handler for each message on a channel
 * that is listened to. Never blocks. Returns the number of datagrams read, including those dropped;
 * 0: none were pending; -1: the socket failed (errno). */
int bus_receive(struct bus *bus, bus_handler *handler, void *user);

/* Waits until a datagram is pending, other_fd (-1: none) is readable, or timeout_ms (-1: no limit)
 * have passed. After a message was received or published, the first BUS_SPIN_NS of the wait are
 * active, with sched_yield(), since a core that sleeps takes long to wake up. Dropped datagrams do
 * not extend this time. There is no active waiting if timeout_ms is 0, or while other programs keep
 * the core busy.
 * A signal that arrives before the wait does not end it: pass a signalfd as other_fd.
 * Returns bit 0: datagrams, bit 1: other_fd; 0: time-out or signal; -1: poll() failed. */
int bus_wait(struct bus *bus, int other_fd, int timeout_ms);

/* The receiving socket, for the caller's poll(); owned by the bus. -1 before bus_listen(). */
int bus_fileno(const struct bus *bus);

/* Publishes a message in one datagram. A channel name of n characters leaves
 * BUS_PAYLOAD_MAX + 1 - n bytes for the payload. Returns false if the message is longer, the
 * channel is not a name, or the system did not send it. */
bool bus_publish(struct bus *bus, const char *channel, const void *bytes, size_t size);

struct bus_counts {
    uint64_t received;   /* messages given to the handler */
    uint64_t foreign;    /* messages on other channels, those that this bus publishes included */
    uint64_t malformed;  /* datagrams that are not a whole message: fragments, bad magic, ... */
    uint64_t fragmented; /* first fragments of messages on channels that are listened to */
    uint64_t dropped;    /* datagrams that the kernel dropped because its buffer was full */
    long receive_buffer; /* bytes granted by the system, as SO_RCVBUF reports them */
    /* The last of these messages: its listener, and its size in bytes according to its header. */
    int fragmented_listener;
    uint32_t fragmented_size;
};

/* Counts since bus_listen(). dropped follows a 32-bit counter of the kernel: it is right if fewer
 * than 2^32 datagrams were dropped between two calls. */
struct bus_counts bus_counts(struct bus *bus);

#endif
