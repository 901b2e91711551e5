/* fmbd: answers collision queries on an LCM bus. Reads the options, opens the bus, drops
 * privileges, and serves until SIGINT or SIGTERM. Errors are reported on stderr. */
#define _GNU_SOURCE
#include "bus.h"
#include "cache.h"
#include "clock.h"
#include "confine.h"
#include "fmb.h"
#include "process.h"
#include "server.h"

#include <errno.h>
#include <fcntl.h>
#include <getopt.h>
#include <inttypes.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

enum { EXIT_USAGE = 2 };
enum { DEFAULT_FRAMES = 65536 };

/* ---- Options ---- */

static const char usage[] =
    "usage: fmbd [options]\n"
    "\n"
    "Answers queries about rigid bodies on an LCM bus, in 2D and 3D, at rest and\n"
    "moving: whether they are separated, touch or overlap, when, and in which box.\n"
    "'fmb query' sends queries. Receives on FMB_PAIR_QUERY, FMB_SCENE_QUERY and\n"
    "FMB_DEFINITION_QUERY; sends results on FMB_PAIR_RESULT, FMB_SCENE_RESULT and\n"
    "FMB_DEFINITION, and a heartbeat on FMB_STATUS once a second. Ends on SIGINT and\n"
    "SIGTERM.\n"
    "\n"
    "  -l, --lcm-url URL   the bus, udpm://GROUP:PORT?ttl=N; else LCM_DEFAULT_URL;\n"
    "                      else this host alone (udpm://239.255.76.67:7667?ttl=0)\n"
    "  -p, --prefix P      put P before the channel names, for a second service on\n"
    "                      the bus\n"
    "  -f, --frames N      capacity of the cache of bodies, in frames (default %d,\n"
    "                      1 to %d)\n"
    "  -u, --user NAME     become this user once the bus is open (default nobody if\n"
    "                      started as root)\n"
    "  -h, --help          print this help\n"
    "  -V, --version       print the version\n"
    "\n"
    "Exit codes: 0 ended by a signal, 1 no bus, no memory or no such user, 2 wrong\n"
    "options.\n";

struct daemon_options {
    const char *lcm_url; /* NULL: see bus_open() */
    const char *prefix;  /* of the channels; "": none */
    const char *user;    /* see confine_user() */
    size_t frames;       /* capacity of the cache */
};

/* Reports an option that getopt_long() refused. The name is argv[optind - 1] of a long option, and
 * the letter optopt of a short one, which may share its word with others. */
static int refused_option(int option, char **argv)
{
    const char letter[] = {'-', (char) optopt, '\0'};
    const char *name = strncmp(argv[optind - 1], "--", 2) == 0 ? argv[optind - 1] : letter;
    fprintf(stderr,
            option == ':' ? "fmbd: option '%s' needs a value; see fmbd --help\n"
                          : "fmbd: unknown option '%s'; see fmbd --help\n",
            name);
    return EXIT_USAGE;
}

static int wrong_option(const char *option, const char *value, const char *expected)
{
    fprintf(stderr, "fmbd: %s '%s': expected %s; see fmbd --help\n", option, value, expected);
    return EXIT_USAGE;
}

static bool parse_frames(const char *text, size_t *out)
{
    char *end;
    errno = 0;
    unsigned long long value = strtoull(text, &end, 10);
    bool digits = text[0] >= '0' && text[0] <= '9';
    *out = (size_t) value;
    return digits && *end == '\0' && errno == 0 && value >= 1 && value <= CACHE_FRAMES_MAX;
}

