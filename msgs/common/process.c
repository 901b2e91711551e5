#include "process.h"

#include "clock.h"
#include "query.h"

#include <poll.h>
#include <signal.h>
#include <stddef.h>
#include <sys/random.h>
#include <sys/signalfd.h>
#include <unistd.h>

int signals_open(void)
{
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGINT);
    sigaddset(&set, SIGTERM);
    if (sigprocmask(SIG_BLOCK, &set, NULL) != 0)
        return -1;
    return signalfd(-1, &set, SFD_CLOEXEC);
}

bool stderr_ready(void)
{
    struct pollfd wait = {.fd = STDERR_FILENO, .events = POLLOUT};
    return poll(&wait, 1, 0) == 1 && wait.revents & POLLOUT;
}

bool stderr_report_due(int64_t last_ns)
{
    return (last_ns == 0 || clock_ns() - last_ns >= 1000000000) && stderr_ready();
}

int64_t random_id(void)
{
    uint64_t bits;
    if (getrandom(&bits, sizeof bits, 0) != (ssize_t) sizeof bits)
        bits = (uint64_t) clock_utime();
    int64_t id = (int64_t) (bits & (uint64_t) QUERY_ID_MAX);
    return id ? id : 1;
}
