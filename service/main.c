/* fmbd: answers collision queries on an LCM bus. */
#include "bus.h"
#include "cache.h"
#include "daemon.h"
#include "fmb.h"

#include <errno.h>
#include <fcntl.h>
#include <getopt.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { EXIT_USAGE = 2 };
enum { DEFAULT_FRAMES = 65536 };

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

static int wrong_frames(const char *value)
{
    char expected[48];
    snprintf(expected, sizeof expected, "a number from 1 to %d", CACHE_FRAMES_MAX);
    return wrong_option("--frames", value, expected);
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
                return wrong_frames(optarg);
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
    return code >= 0 ? code : daemon_run(&options);
}
