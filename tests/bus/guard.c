#include "guard.h"

#include <signal.h>
#include <stddef.h>
#include <sys/time.h>

static volatile sig_atomic_t hit;

static void on_alarm(int signal)
{
    (void) signal;
    hit = 1;
}

static struct timeval time_of(double seconds)
{
    const long whole = (long) seconds;
    return (struct timeval){whole, (long) ((seconds - (double) whole) * 1e6)};
}

/* A signal between two system calls interrupts neither: so it is repeated. */
void guard_begin(double seconds)
{
    struct sigaction action = {.sa_handler = on_alarm};
    const struct itimerval timer = {.it_value = time_of(seconds), .it_interval = time_of(0.1)};
    sigemptyset(&action.sa_mask);
    hit = 0;
    sigaction(SIGALRM, &action, NULL);
    setitimer(ITIMER_REAL, &timer, NULL);
}

void guard_end(void)
{
    const struct itimerval none = {{0, 0}, {0, 0}};
    setitimer(ITIMER_REAL, &none, NULL);
}

bool guard_hit(void)
{
    return hit;
}
