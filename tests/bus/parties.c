#define _GNU_SOURCE
#include "parties.h"

#include <fcntl.h>
#include <pwd.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "process.h"

/* The echo and its client get as large a receive buffer as fmbd requests, up to the limit of the
 * system. */
enum { ECHO_BUFFER = 4 << 20, PATH_LENGTH_MAX = 4096 };

static cpu_set_t allowed;
static bool allowed_known;

/* The client runs on the last CPU that the program may use; the service too, or on the first one.
 */
bool parties_cpus(int cores, struct cpus *out)
{
    if (!allowed_known)
        allowed_known = sched_getaffinity(0, sizeof allowed, &allowed) == 0;
    int first = -1, last = -1;
    for (int cpu = 0; cpu < CPU_SETSIZE; cpu++)
        if (allowed_known && CPU_ISSET(cpu, &allowed)) {
            first = first < 0 ? cpu : first;
            last = cpu;
        }
    *out = (struct cpus){cores, last, cores == 1 ? last : first};
    return last >= 0 && (cores == 1 || first < last);
}

static bool pin(int cpu)
{
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(cpu, &one);
    return sched_setaffinity(0, sizeof one, &one) == 0;
}

/* build/bus/bench-bus and "../fmbd" give build/bus/../fmbd. */
static bool beside(const char *name, char path[PATH_LENGTH_MAX])
{
    const ssize_t length = readlink("/proc/self/exe", path, PATH_LENGTH_MAX - 1);
    if (length < 0)
        return false;
    path[length] = '\0';
    char *slash = strrchr(path, '/');
    const size_t space = PATH_LENGTH_MAX - (size_t) (slash + 1 - path);
    return (size_t) snprintf(slash + 1, space, "%s", name) < space;
}

static void say_into(const char *log)
{
    char path[PATH_LENGTH_MAX];
    const int fd = beside(log, path) ? open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666) : -1;
    if (fd >= 0)
        dup2(fd, STDERR_FILENO);
}

/* In the child. Its parent may have ended before prctl() was called. */
static void become(int cpu, pid_t parent, const char *program, char *const *arguments)
{
    char path[PATH_LENGTH_MAX], log[64];
    snprintf(log, sizeof log, "%s.log",
             strrchr(program, '/') ? strrchr(program, '/') + 1 : program);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() == parent && pin(cpu) && beside(program, path)) {
        say_into(log);
        execv(path, arguments);
    }
    perror(program);
    _exit(127);
}

static pid_t start(int cpu, const char *program, char *const *arguments)
{
    const pid_t parent = getpid(), child = fork();
    if (child == 0)
        become(cpu, parent, program, arguments);
    if (child < 0)
        perror("bench-bus: fork");
    return child;
}

/* fmbd stays the user that it is started as: a process that becomes another one loses the signal
 * that ends it with its parent. */
static pid_t start_service(int cpu, char *url)
{
    char name[] = "fmbd", url_option[] = "--lcm-url", user_option[] = "--user";
    const struct passwd *user = getpwuid(geteuid());
    char *arguments[] = {
        name, url_option, url, user ? user_option : NULL, user ? user->pw_name : NULL, NULL};
    return start(cpu, "../fmbd", arguments);
}

bool parties_start(const struct cpus *cpus, struct parties *out)
{
    const int port = 20000 + (int) (random_id() % 20000) * 2;
    char echo[] = "echo";
    snprintf(out->service_url, sizeof out->service_url, "udpm://239.255.76.67:%d?ttl=0", port);
    snprintf(out->echo_url, sizeof out->echo_url, "udpm://239.255.76.67:%d?ttl=0&recv_buf_size=%d",
             port + 1, ECHO_BUFFER);
    out->service = out->echo = -1;
    if (!pin(cpus->client)) {
        perror("bench-bus: pinning it to a CPU");
        return false;
    }
    fflush(NULL);
    out->service = start_service(cpus->service, out->service_url);
    out->echo = start(cpus->service, "echo", (char *[]){echo, out->echo_url, NULL});
    return out->service > 0 && out->echo > 0;
}

/* A process that does not end within two seconds is killed. */
static void end(pid_t process)
{
    const struct timespec step = {0, 10000000};
    kill(process, SIGTERM);
    for (int i = 0; i < 200 && waitpid(process, NULL, WNOHANG) == 0; i++)
        nanosleep(&step, NULL);
    if (kill(process, 0) != 0)
        return;
    kill(process, SIGKILL);
    waitpid(process, NULL, 0);
}

void parties_stop(struct parties *parties)
{
    if (parties->service > 0)
        end(parties->service);
    if (parties->echo > 0)
        end(parties->echo);
    parties->service = parties->echo = -1;
}

const char *parties_log(void)
{
    static char line[512];
    char path[PATH_LENGTH_MAX];
    line[0] = '\0';
    FILE *log = beside("fmbd.log", path) ? fopen(path, "r") : NULL;
    while (log && fgets(line, sizeof line, log))
        ;
    if (log)
        fclose(log);
    return line;
}
