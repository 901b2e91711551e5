#include "stderr_ready.h"

#include "clock.h"

#include <poll.h>
#include <unistd.h>

bool stderr_ready(void)
{
    struct pollfd wait = {.fd = STDERR_FILENO, .events = POLLOUT};
    return poll(&wait, 1, 0) == 1 && wait.revents & POLLOUT;
}

bool stderr_report_due(int64_t last_ns)
{
    return (last_ns == 0 || clock_ns() - last_ns >= 1000000000) && stderr_ready();
}
