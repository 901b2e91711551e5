#include "notify.h"

#include "clock.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

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

static void report(const struct notify *notify, const char *text)
{
    if (notify->fd >= 0)
        send(notify->fd, text, strlen(text), MSG_DONTWAIT | MSG_NOSIGNAL);
}

void notify_open(struct notify *notify)
{
    *notify = (struct notify){.fd = connect_to(getenv("NOTIFY_SOCKET"))};
    if (notify->fd >= 0)
        notify->watchdog_ns = watchdog_ns();
}

void notify_close(struct notify *notify)
{
    if (notify->fd >= 0)
        close(notify->fd);
}

void notify_ready(struct notify *notify)
{
    report(notify, "READY=1");
}

void notify_stopping(struct notify *notify)
{
    report(notify, "STOPPING=1");
}

int notify_alive(struct notify *notify, int most_ms)
{
    if (!notify->watchdog_ns)
        return most_ms;
    const int64_t now_ns = clock_ns();
    if (now_ns >= notify->due_ns) {
        report(notify, "WATCHDOG=1");
        notify->due_ns = now_ns + notify->watchdog_ns;
    }
    const int64_t left_ms = (notify->due_ns - now_ns) / 1000000;
    return left_ms < most_ms ? (int) left_ms : most_ms;
}
