#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include "replay_jobs.h"

#include "allocate.h"
#include "temporary.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* A process for a part. */
struct job {
    struct replay_part part;
    pid_t pid;           /* 0: it has ended, or never was */
    FILE *told;          /* owned: what it has told, records one behind the other */
    struct tally *tally; /* [log_count], shared */
    int64_t *progress;   /* shared: bytes that it has gone through */
};

/* ---- What a process tells, and its telling again ----
 *
 * Texts that are static are where they were: the process is a copy of this one. */

enum record_kind { RECORD_FOUND, RECORD_UNREADABLE, RECORD_DAMAGE, RECORD_KINDS };

struct unreadable {
    struct match_place place;
    char channel[64];
    const char *what; /* static */
};

struct damaged {
    int log;
    struct log_damage damage;
};

static void write_record(FILE *file, enum record_kind kind, const void *record, size_t size)
{
    putc((int) kind, file);
    if (size > 0)
        fwrite(record, size, 1, file);
}

static void tell_found(void *user, const struct found *found)
{
    const struct job *job = user;
    write_record(job->told, RECORD_FOUND, NULL, 0);
    found_write(job->told, found);
}

static void tell_unreadable(void *user, const struct match_place *place, const char *channel,
                            const char *what)
{
    const struct job *job = user;
    struct unreadable record = {.place = *place, .what = what};
    snprintf(record.channel, sizeof record.channel, "%s", channel);
    write_record(job->told, RECORD_UNREADABLE, &record, sizeof record);
}

static void tell_damage(void *user, int log, const struct log_damage *damage)
{
    const struct job *job = user;
    const struct damaged record = {log, *damage};
    write_record(job->told, RECORD_DAMAGE, &record, sizeof record);
}

static void tell_progress(void *user, int64_t bytes)
{
    const struct job *job = user;
    __atomic_store_n(job->progress, bytes, __ATOMIC_RELAXED);
}

static bool again_found(FILE *told, const struct replay_sink *sink)
{
    struct found found;
    struct found_text text;
    if (!found_read(told, &found, &text))
        return false;
    sink->found(sink->user, &found);
    return true;
}

static bool again_unreadable(FILE *told, const struct replay_sink *sink)
{
    struct unreadable record;
    if (fread(&record, sizeof record, 1, told) != 1)
        return false;
    sink->unreadable(sink->user, &record.place, record.channel, record.what);
    return true;
}

static bool again_damage(FILE *told, const struct replay_sink *sink)
{
    struct damaged record;
    if (fread(&record, sizeof record, 1, told) != 1)
        return false;
    sink->damage(sink->user, record.log, &record.damage);
    return true;
}

/* False: the file failed. */
static bool tell_again(FILE *told, const struct replay_sink *sink)
{
    static bool (*const again[])(FILE *, const struct replay_sink *) = {
        [RECORD_FOUND] = again_found,
        [RECORD_UNREADABLE] = again_unreadable,
        [RECORD_DAMAGE] = again_damage};
    bool good = true;
    rewind(told);
    for (int kind; good && (kind = getc(told)) != EOF;)
        good = kind < RECORD_KINDS && again[kind](told, sink);
    return good && !ferror(told);
}

/* ---- Processes ---- */

static _Noreturn void work(const struct replay_options *options, const struct job *job)
{
    const struct replay_sink sink = {tell_found, tell_unreadable, tell_damage, tell_progress,
                                     (void *) job};
    bool good = replay_run(options, job->part, &sink, job->tally);
    if (fflush(job->told) != 0 || ferror(job->told)) {
        perror("fmb: a temporary file");
        good = false;
    }
    _exit(good ? 0 : 1);
}

static bool begin(const struct replay_options *options, struct job *job)
{
    job->told = temporary_open();
    if (!job->told) {
        perror("fmb: a temporary file");
        return false;
    }
    job->pid = fork();
    if (job->pid == 0)
        work(options, job);
    if (job->pid > 0)
        return true;
    perror("fmb: another process");
    job->pid = 0;
    return false;
}

/* Of those that have ended. False: badly. */
static bool reap(struct job *job)
{
    int status = -1; /* where it is not known */
    const pid_t ended = job->pid == 0 ? 0 : waitpid(job->pid, &status, WNOHANG);
    if (ended == 0)
        return true;
    job->pid = 0;
    *job->progress = job->part.end;
    if (WIFSIGNALED(status))
        fprintf(stderr, "fmb: a process of the replay was ended by a signal: %s\n",
                strsignal(WTERMSIG(status)));
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/* Bytes of their parts that all have gone through. */
static int64_t progress_of(const struct job *job, int jobs)
{
    int64_t sum = 0;
    for (int i = 0; i < jobs; i++) {
        const int64_t at = __atomic_load_n(job[i].progress, __ATOMIC_RELAXED);
        const int64_t end = at < job[i].part.end ? at : job[i].part.end;
        sum += end > job[i].part.begin ? end - job[i].part.begin : 0;
    }
    return sum;
}

static bool wait_for(struct job *job, int jobs, const struct replay_sink *sink)
{
    const struct timespec pause = {.tv_nsec = 20000000};
    bool good = true, any = true;
    while (any) {
        any = false;
        for (int i = 0; i < jobs; i++) {
            good = reap(&job[i]) && good;
            any = any || job[i].pid > 0;
        }
        sink->progress(sink->user, progress_of(job, jobs));
        if (any)
            nanosleep(&pause, NULL);
    }
    return good;
}

static bool run_all(const struct replay_options *options, struct job *job, int jobs,
                    const struct replay_sink *sink, struct tally *tally)
{
    bool good = true;
    fflush(NULL);             /* what is buffered is written once */
    signal(SIGCHLD, SIG_DFL); /* who started this may not want to hear of children; this does */
    for (int i = 0; i < jobs; i++)
        good = begin(options, &job[i]) && good;
    good = wait_for(job, jobs, sink) && good;
    for (int i = 0; i < jobs; i++) {
        good = job[i].told && tell_again(job[i].told, sink) && good;
        for (int log = 0; log < options->log_count; log++)
            tally_add(&tally[log], &job[i].tally[log]);
    }
    return good;
}

bool replay_jobs(const struct replay_options *options, int jobs, int64_t size,
                 const struct replay_sink *sink, struct tally *tally)
{
    if (jobs <= 1)
        return replay_run(options, (struct replay_part){0, size}, sink, tally);
    const size_t tallies = (size_t) jobs * (size_t) options->log_count;
    const size_t bytes = tallies * sizeof *tally + (size_t) jobs * sizeof(int64_t);
    void *shared = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED)
        allocate_failed();
    struct job *job = allocate((size_t) jobs, sizeof *job);
    struct tally *shared_tally = shared;
    for (int i = 0; i < jobs; i++) {
        job[i].part =
            (struct replay_part){size / jobs * i, i + 1 < jobs ? size / jobs * (i + 1) : size};
        job[i].tally = shared_tally + (size_t) i * (size_t) options->log_count;
        job[i].progress = (int64_t *) (shared_tally + tallies) + i;
    }
    const bool good = run_all(options, job, jobs, sink, tally);
    for (int i = 0; i < jobs; i++)
        if (job[i].told)
            fclose(job[i].told);
    free(job);
    munmap(shared, bytes);
    return good;
}
