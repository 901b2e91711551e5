#include "output.h"

#include "allocate.h"
#include "complain.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- Messages -------------------------------------------------------------------------------- */

static const char *remedy(int error)
{
    switch (error) {
    case EEXIST: return "; --force overwrites it";
    case ENOSPC:
    case EDQUOT: return "; free space there, or write elsewhere";
    case EFBIG: return "; no larger file is allowed there: write several";
    default: return "";
    }
}

void output_complain(const char *path, int error)
{
    if (error == ESTALE)
        complain("%s: deleted or truncated by another program", path);
    else if (error == EBUSY)
        complain("%s: this command prints there too: write to another file", path);
    else
        complain("%s: %s%s", path, strerror(error), remedy(error));
}

/* ---- Paths ----------------------------------------------------------------------------------- */

char *output_beside(const char *path, const char *name)
{
    const char *slash = strrchr(path, '/');
    const size_t folder = slash && name[0] != '/' ? (size_t) (slash - path) + 1 : 0;
    char *out = allocate(folder + strlen(name) + 1, 1);
    memcpy(out, path, folder);
    strcpy(out + folder, name);
    return out;
}

/* Resolves the symbolic links of a path, whose target may not exist. On input: the system has
 * followed the links (no ELOOP), so their number is finite. The caller frees the result. */
static char *follow_links(const char *path)
{
    char link[PATH_MAX], *at = output_beside("", path);
    ssize_t size;
    while ((size = readlink(at, link, sizeof link - 1)) >= 0) {
        link[size] = '\0';
        char *next = output_beside(at, link);
        free(at);
        at = next;
    }
    return at;
}

/* ---- Existing files -------------------------------------------------------------------------- */

enum { BEGIN_MAX = 64 };

/* The first bytes of a file of each kind. */
static const struct {
    const char *name, *begin;
} kinds[] = {
    [OUTPUT_PAGE] = {"a page (HTML)", "<!DOCTYPE html>"},
    [OUTPUT_REPORT] = {"a JUnit report",
                       "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites "},
    [OUTPUT_PROOF] = {"a proof (gzip)", "\x1f\x8b\x08"},
};

static bool is_same(const struct stat *a, const struct stat *b)
{
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

/* Returns standard output or standard error if that is the file, otherwise -1. */
static int standard_fd(const struct stat *file)
{
    struct stat standard;
    for (int fd = STDOUT_FILENO; fd <= STDERR_FILENO; fd++)
        if (fstat(fd, &standard) == 0 && is_same(&standard, file))
            return fd;
    return -1;
}

static bool is_at(const char *path, const struct stat *file)
{
    struct stat found;
    return path && stat(path, &found) == 0 && is_same(&found, file);
}

static bool is_input(const struct output_rules *rules, const struct stat *file)
{
    for (int i = 0; i < rules->input_count; i++)
        if (is_at(rules->input[i], file))
            return true;
    return is_at(rules->other_input, file);
}

/* Whether two outputs go to the same regular file, which may not exist yet. */
static bool goes_to_one_file(const char *a, const char *b)
{
    struct stat file[2] = {0}, folder[2];
    const bool absent = stat(a, &file[0]) != 0 && errno == ENOENT;
    if (stat(b, &file[1]) == 0 || errno != ENOENT || !absent)
        return S_ISREG(file[0].st_mode) && is_same(&file[0], &file[1]);
    char *at[] = {follow_links(a), follow_links(b)};
    char *in[] = {output_beside(at[0], "."), output_beside(at[1], ".")};
    const bool same = stat(in[0], &folder[0]) == 0 && stat(in[1], &folder[1]) == 0 &&
                      is_same(&folder[0], &folder[1]) &&
                      strcmp(at[0] + strlen(in[0]) - 1, at[1] + strlen(in[1]) - 1) == 0;
    for (int i = 0; i < 2; i++) {
        free(at[i]);
        free(in[i]);
    }
    return same;
}

static bool is_of_kind(const char *path, const char *begin)
{
    char found[BEGIN_MAX];
    const size_t size = strlen(begin);
    FILE *file = fopen(path, "rb");
    const bool same =
        file && fread(found, 1, size, file) == size && memcmp(found, begin, size) == 0;
    if (file)
        fclose(file);
    return same;
}

bool output_check(const struct output_options *options)
{
    struct stat old;
    if (!options->path)
        return true;
    for (const struct output_options *other = options->other; other; other = other->other)
        if (other->path && goes_to_one_file(options->path, other->path)) {
            complain("%s: two outputs of this command: write to two files", options->path);
            return false;
        }
    if (stat(options->path, &old) != 0 || !S_ISREG(old.st_mode))
        return true;
    if (is_input(options->rules, &old)) {
        complain("%s: this command reads it: write to another file", options->path);
        return false;
    }
    const bool printed = standard_fd(&old) >= 0;
    if (printed && strncmp(options->path, "/dev/", 5) != 0) { /* not /dev/stdout itself */
        output_complain(options->path, EBUSY);
        return false;
    }
    if (options->rules->force || old.st_size == 0 || printed)
        return true;
    if (options->kind == OUTPUT_LOG) {
        output_complain(options->path, EEXIST);
        return false;
    }
    if (is_of_kind(options->path, kinds[options->kind].begin))
        return true;
    complain("%s: exists and is not %s; --force overwrites it", options->path,
             kinds[options->kind].name);
    return false;
}

/* ---- Temporary files ------------------------------------------------------------------------- */

/* The temporary name of the output that is open; NULL: none. */
static const char *volatile unfinished;

static void remove_temporary(void)
{
    if (unfinished)
        unlink(unfinished);
}

static void on_signal(int number)
{
    remove_temporary();
    raise(number); /* now with its default action */
}

/* Removes the temporary file when the process ends. With SIGXFSZ ignored, a write beyond the limit
 * of file sizes is an error. */
static void install_cleanup(void)
{
    static const int signals[] = {SIGHUP, SIGINT, SIGQUIT, SIGPIPE, SIGTERM};
    static bool installed;
    struct sigaction action;
    if (installed)
        return;
    installed = true;
    atexit(remove_temporary);
    signal(SIGXFSZ, SIG_IGN);
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) {
        if (sigaction(signals[i], NULL, &action) != 0 || action.sa_handler != SIG_DFL)
            continue;
        action.sa_handler = on_signal;
        action.sa_flags = (int) SA_RESETHAND;
        sigaction(signals[i], &action, NULL);
    }
}

