/* fmbd: answers pairs of frames on an LCM bus. */
#include "bus.h"
#include "cache.h"
#include "fmb/fmb.h"
#include "supervisor.h"
#include "worker.h"

#include <errno.h>
#include <fcntl.h>
#include <getopt.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { EXIT_USAGE = 2 };
enum { DEFAULT_BODIES = 65536 };

static const char usage[] =
    "usage: fmbd [options]\n"
    "\n"
    "Answers pairs of frames (cuboids, tetrahedra, faces; 2D and 3D; at rest and moving) on an\n"
    "LCM bus: separated, touching or overlapping, when, and in which box. Queries come on\n"
    "FMB_PAIR_QUERY and FMB_SCENE_QUERY, results go to FMB_PAIR_RESULT and\n"
    "FMB_SCENE_RESULT, once a second a heartbeat to FMB_STATUS.\n"
    "Ask with 'fmb query'; ends on SIGINT and SIGTERM. It is a supervisor and a worker: a worker\n"
    "that malformed packets crash (LCM lets them) is replaced at once, with an empty cache.\n"
    "\n"
    "  -l, --lcm-url URL   the bus; else LCM_DEFAULT_URL; else this host alone\n"
    "                      (udpm://239.255.76.67:7667?ttl=0)\n"
    "  -p, --prefix P      put P in front of the channels' names: for a second service\n"
    "  -b, --bodies N      keep the inverse matrices of N bodies (default %d, 1 to %d)\n"
    "  -u, --unfiltered    let LCM see all that comes to its port. Without it the kernel drops "
    "what\n"
    "                      is not for this service before LCM reads it: results, channels of\n"
    "                      others, and the pieces of large messages that can crash LCM\n"
    "  -h, --help          print this\n"
    "  -V, --version       print the version\n"
    "\n"
    "Exit codes: 0 ended by a signal, 1 no bus, no memory, or workers that die before they are\n"
    "ready, 2 wrong options.\n";

static int wrong_option(const char *option, const char *value, const char *expected)
{
    fprintf(stderr, "fmbd: %s '%s': expected %s; see fmbd --help\n", option, value, expected);
    return EXIT_USAGE;
}

static int wrong_bodies(const char *value)
{
    char expected[48];
    snprintf(expected, sizeof expected, "a number from 1 to %d", CACHE_BODIES_MAX);
    return wrong_option("--bodies", value, expected);
}

static bool parse_bodies(const char *text, size_t *out)
{
    char *end;
    errno = 0;
    unsigned long long value = strtoull(text, &end, 10);
    bool digits = text[0] >= '0' && text[0] <= '9';
    *out = (size_t) value;
    return digits && *end == '\0' && errno == 0 && value >= 1 && value <= CACHE_BODIES_MAX;
}

/* Returns -1 to go on, or the code to exit with. */
static int parse_options(int argc, char **argv, struct worker_options *out)
{
    static const struct option long_options[] = {
        {"lcm-url", required_argument, NULL, 'l'},
        {"prefix", required_argument, NULL, 'p'},
        {"bodies", required_argument, NULL, 'b'},
        {"unfiltered", no_argument, NULL, 'u'},
        {"help", no_argument, NULL, 'h'},
        {"version", no_argument, NULL, 'V'},
        {0},
    };
    *out = (struct worker_options){.prefix = "", .bodies = DEFAULT_BODIES};
    int option;
    while ((option = getopt_long(argc, argv, ":l:p:b:uhV", long_options, NULL)) != -1) {
        switch (option) {
        case 'l': out->lcm_url = optarg; break;
        case 'p':
            out->prefix = optarg;
            if (!bus_prefix_ok(optarg))
                return wrong_option("--prefix", optarg, "at most 32 letters, digits, _ or -");
            break;
        case 'b':
            if (!parse_bodies(optarg, &out->bodies))
                return wrong_bodies(optarg);
            break;
        case 'u': out->unfiltered = true; break;
        case 'h': printf(usage, DEFAULT_BODIES, CACHE_BODIES_MAX); return EXIT_SUCCESS;
        case 'V': printf("fmbd %s\n", fmb_version()); return EXIT_SUCCESS;
        case ':': return wrong_option("option", argv[optind - 1], "a value after it");
        default: return wrong_option("option", argv[optind - 1], "one that there is");
        }
    }
    if (optind < argc)
        return wrong_option("argument", argv[optind], "options only");
    return -1;
}

/* A standard descriptor that is closed would be the number of what is opened next, and lines meant
 * for people would go there: to /dev/null instead. */
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
    struct worker_options options;
    open_standard_descriptors();
    signal(SIGPIPE, SIG_IGN); /* a reader of stderr that goes away must not end the service */
    int code = parse_options(argc, argv, &options);
    return code >= 0 ? code : supervisor_run(worker_run, &options);
}