/* Returns -1 to go on, or the code to exit with. */
static int parse_options(int argc, char **argv, struct daemon_options *out)
{
    static const struct option long_options[] = {
        {"lcm-url", required_argument, NULL, 'l'},
        {"prefix", required_argument, NULL, 'p'},
        {"frames", required_argument, NULL, 'f'},
        {"user", required_argument, NULL, 'u'},
        {"help", no_argument, NULL, 'h'},
        {"version", no_argument, NULL, 'V'},
        {0},
    };
    *out = (struct daemon_options){.prefix = "", .frames = DEFAULT_FRAMES};
    char range[64];
    snprintf(range, sizeof range, "a number from 1 to %d", CACHE_FRAMES_MAX);
    int option;
    while ((option = getopt_long(argc, argv, ":l:p:f:u:hV", long_options, NULL)) != -1) {
        switch (option) {
        case 'l': out->lcm_url = optarg; break;
        case 'p':
            out->prefix = optarg;
            if (!bus_prefix_ok(optarg))
                return wrong_option("--prefix", optarg, "at most 32 letters, digits, _ or -");
            break;
        case 'f':
            if (!parse_frames(optarg, &out->frames))
                return wrong_option("--frames", optarg, range);
            break;
        case 'u': out->user = optarg; break;
        case 'h': printf(usage, DEFAULT_FRAMES, CACHE_FRAMES_MAX); return EXIT_SUCCESS;
        case 'V': printf("fmbd %s\n", fmb_version()); return EXIT_SUCCESS;
        default: return refused_option(option, argv);
        }
    }
    if (optind < argc)
        return wrong_option("argument", argv[optind], "options only");
    return -1;
}

/* ---- The daemon ---- */

/* Longest time to read the bus in a row, so that a flood of datagrams does not prevent answers. */
static const int64_t drain_max_ns = 200000;

/* Interval at which signals and the watchdog are polled while queries are pending. */
static const int64_t poll_ns = 10000000;

/* After sched_yield() has taken longer than long_yield_ns, short sleeps of nap_ns replace it for
 * yield_pause_ns. */
static const int64_t long_yield_ns = 1000000, yield_pause_ns = 1000000000, nap_ns = 100000;

/* The service manager (protocol of sd_notify: datagrams to the socket NOTIFY_SOCKET). */
struct manager {
    int fd;              /* -1: there is no manager */
    int64_t watchdog_ns; /* interval of watchdog messages, half of the limit; 0: none */
    int64_t due_ns;      /* when the next one is due (clock_ns()) */
};

struct daemon {
    struct bus *bus;
    struct server *server;
    struct manager manager;
    int signals;
    int64_t poll_at_ns, yield_at_ns;
    bool failed; /* the bus failed; the reason is on stderr */
};

/* ---- The bus ---- */

static bool publish(void *user, const char *channel, const unsigned char *bytes, size_t size)
{
    const struct daemon *daemon = user;
    return bus_publish(daemon->bus, channel, bytes, size);
}

static void on_message(void *user, const struct bus_message *message)
{
    server_receive(user, (enum server_kind) message->listener, message->bytes, message->size);
}

/* ---- The service manager ---- */

static int connect_to(const char *path)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    const size_t length = path ? strlen(path) : 0;
    if (length < 2 || length >= sizeof address.sun_path || (path[0] != '/' && path[0] != '@'))
        return -1;
    memcpy(address.sun_path, path, length);
    if (path[0] == '@') /* of the abstract namespace */
        address.sun_path[0] = '\0';
    const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const socklen_t size = (socklen_t) (offsetof(struct sockaddr_un, sun_path) + length);
    if (fd >= 0 && connect(fd, (const struct sockaddr *) &address, size) == 0)
        return fd;
    if (fd >= 0)
        close(fd);
    return -1;
}

static int64_t watchdog_ns(void)
{
    const char *pid = getenv("WATCHDOG_PID"), *limit_us = getenv("WATCHDOG_USEC");
    if (!limit_us || (pid && strtol(pid, NULL, 10) != (long) getpid()))
        return 0;
    const int64_t half_us = strtoll(limit_us, NULL, 10) / 2;
    return half_us > 0 && half_us < INT64_MAX / 1000 ? half_us * 1000 : 0;
}

static void notify(const struct manager *manager, const char *text)
{
    if (manager->fd >= 0)
        send(manager->fd, text, strlen(text), MSG_DONTWAIT | MSG_NOSIGNAL);
}