/* The name is registered before its file exists, so that on_signal() removes it at any time. */
static int open_temporary(struct output *output, mode_t mode)
{
    install_cleanup();
    output->target = follow_links(output->path);
    output->temporary = output_beside(output->target, ".fmb-XXXXXX");
    unfinished = output->temporary;
    const int fd = mkstemp(output->temporary);
    if (fd >= 0)
        fchmod(fd, mode);
    return fd;
}

static mode_t mode_of_new_files(void)
{
    const mode_t mask = umask(0);
    umask(mask);
    return 0666 & ~mask;
}

static void free_output(struct output *output)
{
    unfinished = NULL;
    free(output->target);
    free(output->temporary);
    free(output);
}

/* ---- Writing --------------------------------------------------------------------------------- */

static int open_fd(struct output *output)
{
    struct stat old;
    if (stat(output->path, &old) != 0)
        return errno == ENOENT ? open_temporary(output, mode_of_new_files()) : -1;
    const int standard = standard_fd(&old);
    if (standard >= 0)
        return dup(standard);
    if (!S_ISREG(old.st_mode))
        return open(output->path, O_WRONLY | O_CLOEXEC | O_NOCTTY);
    return access(output->path, W_OK) == 0 ? open_temporary(output, old.st_mode & 0777) : -1;
}

bool output_open(const struct output_options *options, struct output **out)
{
    *out = NULL;
    if (!options->path || !output_check(options))
        return !options->path;
    fflush(stdout); /* the output may be standard output */
    struct output *output = allocate(1, sizeof *output);
    output->path = options->path;
    const int fd = open_fd(output);
    output->file = fd >= 0 ? fdopen(fd, "wb") : NULL;
    if (output->file) {
        *out = output;
        return true;
    }
    output_complain(options->path, errno);
    free_output(output);
    return false;
}

bool output_close(struct output *output, bool keep)
{
    if (!output)
        return true;
    const bool written = !ferror(output->file);
    const bool kept = fclose(output->file) == 0 && written && keep &&
                      (!output->temporary || rename(output->temporary, output->target) == 0);
    if (keep && !kept)
        output_complain(output->path, errno);
    if (output->temporary && !kept)
        unlink(output->temporary);
    free_output(output);
    return kept || !keep;
}

int output_open_in_place(const char *path, bool force)
{
    struct stat old;
    const int fd = open(path, O_WRONLY | O_APPEND | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd >= 0 || errno != EEXIST)
        return fd;
    const bool regular = stat(path, &old) == 0 && S_ISREG(old.st_mode);
    const bool printed = regular && standard_fd(&old) >= 0;
    if (printed || (!force && regular && old.st_size > 0)) {
        errno = printed ? EBUSY : EEXIST;
        return -1;
    }
    return open(path, O_WRONLY | O_APPEND | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOCTTY, 0666);
}
