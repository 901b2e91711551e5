#define _GNU_SOURCE /* sigabbrev_np() */
#include "supervisor.h"

#include "clock.h"
#include "say.h"

#include <errno.h>
#include <inttypes.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum {
    /* In a row, before any worker was ever ready: what crashes every start will not mend itself
     * within a second (750 ms, with the pauses below), and who started the service is waiting. */
    FIRST_TRIES = 5,
    /* In a row, once a worker had been ready: some 55 s, with the pauses below. A network that
     * comes back brings the route for multicast back within that; beyond it a service manager,
     * which sees more, is to decide. */
    LATER_TRIES = 60,
    /* Pauses after workers that died before they were ready. The first is shorter than anybody
     * notices, the longest costs nothing and is not long to wait once the reason is gone. */
    PAUSE_MIN_MS = 50,
    PAUSE_MAX_MS = 1000,
    /* From start to start, where a worker had been ready: a flood of packets that kill costs a
     * hundred starts a second, a fifth of one core, and not all of it. Who lived longer is
     * replaced without any pause. */
    SPACING_MS = 10,
    /* LCM gives up opening a bus after 10 s. Whoever is not ready after this long hangs. */
    START_LIMIT_MS = 15000,
    /* A worker ends after the query that it is at: milliseconds. Shorter than the patience of
     * service managers. */
    STOP_LIMIT_MS = 3000,
    /* On standard error, about workers that died. */
    LINES_PER_SECOND = 10,
};

struct supervisor {
    supervisor_job *job;
    const void *options;
    sigset_t signals;
    int ready; /* eventfd that the worker writes to */
    int64_t restarts;
    bool served;       /* some worker has been ready */
    int failures;      /* workers in a row that died before they were ready */
    int64_t second_ns; /* when the second began in which so many lines were said */
    int lines;
};

struct worker {
    pid_t pid; /* -1: it could not be forked */
    int64_t begin_ns;
    bool ready;
    /* Once it is dead. */
    int status; /* as waitpid() gives it; without a pid: errno */
    int64_t end_ns;
};

static int64_t from_ms(int64_t ms)
{
    return ms * 1000000;
}

/* Blocks the signals that are waited for. SIGCHLD must not be ignored, as it is if whoever started
 * this ignored it: then nothing would be left to wait for. */
static bool set_up(struct supervisor *supervisor)
{
    signal(SIGCHLD, SIG_DFL);
    sigemptyset(&supervisor->signals);
    sigaddset(&supervisor->signals, SIGINT);
    sigaddset(&supervisor->signals, SIGTERM);
    sigaddset(&supervisor->signals, SIGCHLD);
    supervisor->ready = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    return supervisor->ready >= 0 && sigprocmask(SIG_BLOCK, &supervisor->signals, NULL) == 0;
}

/* ---- Start ----------------------------------------------------------------------------------- */

/* A core for each crash would fill the disk, and the crash would take as long as writing it. Less
 * than the smallest core means none; 0 would not stop a core that is piped to a program. */
static void leave_no_core(void)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_CORE, &limit) != 0 || limit.rlim_max == 0)
        return;
    limit.rlim_cur = 1;
    setrlimit(RLIMIT_CORE, &limit);
}

/* What a worker has that the supervisor has not: it dies with its parent. If the parent was gone
 * before that was said, it is over. */
static _Noreturn void become_worker(const struct supervisor *supervisor, pid_t parent)
{
    if (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || getppid() != parent)
        _exit(EXIT_FAILURE);
    leave_no_core();
    signal(SIGTERM, SIG_DFL);
    sigprocmask(SIG_UNBLOCK, &supervisor->signals, NULL);
    exit(supervisor->job(supervisor->options, supervisor->restarts, supervisor->ready));
}

static void start(const struct supervisor *supervisor, struct worker *worker)
{
    pid_t parent = getpid();
    *worker = (struct worker){.begin_ns = clock_ns()};
    worker->pid = fork();
    if (worker->pid == 0)
        become_worker(supervisor, parent);
    if (worker->pid < 0) {
        worker->status = errno;
        worker->end_ns = clock_ns();
    }
}

/* ---- Waiting --------------------------------------------------------------------------------- */

/* The next of the signals, or 0 once it is later than a time. Of several, SIGINT and SIGTERM come
 * before SIGCHLD, since lower numbers do: a worker that was ended by what was sent to both is not
 * taken for one that died by itself. */
static int next_signal(const struct supervisor *supervisor, int64_t until_ns)
{
    for (;;) {
        int64_t left = until_ns - clock_ns();
        if (left < 0)
            left = 0;
        struct timespec time = {.tv_sec = left / 1000000000, .tv_nsec = left % 1000000000};
        int number = sigtimedwait(&supervisor->signals, NULL, &time);
        if (number > 0)
            return number;
        if (errno == EAGAIN)
            return 0;
    }
}

static void see_whether_ready(struct supervisor *supervisor, struct worker *worker)
{
    uint64_t count;
    if (read(supervisor->ready, &count, sizeof count) == (ssize_t) sizeof count) {
        worker->ready = true;
        supervisor->served = true;
    }
}

static bool reap(struct supervisor *supervisor, struct worker *worker)
{
    if (waitpid(worker->pid, &worker->status, WNOHANG) != worker->pid)
        return false;
    see_whether_ready(supervisor, worker);
    worker->end_ns = clock_ns();
    return true;
}

