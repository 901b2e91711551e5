#define _GNU_SOURCE
#include "confine.h"

#include <errno.h>
#include <grp.h>
#include <pwd.h>
#include <seccomp.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <unistd.h>

static const char default_user[] = "nobody";

/* ---- User ---- */

/* Changes the groups first: afterwards the process has no right to. */
static bool become(const struct passwd *user)
{
    return setgid(user->pw_gid) == 0 && setgroups(1, &user->pw_gid) == 0 &&
           setuid(user->pw_uid) == 0;
}

bool confine_user(const char *user)
{
    if (!user && geteuid() != 0)
        return true;
    const char *name = user ? user : default_user;
    const struct passwd *entry = getpwnam(name);
    if (!entry) {
        fprintf(stderr, "fmbd: there is no user '%s': choose one with --user\n", name);
        return false;
    }
    if ((entry->pw_uid == geteuid() && entry->pw_uid == getuid()) || become(entry))
        return true;
    if (errno == EINVAL) {
        fprintf(stderr,
                "fmbd: warning: the id of user '%s' does not exist here: going on as user %d\n",
                name, (int) geteuid());
        return true;
    }
    fprintf(stderr, "fmbd: cannot become user '%s' (%s): --user needs root\n", name,
            strerror(errno));
    return false;
}

/* ---- System calls ---- */

#if defined(__SANITIZE_ADDRESS__)
enum { SANITIZED = 1 };
#elif defined(__has_feature)
enum { SANITIZED = __has_feature(address_sanitizer) };
#else
enum { SANITIZED = 0 };
#endif

/* For receiving, publishing (liblcm), waiting, memory, lines on stderr, and exiting. */
static const int allowed[] = {
    SCMP_SYS(recvmmsg),
    SCMP_SYS(sendmsg),
    SCMP_SYS(sendto),
    SCMP_SYS(getsockopt),
    SCMP_SYS(poll),
    SCMP_SYS(ppoll),
    SCMP_SYS(sched_yield),
    SCMP_SYS(futex),
    SCMP_SYS(clock_gettime),
    SCMP_SYS(gettimeofday),
    SCMP_SYS(restart_syscall),
    SCMP_SYS(rt_sigreturn),
    SCMP_SYS(brk),
    SCMP_SYS(mmap),
    SCMP_SYS(munmap),
    SCMP_SYS(mremap),
    SCMP_SYS(madvise),
    SCMP_SYS(mprotect),
    SCMP_SYS(getrandom),
    SCMP_SYS(read),
    SCMP_SYS(write),
    SCMP_SYS(writev),
    SCMP_SYS(fstat),
    SCMP_SYS(newfstatat),
    SCMP_SYS(close),
    SCMP_SYS(rt_sigprocmask),
    SCMP_SYS(rt_sigaction),
    SCMP_SYS(getpid),
    SCMP_SYS(gettid),
    SCMP_SYS(tgkill),
    SCMP_SYS(exit),
    SCMP_SYS(exit_group),
};

static bool filter_calls(void)
{
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
    if (!filter)
        return false;
    int error = 0;
    for (size_t i = 0; i < sizeof allowed / sizeof *allowed && !error; i++)
        error = seccomp_rule_add(filter, SCMP_ACT_ALLOW, allowed[i], 0);
    if (!error)
        error = seccomp_load(filter);
    seccomp_release(filter);
    return error == 0;
}

void confine_calls(void)
{
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    if (!SANITIZED && !filter_calls())
        fputs("fmbd: warning: the kernel takes no filter of system calls\n", stderr);
}
