#include "log_parts.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { DIGITS = 3, NUMBER_TEXT = 24 };

char *log_parts_name(const char *path, long number)
{
    const size_t size = strlen(path) + NUMBER_TEXT;
    char *name = malloc(size);
    if (name)
        snprintf(name, size, "%s.%0*ld", path, DIGITS, number);
    return name;
}

/* ---- Files of an earlier recording ----------------------------------------------------------- */

/* Whether a name is that of a part: base, a point, and at least DIGITS digits. */
static bool is_part(const char *name, const char *base)
{
    const size_t length = strlen(base);
    if (strncmp(name, base, length) != 0 || name[length] != '.')
        return false;
    const char *digits = name + length + 1;
    const size_t count = strspn(digits, "0123456789");
    return count >= DIGITS && digits[count] == '\0';
}

/* Removes an existing part. Without force that is an error. */
static bool clear(struct log_parts *parts, const char *name)
{
    free(parts->name);
    parts->name = output_beside(parts->options.path, name);
    errno = EEXIST;
    return parts->options.force && unlink(parts->name) == 0;
}

static bool clear_all(struct log_parts *parts)
{
    const char *path = parts->options.path, *slash = strrchr(path, '/');
    char *folder = output_beside(path, ".");
    DIR *dir = opendir(folder);
    bool ok = dir != NULL;
    free(folder);
    for (struct dirent *entry; ok && (entry = readdir(dir));)
        if (is_part(entry->d_name, slash ? slash + 1 : path))
            ok = clear(parts, entry->d_name);
    const int error = errno;
    if (dir)
        closedir(dir);
    errno = error;
    return ok;
}

/* ---- Writing --------------------------------------------------------------------------------- */

static bool has_several(const struct log_parts *parts)
{
    return parts->options.part_bytes > 0;
}

static bool open_file(struct log_parts *parts)
{
    const char *path = parts->options.path;
    free(parts->name);
    parts->name = has_several(parts) ? log_parts_name(path, parts->number) : strdup(path);
    if (parts->name)
        parts->writer = log_begin(
            output_open_in_place(parts->name, parts->options.force && !has_several(parts)));
    return parts->writer != NULL;
}

bool log_parts_open(const struct log_parts_options *options, struct log_parts *out)
{
    *out = (struct log_parts){.options = *options, .previous = -1};
    return (!has_several(out) || clear_all(out)) && open_file(out);
}

static bool drop_oldest(struct log_parts *parts)
{
    char *oldest = log_parts_name(parts->options.path, parts->first);
    const bool ok = oldest && (unlink(oldest) == 0 || errno == ENOENT);
    free(oldest);
    parts->first += ok;
    return ok;
}

/* Closes the current file, and waits until the one before it is on disk. Returns 0 or the first
 * error. */
static int close_file(struct log_parts *parts)
{
    int disk;
    if (parts->writer)
        log_flush(parts->writer); /* so that the size is known */
    parts->finished = log_parts_written(parts);
    const int error = log_finish_soon(parts->writer, &disk);
    const int late = log_reach_disk(parts->previous);
    parts->writer = NULL;
    parts->previous = disk;
    return error ? error : late;
}

/* Opens the next file. A file that cannot be removed is tried again with the next one. */
static bool next_file(struct log_parts *parts)
{
    const int error = close_file(parts);
    if (error) {
        errno = error;
        return false;
    }
    parts->number++;
    const long keep = parts->options.keep;
    while (keep > 0 && parts->number - parts->first >= keep && drop_oldest(parts))
        continue;
    return open_file(parts);
}

bool log_parts_prepare(struct log_parts *parts, int64_t bytes)
{
    const int64_t written = log_written(parts->writer);
    const bool full =
        has_several(parts) && written > 0 && written + bytes > parts->options.part_bytes;
    return !full || next_file(parts);
}

int64_t log_parts_written(const struct log_parts *parts)
{
    return parts->finished + (parts->writer ? log_written(parts->writer) : 0);
}

int log_parts_finish(struct log_parts *parts)
{
    const int error = close_file(parts), late = log_reach_disk(parts->previous);
    parts->previous = -1;
    return error ? error : late;
}

void log_parts_close(struct log_parts *parts)
{
    log_parts_finish(parts);
    free(parts->name);
    parts->name = NULL;
}