/* True: the worker is dead. False: a signal asks to end, whether it is dead or not. */
static bool wait_for_death(struct supervisor *supervisor, struct worker *worker)
{
    if (worker->pid < 0)
        return true;
    int64_t limit = worker->begin_ns + from_ms(START_LIMIT_MS);
    for (;;) {
        int number = next_signal(supervisor, limit);
        if (number == SIGCHLD) {
            if (reap(supervisor, worker))
                return true;
        } else if (number != 0) {
            return false;
        } else {
            see_whether_ready(supervisor, worker);
            if (!worker->ready)
                kill(worker->pid, SIGKILL); /* and so it dies while starting */
            limit = INT64_MAX;
        }
    }
}

/* False: a signal asks to end. */
static bool pause_until(const struct supervisor *supervisor, int64_t until_ns)
{
    int number;
    do
        number = next_signal(supervisor, until_ns);
    while (number == SIGCHLD);
    return number == 0;
}

/* ---- A worker that died ---------------------------------------------------------------------- */

enum { CAUSE_MAX = 128 };

static void describe(const struct worker *worker, char out[CAUSE_MAX])
{
    if (worker->pid < 0) {
        snprintf(out, CAUSE_MAX, "no process to be had (%s)", strerror(worker->status));
    } else if (WIFEXITED(worker->status)) {
        snprintf(out, CAUSE_MAX, "exit code %d", WEXITSTATUS(worker->status));
    } else {
        int number = WTERMSIG(worker->status);
        const char *name = sigabbrev_np(number);
        if (name)
            snprintf(out, CAUSE_MAX, "SIG%s", name);
        else
            snprintf(out, CAUSE_MAX, "signal %d", number);
    }
}

/* Whether another line may be said in this second. */
static bool may_say_death(struct supervisor *supervisor, int64_t now)
{
    if (supervisor->lines == 0 || now - supervisor->second_ns >= from_ms(1000)) {
        supervisor->second_ns = now;
        supervisor->lines = 0;
    }
    return supervisor->lines++ < LINES_PER_SECOND && say_now();
}

static void say_death(struct supervisor *supervisor, const struct worker *worker, int64_t pause_ms)
{
    char cause[CAUSE_MAX], pause[32] = "";
    if (!may_say_death(supervisor, worker->end_ns))
        return;
    describe(worker, cause);
    if (pause_ms > 0)
        snprintf(pause, sizeof pause, " in %" PRId64 " ms", pause_ms);
    fprintf(stderr, "fmbd: worker %d died after %.3f s%s: %s; restart %" PRId64 "%s\n",
            (int) worker->pid, 1e-9 * (double) (worker->end_ns - worker->begin_ns),
            worker->ready ? "" : ", while starting", cause, supervisor->restarts + 1, pause);
}

static int give_up(const struct supervisor *supervisor, const struct worker *worker)
{
    char cause[CAUSE_MAX];
    describe(worker, cause);
    if (say_now())
        fprintf(stderr,
                "fmbd: giving up: %d workers in a row died while starting, the last by %s; "
                "see what they said above, whether the bus can be used (--lcm-url), and the limits "
                "of the process (ulimit -a)\n",
                supervisor->failures, cause);
    return EXIT_FAILURE;
}

static int64_t pause_ms(int failures)
{
    int64_t pause = PAUSE_MIN_MS;
    for (int i = 1; i < failures && pause < PAUSE_MAX_MS; i++)
        pause *= 2;
    return pause < PAUSE_MAX_MS ? pause : PAUSE_MAX_MS;
}

/* Returns the code to exit with; or -1, and when the next worker is to start. */
static int consider(struct supervisor *supervisor, const struct worker *worker, int64_t *next_ns)
{
    if (worker->ready) {
        supervisor->failures = 0;
        *next_ns = worker->begin_ns + from_ms(SPACING_MS);
        say_death(supervisor, worker, 0);
        return -1;
    }
    if (supervisor->restarts == 0 && worker->pid >= 0 && WIFEXITED(worker->status))
        return WEXITSTATUS(worker->status);
    supervisor->failures++;
    if (supervisor->failures == (supervisor->served ? LATER_TRIES : FIRST_TRIES))
        return give_up(supervisor, worker);
    int64_t pause = pause_ms(supervisor->failures);
    *next_ns = worker->end_ns + from_ms(pause);
    say_death(supervisor, worker, pause);
    return -1;
}

/* Ends the worker, by force if need be; returns the code to exit with. */
static int stop(struct supervisor *supervisor, struct worker *worker)
{
    int64_t limit = clock_ns() + from_ms(STOP_LIMIT_MS);
    kill(worker->pid, SIGTERM);
    while (!reap(supervisor, worker))
        if (next_signal(supervisor, limit) == 0) {
            if (say_now())
                fprintf(stderr, "fmbd: worker %d does not end, and is killed\n", (int) worker->pid);
            kill(worker->pid, SIGKILL);
            limit = INT64_MAX;
        }
    return worker->ready && WIFEXITED(worker->status) ? WEXITSTATUS(worker->status) : EXIT_SUCCESS;
}

int supervisor_run(supervisor_job *job, const void *options)
{
    struct supervisor supervisor = {.job = job, .options = options};
    struct worker worker;
    int64_t next_ns;
    if (!set_up(&supervisor)) {
        perror("fmbd: signals");
        return EXIT_FAILURE;
    }
    for (;; supervisor.restarts++) {
        start(&supervisor, &worker);
        if (!wait_for_death(&supervisor, &worker))
            return stop(&supervisor, &worker);
        int code = consider(&supervisor, &worker, &next_ns);
        if (code >= 0)
            return code;
        if (!pause_until(&supervisor, next_ns))
            return EXIT_SUCCESS;
    }
}
