/* netns CMD [ARG...]: runs a command where LCM's multicast stays on this machine.
 *
 * The command gets a network namespace of its own, with a loopback interface that carries
 * multicast. So it does not matter which routes the machine has, and commands that run at the same
 * time do not receive each other's messages. A user other than root also gets a user namespace.
 *
 * Where namespaces are forbidden, the command runs in place if there is a route for multicast, on a
 * random port and with ttl=0 (LCM_DEFAULT_URL). No message leaves the machine then, but the group
 * memberships (IGMP) do, which is reported. Without a route nothing is run; the exit code is 77.
 *
 * FMB_NETNS tells the command which it is: "own" or "in place". */
#define _GNU_SOURCE
#include <arpa/inet.h>
#include <fcntl.h>
#include <net/if.h>
#include <net/route.h>
#include <sched.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <unistd.h>

#define GROUP "239.255.76.67"
enum { SKIPPED = 77, CANNOT_RUN = 127 };

static bool write_file(const char *path, const char *text)
{
    int fd = open(path, O_WRONLY);
    bool ok = fd >= 0 && write(fd, text, strlen(text)) == (ssize_t) strlen(text);
    if (fd >= 0)
        close(fd);
    return ok;
}

/* A user namespace in which the caller is root. */
static bool enter_with_user_namespace(void)
{
    char uid_map[32], gid_map[32];
    snprintf(uid_map, sizeof uid_map, "0 %d 1", (int) getuid());
    snprintf(gid_map, sizeof gid_map, "0 %d 1", (int) getgid());
    return unshare(CLONE_NEWUSER | CLONE_NEWNET) == 0 &&
           write_file("/proc/self/setgroups", "deny") &&
           write_file("/proc/self/uid_map", uid_map) && write_file("/proc/self/gid_map", gid_map);
}

static bool enter_namespace(void)
{
    return (geteuid() == 0 && unshare(CLONE_NEWNET) == 0) || enter_with_user_namespace();
}

static struct sockaddr address(const char *text)
{
    struct sockaddr_in in = {.sin_family = AF_INET};
    struct sockaddr out;
    inet_pton(AF_INET, text, &in.sin_addr);
    memcpy(&out, &in, sizeof out);
    return out;
}

/* ip link set lo up multicast on; ip route add 224.0.0.0/4 dev lo */
static bool set_up_loopback(void)
{
    char lo[] = "lo";
    struct ifreq flags = {.ifr_flags = IFF_UP | IFF_RUNNING | IFF_MULTICAST};
    struct rtentry route = {.rt_flags = RTF_UP, .rt_dev = lo};
    strcpy(flags.ifr_name, lo);
    route.rt_dst = address("224.0.0.0");
    route.rt_genmask = address("240.0.0.0");
    int fd = socket(AF_INET, SOCK_DGRAM, 0);
    bool ok = fd >= 0 && ioctl(fd, SIOCSIFFLAGS, &flags) == 0 && ioctl(fd, SIOCADDRT, &route) == 0;
    if (fd >= 0)
        close(fd);
    return ok;
}

static bool has_route(void)
{
    struct sockaddr_in group = {.sin_family = AF_INET, .sin_port = htons(7667)};
    inet_pton(AF_INET, GROUP, &group.sin_addr);
    int fd = socket(AF_INET, SOCK_DGRAM, 0);
    bool ok = fd >= 0 && connect(fd, (const struct sockaddr *) &group, sizeof group) == 0;
    if (fd >= 0)
        close(fd);
    return ok;
}

static void use_random_port(void)
{
    uint16_t number = 0;
    char url[64];
    if (getrandom(&number, sizeof number, 0) != sizeof number)
        number = (uint16_t) getpid();
    snprintf(url, sizeof url, "udpm://" GROUP ":%d?ttl=0", 20000 + number % 40000);
    setenv("LCM_DEFAULT_URL", url, 1);
    setenv("FMB_NETNS", "in place", 1);
    fprintf(stderr,
            "netns: no network namespace to be had; running in place on %s: messages stay on this "
            "machine, group memberships (IGMP) do not\n",
            url);
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        fputs("usage: netns CMD [ARG...]\n", stderr);
        return 2;
    }
    if (enter_namespace()) {
        if (!set_up_loopback()) {
            perror("netns: loopback");
            return SKIPPED;
        }
        unsetenv("LCM_DEFAULT_URL");
        setenv("FMB_NETNS", "own", 1);
    } else if (has_route()) {
        use_random_port();
    } else {
        fputs("netns: no network namespace to be had, and no route for multicast\n", stderr);
        return SKIPPED;
    }
    execvp(argv[1], argv + 1);
    perror(argv[1]);
    return CANNOT_RUN;
}
