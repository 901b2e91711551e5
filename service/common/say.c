#include "say.h"

#include "clock.h"

#include <poll.h>
#include <unistd.h>

bool say_now(void)
{
    struct pollfd wait = {.fd = STDERR_FILENO, .events = POLLOUT};
    return poll(&wait, 1, 0) == 1 && wait.revents & POLLOUT;
}

bool say_again(int64_t last_ns)
{
    return (last_ns == 0 || clock_ns() - last_ns >= 1000000000) && say_now();
}