/* Opens the socket that the environment names (NOTIFY_SOCKET), and reads the watchdog's interval
 * (WATCHDOG_USEC, WATCHDOG_PID). Without a manager, notify() and notify_alive() have no effect.
 * Neither blocks. */
static void notify_open(struct manager *manager)
{
    *manager = (struct manager){.fd = connect_to(getenv("NOTIFY_SOCKET"))};
    if (manager->fd >= 0)
        manager->watchdog_ns = watchdog_ns();
}

/* Sends the watchdog message, if it is due. Returns the milliseconds until the next one, rounded
 * down, or most_ms if that is less or there is no watchdog. */
static int notify_alive(struct manager *manager, int most_ms)
{
    if (!manager->watchdog_ns)
        return most_ms;
    const int64_t now_ns = clock_ns();
    if (now_ns >= manager->due_ns) {
        notify(manager, "WATCHDOG=1");
        manager->due_ns = now_ns + manager->watchdog_ns;
    }
    const int64_t left_ms = (manager->due_ns - now_ns) / 1000000;
    return left_ms < most_ms ? (int) left_ms : most_ms;
}

/* ---- Serving ---- */

static void fail(struct daemon *daemon)
{
    perror("fmbd: the bus failed");
    daemon->failed = true;
}

static void drain(struct daemon *daemon)
{
    const int64_t until_ns = clock_ns() + drain_max_ns;
    int datagrams;
    do {
        datagrams = bus_receive(daemon->bus, on_message, daemon->server);
        if (datagrams >= 0)
            server_end_batch(daemon->server, datagrams);
        else
            fail(daemon);
    } while (datagrams == BUS_BATCH && clock_ns() < until_ns);
}

/* Sends the heartbeat and polls signals and the watchdog, if they are due. Returns false if a
 * signal arrived. */
static bool poll_events(struct daemon *daemon)
{
    if (server_heartbeat_due_ms(daemon->server) == 0) {
        const struct bus_counts counts = bus_counts(daemon->bus);
        server_heartbeat(daemon->server, &counts);
    }
    const int64_t now_ns = clock_ns();
    if (now_ns < daemon->poll_at_ns)
        return true;
    daemon->poll_at_ns = now_ns + poll_ns;
    notify_alive(&daemon->manager, 0);
    struct pollfd signals = {.fd = daemon->signals, .events = POLLIN};
    return poll(&signals, 1, 0) <= 0;
}

/* Sleeps until a datagram, a signal, or the heartbeat or watchdog message is due. Returns false if
 * a signal arrived. */
static bool sleep_until_due(struct daemon *daemon)
{
    const int due_ms = notify_alive(&daemon->manager, server_heartbeat_due_ms(daemon->server));
    const int ready = bus_wait(daemon->bus, daemon->signals, due_ms);
    if (ready < 0)
        fail(daemon);
    return !(ready & 2);
}

/* Lets other programs run for a moment. If one of them keeps the core busy, sched_yield() returns
 * only when that program's time slice ends, whereas a datagram wakes up a process that sleeps. */
static void yield_core(struct daemon *daemon)
{
    const int64_t begin_ns = clock_ns();
    if (begin_ns < daemon->yield_at_ns) {
        struct pollfd bus = {.fd = bus_fileno(daemon->bus), .events = POLLIN};
        ppoll(&bus, 1, &(struct timespec){.tv_nsec = nap_ns}, NULL);
        return;
    }
    sched_yield();
    if (clock_ns() - begin_ns > long_yield_ns)
        daemon->yield_at_ns = begin_ns + yield_pause_ns;
}

static void serve(struct daemon *daemon)
{
    bool more = true;
    while (more && !daemon->failed) {
        drain(daemon);
        const enum server_state state = server_work(daemon->server);
        more = poll_events(daemon);
        if (!more || state == SERVER_WORKING)
            continue;
        if (state == SERVER_ANTICIPATING)
            yield_core(daemon);
        else
            more = sleep_until_due(daemon);
        server_resume(daemon->server);
    }
}

/* ---- Life ---- */

static void report_ready(const struct daemon *daemon, const struct daemon_options *options,
                         int64_t server_id)
{
    const struct server *server = daemon->server;
    if (!stderr_ready())
        return;
    fprintf(stderr,
            "fmbd %s ready: answers %s on %s, %s on %s, %s on %s, heartbeat on %s; %zu frames; "
            "receive buffer %ld bytes; server %" PRId64 "\n",
            fmb_version(), server_query_channel(server, SERVER_PAIRS),
            server_result_channel(server, SERVER_PAIRS),
            server_query_channel(server, SERVER_SCENES),
            server_result_channel(server, SERVER_SCENES),
            server_query_channel(server, SERVER_DEFINITIONS),
            server_result_channel(server, SERVER_DEFINITIONS),
            server_result_channel(server, SERVER_STATUS), options->frames,
            bus_counts(daemon->bus).receive_buffer, server_id);
}

static bool open_bus(struct daemon *daemon, const struct daemon_options *options)
{
    char why[BUS_WHY_MAX];
    daemon->bus = bus_open(options->lcm_url, why);
    bool ok = daemon->bus;
    for (int kind = 0; ok && kind < SERVER_KINDS; kind++)
        ok = bus_listen(daemon->bus, server_query_channel(daemon->server, (enum server_kind) kind),
                        why);
    if (!ok)
        fprintf(stderr, "fmbd: %s\n", why);
    return ok;
}

static bool open_server(struct daemon *daemon, const struct daemon_options *options,
                        int64_t server_id)
{
    struct server_options server = {.prefix = options->prefix,
                                    .frames = options->frames,
                                    .server_id = server_id,
                                    .publish = publish,
                                    .user = daemon};
    if (getrandom(server.secret, sizeof server.secret, 0) != (ssize_t) sizeof server.secret) {
        perror("fmbd: getrandom");
        return false;
    }
    daemon->server = server_create(&server);
    if (!daemon->server)
        fprintf(stderr, "fmbd: no memory for %zu frames\n", options->frames);
    return daemon->server;
}

static bool serve_until_signal(struct daemon *daemon, const struct daemon_options *options,
                               int64_t server_id)
{
    daemon->signals = signals_open();
    if (daemon->signals < 0) {
        perror("fmbd: signals");
        return false;
    }
    if (!confine_user(options->user))
        return false;
    confine_calls();
    notify(&daemon->manager, "READY=1");
    report_ready(daemon, options, server_id);
    serve(daemon);
    notify(&daemon->manager, "STOPPING=1");
    return !daemon->failed;
}

/* Returns the exit code of the process. */
static int run(const struct daemon_options *options)
{
    struct daemon daemon = {0};
    const int64_t server_id = random_id();
    notify_open(&daemon.manager);
    const bool ended_well = open_server(&daemon, options, server_id) &&
                            open_bus(&daemon, options) &&
                            serve_until_signal(&daemon, options, server_id);
    server_destroy(daemon.server);
    bus_close(daemon.bus);
    if (daemon.manager.fd >= 0)
        close(daemon.manager.fd);
    return ended_well ? EXIT_SUCCESS : EXIT_FAILURE;
}

/* Opens /dev/null for each standard descriptor that is closed. Otherwise the next file or socket
 * opened would get its number, and messages on stderr would be written to it. */
static void open_standard_descriptors(void)
{
    int fd;
    do
        fd = open("/dev/null", O_RDWR);
    while (fd >= 0 && fd <= STDERR_FILENO);
    if (fd > STDERR_FILENO)
        close(fd);
}

int main(int argc, char **argv)
{
    struct daemon_options options;
    open_standard_descriptors();
    signal(SIGPIPE, SIG_IGN); /* a reader of stderr that goes away must not end the service */
    const int code = parse_options(argc, argv, &options);
    return code >= 0 ? code : run(&options);
}
